//! Part of a hedge of fruiting trees, as an orchard robot sees it: leaves everywhere, thin branches between them.

use crate::apple::{Apple, Variety};
use crate::curve::Curve;
use crate::grow::{Grower, Hanging, across};
use crate::light::Light;
use crate::random::{Purpose, stream};
use crate::raycast::{Raycast, raycast};
use crate::scenery::Scenery;
use crate::visibility::look_at;
use crate::world::{Branch, World};
use nalgebra::{Isometry3, Point3, Rotation3, Translation3, Unit, Vector3};
use pomona_cloud::Camera;
use rand::RngExt;

/// A piece of a dense tree before a camera: apple 0 hangs in the middle, and more about it.
///
/// Ranges are drawn from evenly; lengths in metres. How dense it is was fitted to two real frames by
/// `cargo run --release -p pomona-cli --example likeness`; see docs/scenes.md.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Dense {
    /// Radius of an apple.
    pub apple_radius: (f64, f64),
    /// Radius of a branch where an apple hangs: twigs of 3 to 8 mm.
    pub branch_radius: (f64, f64),
    /// Radius of a limb, thicker than the branches that bear apples.
    pub limb_radius: (f64, f64),
    /// Most limbs in sight.
    pub limbs: usize,
    /// Radius of a trunk.
    pub trunk_radius: (f64, f64),
    /// Share of the scenes with a trunk in sight.
    pub trunk_share: f64,
    /// Depth of the middle apple's centre.
    pub distance: (f64, f64),
    /// Fewest and most branches beside that of the middle apple.
    pub other_branches: (usize, usize),
    /// Most apples beside the one in the middle.
    pub other_apples: usize,
    /// Distance of leafy spurs along a branch.
    pub spur_spacing: f64,
    /// Fewest and most leaves of a spur.
    pub rosette: (usize, usize),
    /// Fewest and most shoots that grow from elsewhere through the scene.
    pub shoots: (usize, usize),
    /// Share of an apple that must show for a person to box it.
    pub least_visible: f64,
}

impl Default for Dense {
    fn default() -> Self {
        Self {
            apple_radius: (0.034, 0.043),
            branch_radius: (0.0015, 0.004),
            limb_radius: (0.005, 0.010),
            limbs: 2,
            trunk_radius: (0.009, 0.018),
            trunk_share: 0.75,
            distance: (1.05, 1.5),
            other_branches: (4, 7),
            other_apples: 14,
            spur_spacing: 0.05,
            rosette: (3, 6),
            shoots: (30, 45),
            least_visible: 0.6,
        }
    }
}

/// Size of the image, pixels: a third of the width of the real frames' 1920, at their resolution.
const IMAGE: [usize; 2] = [640, 480];

/// Focal length of the colour camera, pixels: that of the Azure Kinect's image of 1920 × 1080, by its own calibration.
const FOCAL_PX: f64 = 917.0;

/// How far the image's middle is from the camera's axis, pixels: it is a part of a larger image.
const OFF_AXIS_PX: (f64, f64) = (350.0, 150.0);

/// Layouts tried before one is taken without an apple that a person would box.
const ATTEMPTS: u64 = 8;

/// Greatest angle by which the camera looks up, radians.
const LARGEST_TILT: f64 = 0.15;

impl Dense {
    /// Standard deviation of a box's edges, pixels: people who draw boxes differ by a pixel or two.
    pub(crate) const BOX_SD_PX: f64 = 1.3;

    /// The camera of `seed`.
    pub(crate) fn camera(seed: u64) -> Camera {
        let mut rng = stream(seed, Purpose::Scenery, 1);
        let mut shift = |most: f64| most * (2.0 * rng.random::<f64>() - 1.0);
        let (right, down) = (shift(OFF_AXIS_PX.0), shift(OFF_AXIS_PX.1));
        let [width, height] = IMAGE;
        let center = [0.5 * width as f64 + right, 0.5 * height as f64 + down];
        Camera::new(IMAGE, [FOCAL_PX; 2], center)
    }

    /// The world of `seed` before `camera`, and what the rays meet in it.
    pub(crate) fn layout(&self, camera: &Camera, seed: u64) -> (World, Raycast) {
        let mut attempt = 0;
        loop {
            let rng = stream(seed, Purpose::Dense, attempt);
            let tree = Grower::new(World::new(Light::default()), rng);
            let world = Hedge { dense: *self, tree }.world(camera, seed);
            let cast = raycast(&world, camera);
            let boxed = |index: usize| {
                look_at(&world, camera, &cast, index, 0.0, 1).is_some_and(|apple| {
                    apple.branch.is_some() && apple.visible_share >= Some(self.least_visible)
                })
            };
            attempt += 1;
            if boxed(0) || attempt == ATTEMPTS {
                return (world, cast);
            }
        }
    }
}

