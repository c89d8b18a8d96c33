use crate::apple::{Apple, Variety};
use crate::curve::Curve;
use crate::grow::{Grower, Hanging};
use crate::light::Light;
use crate::random::{Purpose, stream};
use crate::world::{Branch, World};
use nalgebra::{Isometry3, Point3, Rotation3, Translation3, Vector3};
use rand::RngExt;

/// A whole tree of a row: a leader, laterals to both sides, spurs full of leaves, 14 to 40 apples.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Row {
    /// Fewest and most apples; between them is drawn.
    pub apples: (usize, usize),
    /// Fewest and most laterals.
    pub laterals: (usize, usize),
    /// Distance of the tree from the camera, metres.
    pub distance: (f64, f64),
    /// Leaves of each rosette.
    pub rosette: usize,
}

impl Default for Row {
    fn default() -> Self {
        Self {
            apples: (14, 40),
            laterals: (8, 11),
            distance: (1.35, 1.7),
            rosette: 3,
        }
    }
}

impl Row {
    /// The tree of `seed` before the camera, which looks up a little.
    pub fn world(&self, seed: u64) -> World {
        let light = Light {
            shadows: true,
            ..Light::default()
        };
        let mut tree = Grower::new(World::new(light), stream(seed, Purpose::Layout, 0));
        let leader = leader(&mut tree);
        let count = tree.rng.random_range(self.laterals.0..=self.laterals.1);
        let laterals: Vec<usize> = (0..count)
            .map(|i| lateral(&mut tree, &leader, i, count))
            .collect();
        let wanted = tree.rng.random_range(self.apples.0..=self.apples.1);
        // Positions that are taken already are skipped, so more are tried.
        for _ in 0..30 * wanted {
            if tree.world.apples().len() == wanted {
                break;
            }
            let branch = laterals[tree.rng.random_range(0..laterals.len())];
            hang_somewhere(&mut tree, branch);
        }
        for &branch in &laterals {
            tree.dress(branch, 0.1..1.0, 0.055, self.rosette);
        }
        let tilt = tree.between(0.1..0.3);
        let z = tree.between(self.distance.0..self.distance.1);
        let pose = Isometry3::from_parts(
            Translation3::new(0.0, 0.0, z),
            Rotation3::from_axis_angle(&Vector3::x_axis(), -tilt).into(),
        );
        tree.world.transformed(&pose)
    }
}

fn leader(tree: &mut Grower) -> Branch {
    let sway = tree.between(-0.12..0.12);
    let foot = Point3::new(-sway, 1.0, 0.1);
    let top = Point3::new(sway, -0.85, 0.12);
    let leader = Branch {
        curve: Curve::bow(foot, -Vector3::y(), top),
        start_radius: 0.024,
        end_radius: 0.010,
    };
    tree.world.add_branch(leader);
    leader
}

/// A lateral: to the left and right in turn, from the bottom up, rising and then drooping.
fn lateral(tree: &mut Grower, leader: &Branch, number: usize, of: usize) -> usize {
    let height = 0.12 + 0.82 * (number as f64 + tree.between(0.2..0.8)) / of as f64;
    let side = if number.is_multiple_of(2) { 1.0 } else { -1.0 };
    let start = leader.curve.point(height);
    let reach = tree.between(0.45..0.85) * (1.15 - 0.5 * height);
    let rise = tree.between(-0.12..0.10);
    let end = start + Vector3::new(side * reach, rise, tree.between(-0.30..0.15));
    let leaving = Vector3::new(side, tree.between(-0.9..-0.3), -0.1);
    let radius = tree.between(0.007..0.011);
    let curve = Curve::bow(start, leaving, end);
    tree.world.add_branch(Branch {
        curve,
        start_radius: radius,
        end_radius: 0.4 * radius,
    })
}

/// An apple at a random place of a branch, unless something is there already.
fn hang_somewhere(tree: &mut Grower, branch: usize) {
    let varieties = [Variety::Red, Variety::Red, Variety::Blushed];
    let apple = Apple {
        flattening: tree.between(0.02..0.12),
        stem_cavity: tree.between(0.15..0.28),
        calyx_cavity: 0.1,
        variety: varieties[tree.rng.random_range(0..varieties.len())],
        ..Apple::sphere(Point3::origin(), tree.between(0.031..0.043))
    };
    let at = tree.between(0.2..0.98);
    let bearing = tree.world.branches()[branch];
    let toward = Vector3::y() + tree.isotropic() * 0.45 - Vector3::z() * 0.3;
    let distance = apple.radius + bearing.radius_at(at) + tree.between(0.003..0.01);
    let tangent = bearing.curve.derivative(at).normalize();
    let center = bearing.curve.point(at) + crate::grow::across(&toward, &tangent) * distance;
    if tree.is_free(&center, apple.radius, branch) {
        tree.hang(
            apple,
            &Hanging {
                branch,
                at,
                toward,
                distance,
            },
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn trees_bear_fourteen_to_forty_apples_that_do_not_overlap() {
        for seed in 0..6 {
            let world = Row::default().world(seed);
            let apples = world.apples();
            assert!(
                (14..=40).contains(&apples.len()),
                "seed {seed}: {}",
                apples.len()
            );
            for (i, a) in apples.iter().enumerate() {
                for b in &apples[i + 1..] {
                    assert!((a.center - b.center).norm() > a.radius + b.radius);
                }
            }
        }
    }
}
