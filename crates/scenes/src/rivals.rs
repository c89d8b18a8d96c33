//! Branches that pass the target besides its own and are easier to see.

use crate::apple::Apple;
use crate::curve::Curve;
use crate::grow::across;
use crate::orchard::{Course, Layout, Orchard};
use crate::random::{Purpose, stream};
use crate::raycast::Raycast;
use crate::visibility::visible_branch;
use crate::world::{Branch, World};
use nalgebra::{Point3, Vector3};
use pomona_cloud::Camera;

/// Distance of the bearing branch's axis from the target's centre, radii of the apple: below
/// that of any rival by 0.15 or more.
const BEARING_REACH: (f64, f64) = (1.1, 1.45);

/// The same of a rival: nearer, it could be the answer; farther, no method would ask about it.
const RIVAL_REACH: (f64, f64) = (1.6, 2.8);

/// Least angle between two branches as seen from the target's centre, degrees: a rival in the
/// direction of the right branch would be no wrong answer.
const LEAST_APART_DEG: f64 = 35.0;

/// Radius of the bearing branch, metres.
const BEARING_RADIUS: (f64, f64) = (0.0035, 0.0055);

/// The same where thinness is its handicap.
const THIN_RADIUS: (f64, f64) = (0.0025, 0.0035);

/// Radius of a rival, metres: a secondary branch, thicker than any bearing one.
const RIVAL_RADIUS: (f64, f64) = (0.0075, 0.012);

/// Length of a branch, metres.
const LENGTH: (f64, f64) = (0.5, 0.9);

/// Length of a short bearing branch, radii of the apple: it ends within the shell about the target.
const SHORT_LENGTH: (f64, f64) = (4.0, 5.5);

/// Way of a curved branch's ends from its tangent, shares of its length.
const BOW: (f64, f64) = (0.04, 0.09);

/// Greatest angle of a steep bearing branch with the line of sight, degrees.
const STEEP_DEG: f64 = 35.0;

/// Least angle of any other branch with the line of sight, degrees.
const LEAST_SLANT_DEG: f64 = 45.0;

/// Visible length of the bearing branch about the target, radii of the apple: with less nobody could tell.
const LEAST_SHOWN: f64 = 0.8;

/// The same at most for a branch behind leaves: a bare one shows 4 to 5.
const MOST_SHOWN: f64 = 3.0;

/// Directions, or whole branches, drawn before the last one is left out.
const DRAWS: usize = 200;

/// What makes the bearing branch harder to see than its rivals.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Handicap {
    /// It is a twig.
    Thin,
    /// It is short, and leaves cover both ends.
    Short,
    /// Leaves cover one half of it.
    Hidden,
    /// It points towards the camera.
    Steep,
}

impl Handicap {
    /// That of a seed: each in turn.
    pub(crate) fn of(seed: u64) -> Self {
        [Self::Thin, Self::Short, Self::Hidden, Self::Steep][(seed % 4) as usize]
    }

    /// Whether enough of the bearing branch shows to find it, and more of every rival.
    pub(crate) fn holds(self, world: &World, camera: &Camera, cast: &Raycast) -> bool {
        let (pixels, length) = visible_branch(world, camera, cast, 0, 0);
        let shown = length / world.apples()[0].radius;
        let covered = matches!(self, Self::Short | Self::Hidden);
        let outdone = |rival: usize| visible_branch(world, camera, cast, 0, rival).0 > pixels;
        shown >= LEAST_SHOWN
            && (!covered || shown <= MOST_SHOWN)
            && (1..world.branches().len()).all(outdone)
    }
}

impl Layout {
    /// As [`Layout::new`], with random numbers that no scene without rivals shares.
    pub(crate) fn of_rivals(orchard: Orchard, seed: u64, attempt: u64) -> Self {
        Self::with(orchard, stream(seed, Purpose::Rivals, attempt))
    }

    /// The target on a branch with a handicap, and its rivals; straight and curved in turns of seeds.
    pub(crate) fn world_with_rivals(mut self, seed: u64) -> World {
        let handicap = Handicap::of(seed);
        let curved = (seed / 4) % 2 == 1;
        let pose = self.pose();
        let toward_camera = pose
            .inverse_transform_point(&Point3::origin())
            .coords
            .normalize();
        let target = self.apple();
        let bearing = self.handicapped_branch(&target, handicap, curved, &toward_camera);
        let (fewest, most) = self.orchard.rivals;
        for _ in 0..fewest + self.up_to(most - fewest) {
            self.rival(target.radius, curved, &toward_camera);
        }
        for _ in 0..self.up_to(self.orchard.neighbours) {
            self.neighbour(bearing);
        }
        self.cover(bearing, target.radius, handicap, &toward_camera);
        self.spurs_and_leaves(bearing, target.radius);
        self.tree.world.transformed(&pose)
    }

    fn handicapped_branch(
        &mut self,
        target: &Apple,
        handicap: Handicap,
        curved: bool,
        toward_camera: &Vector3<f64>,
    ) -> usize {
        let thin = handicap == Handicap::Thin;
        let radius = self.drawn(if thin { THIN_RADIUS } else { BEARING_RADIUS });
        let nearest = (BEARING_REACH.0 * target.radius).max(target.radius + radius + 0.001);
        let distance = self.drawn((nearest, BEARING_REACH.1 * target.radius));
        let (mut direction, mut tangent) = (Vector3::zeros(), Vector3::zeros());
        for _ in 0..DRAWS {
            direction = (self.tree.isotropic() - Vector3::y() * 0.7).normalize();
            tangent = across(&self.tree.isotropic(), &direction);
            let slant = slant_deg(&tangent, toward_camera);
            let wanted = match handicap {
                Handicap::Steep => slant <= STEEP_DEG,
                _ => slant >= LEAST_SLANT_DEG,
            };
            if wanted {
                break;
            }
        }
        let length = match handicap {
            Handicap::Short => self.drawn(SHORT_LENGTH) * target.radius,
            _ => self.drawn(LENGTH),
        };
        let bow = self.bow(&tangent, length, curved);
        let course = Course {
            radius,
            distance,
            direction,
            tangent,
            length,
            bow,
        };
        self.bear(target, &course)
    }