/// One attempt, in a level frame about the middle apple's centre.
struct Hedge {
    dense: Dense,
    tree: Grower,
}

impl Hedge {
    fn world(mut self, camera: &Camera, seed: u64) -> World {
        self.tree.world.light = self.light();
        let target = self.apple();
        let bearing = self.bearing_branch(&target);
        if self.tree.between(0.0..1.0) < self.dense.trunk_share {
            self.trunk();
        }
        let mut branches = vec![bearing];
        for _ in 0..self.number((0, self.dense.limbs)) {
            branches.extend(self.other_branch(self.dense.limb_radius));
        }
        for _ in 0..self.number(self.dense.other_branches) {
            branches.extend(self.other_branch(self.dense.branch_radius));
        }
        let wanted = self.number((self.dense.other_apples / 2, self.dense.other_apples));
        for _ in 0..3 * wanted {
            if self.tree.world.apples().len() > wanted {
                break;
            }
            let branch = branches[self.tree.rng.random_range(0..branches.len())];
            self.hang_somewhere(branch);
        }
        for &branch in &branches {
            self.dress(branch);
        }
        for _ in 0..self.number(self.dense.shoots) {
            self.shoot();
        }
        let tilt = self.tree.between(-0.05..LARGEST_TILT);
        let z = self.drawn(self.dense.distance);
        // In the middle third of the image, wherever the camera's axis is.
        let (u, v) = (
            IMAGE[0] as f64 * self.tree.between(0.35..0.65),
            IMAGE[1] as f64 * self.tree.between(0.35..0.65),
        );
        let (x, y) = (
            (u - camera.cx) / camera.fx * z,
            (v - camera.cy) / camera.fy * z,
        );
        let pose = Isometry3::from_parts(
            Translation3::new(x, y, z),
            Rotation3::from_axis_angle(&Vector3::x_axis(), -tilt).into(),
        );
        let mut world = self.tree.world.transformed(&pose);
        world.scenery = Some(Scenery::new(seed));
        world
    }

    fn number(&mut self, (fewest, most): (usize, usize)) -> usize {
        self.tree.rng.random_range(fewest..=most)
    }

    fn drawn(&mut self, range: (f64, f64)) -> f64 {
        self.tree.between(range.0..range.1)
    }

    /// A bright day; in half of the scenes the sun stands behind the trees.
    fn light(&mut self) -> Light {
        let behind = self.tree.between(-0.7..0.5);
        let aside = self.tree.between(-0.7..0.7);
        Light {
            toward_sun: Unit::new_normalize(Vector3::new(aside, -0.9, behind)),
            sun: [1.15, 1.08, 0.98],
            sky: [0.42, 0.46, 0.52],
            ground: [0.26, 0.23, 0.21],
            shadows: true,
            ..Light::default()
        }
    }

    fn apple(&mut self) -> Apple {
        let radius = self.drawn(self.dense.apple_radius);
        self.tree.apple(radius, Variety::Red)
    }

    /// The middle apple's branch, more often above it than below, and the apple on it.
    fn bearing_branch(&mut self, target: &Apple) -> usize {
        let radius = self.drawn(self.dense.branch_radius);
        let nearest = target.radius + radius + 0.001;
        let distance = self
            .tree
            .between(nearest..(1.6 * target.radius).max(nearest + 0.002));
        let direction = (self.tree.isotropic() - Vector3::y() * 0.9).normalize();
        let tangent = across(&self.tree.isotropic(), &direction);
        let length = self.tree.between(0.35..0.7);
        let bow = across(&self.tree.isotropic(), &tangent) * self.tree.between(0.0..0.06);
        let taper = self.tree.between(0.0..0.35);
        let foot = Point3::from(direction * distance);
        let branch = self.tree.world.add_branch(Branch {
            curve: Curve::through(foot, tangent, length, bow),
            start_radius: radius * (1.0 + taper),
            end_radius: radius * (1.0 - taper),
        });
        self.tree.hang(
            *target,
            &Hanging {
                branch,
                at: 0.5,
                toward: -direction,
                distance,
            },
        );
        branch
    }

