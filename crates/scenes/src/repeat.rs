use crate::apple::{Apple, Variety};
use crate::curve::Curve;
use crate::grow::{Grower, Hanging};
use crate::leaf::Leaf;
use crate::light::Light;
use crate::random::{Normal, Purpose, stream};
use crate::scene::Scene;
use crate::sensor::{Dropout, Sensor};
use crate::shot::Shot;
use crate::world::{Bark, Branch, World};
use nalgebra::{Isometry3, Point3, Rotation3, Translation3, Unit, Vector3};
use pomona_cloud::PixelBox;
use rand::RngExt;

/// How many leaves stand about the apple's stalk.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Density {
    /// None.
    None,
    /// Three.
    Light,
    /// Seven: with the other amounts of [`Repeat`], enough to scatter the published method
    /// as its authors report.
    Paper,
    /// Twelve.
    Dense,
}

impl Density {
    /// How many leaves.
    pub fn leaves(self) -> usize {
        match self {
            Self::None => 0,
            Self::Light => 3,
            Self::Paper => 7,
            Self::Dense => 12,
        }
    }
}

/// The paper's repeats (section 3, Figures 13 to 15): one apple with leaves at
/// its stalk, taken again and again.
///
/// Noise alone does not scatter the published method as its authors report,
/// so between two frames leaves sway, readings drop out and the box shifts, by
/// the amounts given here. They were chosen by search, so that the method `paper` scatters about its own
/// mean as printed: 11.81° ± 13.65°, 63 % within 10°, 85 % within 20°, 3.4 % beyond 50°.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Repeat {
    /// Radius of the apple, metres.
    pub apple_radius: f64,
    /// Radius of the branch, metres.
    pub branch_radius: f64,
    /// Length of the branch, metres.
    pub branch_length: f64,
    /// Distance of the apple's centre from the camera, metres.
    pub distance: f64,
    /// Leaves at the stalk.
    pub leaves: usize,
    /// Standard deviation of the turn of each leaf about its base from frame to frame, radians.
    pub leaf_sway: f64,
    /// Standard deviation of the apple's and branch's common shift along each axis, metres.
    pub body_sway: f64,
    /// Share of readings that drop out.
    pub dropout: f64,
    /// Side of the patches that drop out, pixels.
    pub dropout_patch_px: usize,
    /// Standard deviation of each edge of the box, pixels.
    pub box_shift_px: f64,
}

impl Repeat {
    /// The paper's apple (r = 41.67 mm) with leaves of the given density.
    pub fn new(density: Density) -> Self {
        Self {
            apple_radius: 0.041_67,
            branch_radius: 0.0025,
            branch_length: 0.17,
            distance: 0.8,
            leaves: density.leaves(),
            leaf_sway: 1.2,
            body_sway: 0.001,
            dropout: 0.15,
            dropout_patch_px: 7,
            box_shift_px: 2.5,
        }
    }

    /// Frame number `repeat`; the plant is the same in all of them.
    pub fn scene(&self, id: impl Into<String>, repeat: u64) -> Scene {
        let (world, leaves) = self.plant();
        let mut rng = stream(repeat, Purpose::Sway, 0);
        let mut normal = Normal::default();
        let mut world = world;
        for leaf in leaves {
            let turn = Vector3::from_fn(|_, _| normal.draw(&mut rng) * self.leaf_sway);
            world.add_leaf(turned(leaf, &turn));
        }
        let shift = Vector3::from_fn(|_, _| normal.draw(&mut rng) * self.body_sway);
        let pose = Translation3::from(shift + Vector3::z() * self.distance);
        let world = world.transformed(&Isometry3::from(pose));
        let dropout = Dropout {
            share: self.dropout,
            patch_px: self.dropout_patch_px,
        };
        let sensor = Sensor {
            dropout,
            ..Sensor::paper()
        };
        let shot = Shot {
            target: Some(0),
            ..Shot::new(id, Shot::paper_camera(), sensor, repeat)
        };
        let mut scene = shot.take(&world);
        let camera = &scene.frame.camera;
        let (width, height) = (camera.width as f64, camera.height as f64);
        for bounds in scene.frame.boxes.iter_mut().flatten() {
            let mut moved = |edge: f64, most: f64| {
                (edge + normal.draw(&mut rng) * self.box_shift_px).clamp(0.0, most)
            };
            *bounds = PixelBox {
                x_min: moved(bounds.x_min, width),
                y_min: moved(bounds.y_min, height),
                x_max: moved(bounds.x_max, width),
                y_max: moved(bounds.y_max, height),
                ..bounds.clone()
            };
        }
        scene
    }