    /// A thicker branch past the target in a direction of its own, across the line of sight.
    fn rival(&mut self, target_radius: f64, curved: bool, toward_camera: &Vector3<f64>) {
        for _ in 0..DRAWS {
            let direction = self.tree.isotropic().normalize();
            let tangent = across(&self.tree.isotropic(), &direction);
            if slant_deg(&tangent, toward_camera) < LEAST_SLANT_DEG {
                continue;
            }
            let radius = self.drawn(RIVAL_RADIUS);
            let distance = self.drawn(RIVAL_REACH) * target_radius;
            let length = self.drawn(LENGTH);
            let bow = self.bow(&tangent, length, curved);
            let middle = Point3::from(direction * distance);
            let curve = Curve::through(middle, tangent, length, bow);
            let branches = self.tree.world.branches();
            let apart = |other: &Branch| {
                let foot = other.curve.point(other.curve.nearest(&Point3::origin()));
                direction.angle(&foot.coords).to_degrees() >= LEAST_APART_DEG
                    && gap(&curve, &other.curve) > radius + other.start_radius.max(other.end_radius)
            };
            if branches.iter().all(apart) {
                let taper = self.tree.between(0.0..0.2);
                self.tree.world.add_branch(Branch {
                    curve,
                    start_radius: radius * (1.0 + taper),
                    end_radius: radius * (1.0 - taper),
                });
                return;
            }
        }
    }

    fn bow(&mut self, tangent: &Vector3<f64>, length: f64, curved: bool) -> Vector3<f64> {
        if !curved {
            return Vector3::zeros();
        }
        across(&self.tree.isotropic(), tangent) * (self.drawn(BOW) * length)
    }

    /// Leaves on the camera's side of the bearing branch, where its handicap is to be covered.
    fn cover(
        &mut self,
        branch: usize,
        target_radius: f64,
        handicap: Handicap,
        toward_camera: &Vector3<f64>,
    ) {
        // Radii along the branch from the target's foot.
        let sites: &[f64] = match handicap {
            Handicap::Thin | Handicap::Steep => return,
            Handicap::Short => &[-2.4, -1.9, -1.4, 1.4, 1.9, 2.4],
            Handicap::Hidden => &[0.1, 0.6, 1.1, 1.6, 2.1, 2.6],
        };
        let bearing = self.tree.world.branches()[branch];
        let length = bearing.curve.length();
        let side = if self.tree.between(0.0..1.0) < 0.5 {
            1.0
        } else {
            -1.0
        };
        for site in sites {
            let at = (0.5 + side * site * target_radius / length).clamp(0.0, 1.0);
            let outward = bearing.curve.derivative(at).normalize() * (side * site.signum());
            let heading = outward * 0.8 + toward_camera * 0.6 + self.tree.isotropic() * 0.2;
            let stalk = self.tree.between(0.012..0.03);
            let foot = bearing.curve.point(at);
            self.tree.leaf_on_stalk(foot, heading.normalize(), stalk);
        }
    }
}

/// Angle of a branch with the line of sight, degrees.
fn slant_deg(tangent: &Vector3<f64>, sight: &Vector3<f64>) -> f64 {
    tangent.dot(sight).abs().min(1.0).acos().to_degrees()
}

/// Least distance between two centre lines, from points 1/64 of the parameter apart on one.
fn gap(one: &Curve, other: &Curve) -> f64 {
    (0..=64)
        .map(|i| one.point(f64::from(i) / 64.0))
        .map(|p| (other.point(other.nearest(&p)) - p).norm())
        .fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shot::Shot;

    fn world(seed: u64) -> World {
        let camera = Shot::paper_camera().with_intrinsics([320, 240], [270.0; 2], [159.5, 119.5]);
        Orchard::with_rivals().world(&camera, seed)
    }

    #[test]
    fn the_bearing_branch_is_nearest_and_rivals_pass_elsewhere() {
        for seed in 0..32 {
            let world = world(seed);
            let target = world.apples()[0];
            let way = |branch: &Branch| {
                branch.curve.point(branch.curve.nearest(&target.center)) - target.center
            };
            let ways: Vec<_> = world.branches().iter().map(way).collect();
            assert!((2..=4).contains(&ways.len()), "seed {seed}: {}", ways.len());
            let radii = |way: &Vector3<f64>| way.norm() / target.radius;
            assert!((1.1..=1.4501).contains(&radii(&ways[0])), "seed {seed}");
            for (i, rival) in ways.iter().enumerate().skip(1) {
                let more = radii(rival) - radii(&ways[0]);
                assert!(
                    more >= 0.1499 && radii(rival) <= 2.8001,
                    "seed {seed}: {more}"
                );
                let apart = |other| rival.angle(other).to_degrees() >= LEAST_APART_DEG - 0.01;
                assert!(ways[..i].iter().all(apart), "seed {seed}");
                let thickness = |i: usize| world.branches()[i].radius_at(0.5);
                assert!(thickness(i) > 1.3 * thickness(0), "seed {seed}");
            }
        }
    }

    #[test]
    fn a_seed_gives_one_world() {
        let branches = |seed| world(seed).branches().to_vec();
        assert_eq!(branches(5), branches(5));
        assert_ne!(branches(5), branches(6));
    }
}