    /// A trunk behind the leaves, nearly upright.
    fn trunk(&mut self) {
        for _ in 0..10 {
            let side = if self.tree.rng.random::<bool>() {
                1.0
            } else {
                -1.0
            };
            let middle = Point3::new(
                side * self.tree.between(0.04..0.25),
                0.0,
                self.tree.between(-0.02..0.18),
            );
            let lean = self.tree.isotropic() * 0.06;
            let bow = Vector3::x() * self.tree.between(-0.02..0.02);
            let curve = Curve::through(middle, Vector3::y() + lean, 1.6, bow);
            let radius = self.drawn(self.dense.trunk_radius);
            if self.is_clear(&curve, radius) {
                self.tree.world.add_branch(Branch {
                    curve,
                    start_radius: 0.9 * radius,
                    end_radius: 1.1 * radius,
                });
                return;
            }
        }
    }

    /// A branch elsewhere in the tree.
    fn other_branch(&mut self, radii: (f64, f64)) -> Option<usize> {
        for _ in 0..10 {
            let middle = Point3::new(
                self.tree.between(-0.35..0.35),
                self.tree.between(-0.28..0.28),
                self.tree.between(-0.06..0.30),
            );
            let tangent = self
                .tree
                .isotropic()
                .component_mul(&Vector3::new(1.0, 0.7, 0.6));
            let bow =
                across(&self.tree.isotropic(), &tangent.normalize()) * self.tree.between(0.0..0.06);
            let curve = Curve::through(middle, tangent, self.tree.between(0.3..0.7), bow);
            let radius = self.drawn(radii);
            if self.is_clear(&curve, radius) {
                let end_radius = radius * self.tree.between(0.5..0.9);
                return Some(self.tree.world.add_branch(Branch {
                    curve,
                    start_radius: radius,
                    end_radius,
                }));
            }
        }
        None
    }

    /// Whether a limb meets no apple.
    fn is_clear(&self, curve: &Curve, radius: f64) -> bool {
        self.tree.world.apples().iter().all(|apple| {
            let near = curve.point(curve.nearest(&apple.center));
            (near - apple.center).norm() > apple.radius + radius + 0.001
        })
    }

    /// An apple at a random place of a branch, unless something is there already.
    fn hang_somewhere(&mut self, branch: usize) {
        let apple = self.apple();
        let at = self.tree.between(0.15..0.85);
        let bearing = self.tree.world.branches()[branch];
        let toward = Vector3::y() + self.tree.isotropic() * 0.5 - Vector3::z() * 0.3;
        let gap = self.tree.between(0.002..0.35 * apple.radius);
        let distance = apple.radius + bearing.radius_at(at) + gap;
        let tangent = bearing.curve.derivative(at).normalize();
        let center = bearing.curve.point(at) + across(&toward, &tangent) * distance;
        if self.tree.is_free(&center, apple.radius, branch) {
            self.tree.hang(
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

    /// Leafy spurs and a leafy shoot or two on a branch.
    fn dress(&mut self, branch: usize) {
        let bearing = self.tree.world.branches()[branch];
        let length = bearing.curve.length();
        let spurs = (length / self.dense.spur_spacing) as usize;
        for i in 0..spurs {
            let at = (i as f64 + self.tree.between(0.1..0.9)) / spurs.max(1) as f64;
            let leaves = self.number(self.dense.rosette);
            self.tree.leafy_spur(branch, at, leaves);
        }
        for _ in 0..self.tree.rng.random_range(0..=2) {
            let at = self.tree.between(0.1..0.95);
            let from = bearing.curve.point(at);
            let tangent = bearing.curve.derivative(at).normalize();
            let heading = tangent * 0.5 + self.tree.isotropic() * 0.6 - Vector3::y() * 0.4;
            let length = self.tree.between(0.06..0.16);
            self.tree.leafy_shoot(from, heading, length);
        }
    }

    /// A leafy shoot that comes from a branch out of sight: most behind the apple, some before it.
    fn shoot(&mut self) {
        let from = Point3::new(
            self.tree.between(-0.42..0.42),
            self.tree.between(-0.34..0.34),
            self.tree.between(-0.10..0.40),
        );
        let heading = self.tree.isotropic() - Vector3::y() * 0.2;
        let length = self.tree.between(0.08..0.22);
        self.tree.leafy_shoot(from, heading, length);
    }
}