    /// Apple, branch, stalk and the leaves at rest, about the apple's centre.
    fn plant(&self) -> (World, Vec<Leaf>) {
        let rng = stream(41_67, Purpose::Layout, 0);
        let mut tree = Grower::new(World::new(Light::default()), rng);
        let direction = Vector3::new(0.15, -1.0, 0.1).normalize();
        let distance = 1.42 * self.apple_radius;
        let foot = Point3::from(direction * distance);
        let branch = tree.world.add_branch(Branch {
            curve: Curve::through(
                foot,
                Vector3::new(1.0, 0.05, 0.12),
                self.branch_length,
                Vector3::y() * 0.01,
            ),
            start_radius: 1.1 * self.branch_radius,
            end_radius: 0.9 * self.branch_radius,
        });
        let apple = Apple {
            flattening: 0.05,
            stem_cavity: 0.2,
            calyx_cavity: 0.08,
            variety: Variety::Red,
            ..Apple::sphere(Point3::origin(), self.apple_radius)
        };
        tree.hang(
            apple,
            &Hanging {
                branch,
                at: 0.5,
                toward: -direction,
                distance,
            },
        );
        let stem = tree.world.apples()[0].stem_foot();
        let middle = nalgebra::center(&stem, &foot);
        // Around the stalk by the golden angle, the first one towards the camera's right.
        let leaves = (0..self.leaves).filter_map(|i| {
            let turn = 2.4 * i as f64 + 0.6;
            let heading = Vector3::new(turn.cos(), -0.25, -turn.sin().abs() * 0.8);
            let base = middle + heading.normalize() * tree.between(0.010..0.020);
            let curve = Curve::straight(middle, base);
            let stalk = Branch {
                curve,
                start_radius: 0.0009,
                end_radius: 0.0008,
            };
            tree.world.add_twig(&stalk, Bark::Green);
            let length = tree.between(0.055..0.075);
            let hang = Vector3::y() * tree.between(0.2..0.6);
            let up = Vector3::new(0.0, -0.8, -0.6) + tree.isotropic() * 0.3;
            let leaf = Leaf::new(base, heading + hang, up, length, length * 0.55)?;
            Some(Leaf {
                bend: -0.2,
                tint: tree.rng.random(),
                ..leaf
            })
        });
        let leaves = leaves.collect();
        (tree.world, leaves)
    }
}

/// The leaf turned about its base by a rotation vector.
fn turned(leaf: Leaf, by: &Vector3<f64>) -> Leaf {
    let rotation = Rotation3::from_scaled_axis(*by);
    let rotated = |v: Unit<Vector3<f64>>| Unit::new_normalize(rotation * v.into_inner());
    Leaf {
        along: rotated(leaf.along),
        up: rotated(leaf.up),
        ..leaf
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_plant_is_the_same_and_its_leaves_sway() {
        let repeat = Repeat::new(Density::Paper);
        let (a, b) = (repeat.plant(), repeat.plant());
        assert_eq!(a.1, b.1);
        assert_eq!(a.1.len(), 7);
        let leaf = a.1[0];
        let moved = turned(leaf, &Vector3::new(0.0, 0.2, 0.0));
        assert_eq!(moved.base, leaf.base);
        assert!(moved.along.dot(&moved.up).abs() < 1e-12);
        assert_ne!(moved.along, leaf.along);
    }

    #[test]
    fn the_truth_counts_the_leaves() {
        for density in [
            Density::None,
            Density::Light,
            Density::Paper,
            Density::Dense,
        ] {
            let scene = Repeat::new(density).scene("leaves", 3);
            assert_eq!(scene.truth.apples[0].leaves, Some(density.leaves()));
        }
    }
}
