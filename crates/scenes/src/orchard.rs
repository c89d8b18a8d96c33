use crate::apple::{Apple, Variety};
use crate::curve::Curve;
use crate::grow::{Grower, Hanging, across};
use crate::light::Light;
use crate::random::{Purpose, stream};
use crate::world::{Bark, Branch, World};
use nalgebra::{Isometry3, Point3, Rotation3, Translation3, Vector3};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

/// Random parts of an orchard: one target apple, its branch, and their surroundings.
///
/// Ranges are drawn from evenly; lengths in metres. The target is apple 0.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Orchard {
    /// Radius of an apple.
    pub apple_radius: (f64, f64),
    /// Radius of a branch where the target hangs.
    pub branch_radius: (f64, f64),
    /// Depth of the target's centre.
    pub distance: (f64, f64),
    /// Most leaves about the target; between none and these are drawn.
    pub leaves: usize,
    /// Most apples beside the target.
    pub neighbours: usize,
    /// Most branches beside the target's own.
    pub other_branches: usize,
    /// Fewest and most branches that rival the target's own: farther by 0.15 radii or more, thicker and
    /// better to see. With none the scene is an ordinary one; with some there are no other branches,
    /// and `branch_radius` does not count.
    pub rivals: (usize, usize),
    /// Share of the target that must show; layouts with less are drawn again.
    pub least_visible: f64,
    /// Greatest angle by which the camera looks up, radians.
    pub tilt: f64,
}

impl Default for Orchard {
    fn default() -> Self {
        Self {
            apple_radius: (0.030, 0.045),
            branch_radius: (0.0025, 0.010),
            distance: (0.7, 1.5),
            leaves: 12,
            neighbours: 2,
            other_branches: 2,
            rivals: (0, 0),
            least_visible: 0.3,
            tilt: 0.45,
        }
    }
}

impl Orchard {
    /// The default with one to three rivals of the target's branch.
    pub fn with_rivals() -> Self {
        Self {
            rivals: (1, 3),
            ..Self::default()
        }
    }
}

/// How the bearing branch passes the target's centre.
pub(crate) struct Course {
    pub(crate) radius: f64,
    pub(crate) distance: f64,
    /// From the centre to the branch.
    pub(crate) direction: Vector3<f64>,
    pub(crate) tangent: Vector3<f64>,
    pub(crate) length: f64,
    pub(crate) bow: Vector3<f64>,
}

/// One attempt; in a level frame about the target's centre.
pub(crate) struct Layout {
    pub(crate) orchard: Orchard,
    pub(crate) tree: Grower,
}

impl Layout {
    pub(crate) fn new(orchard: Orchard, seed: u64, attempt: u64) -> Self {
        Self::with(orchard, stream(seed, Purpose::Layout, attempt))
    }

    pub(crate) fn with(orchard: Orchard, rng: ChaCha8Rng) -> Self {
        Self {
            orchard,
            tree: Grower::new(World::new(Light::default()), rng),
        }
    }

    pub(crate) fn world(mut self) -> World {
        let target = self.apple();
        let bearing = self.bearing_branch(&target);
        for _ in 0..self.up_to(self.orchard.other_branches) {
            self.other_branch(target.radius);
        }
        for _ in 0..self.up_to(self.orchard.neighbours) {
            self.neighbour(bearing);
        }
        self.spurs_and_leaves(bearing, target.radius);

        let pose = self.pose();
        self.tree.world.transformed(&pose)
    }

    /// Where the level frame stands before the camera.
    pub(crate) fn pose(&mut self) -> Isometry3<f64> {
        let tilt = self.tree.between(0.0..self.orchard.tilt);
        let z = self.drawn(self.orchard.distance);
        // Within the middle of the image, where half the field of view is 0.59 by 0.44 of z.
        let (x, y) = (
            self.tree.between(-0.25..0.25) * z,
            self.tree.between(-0.15..0.15) * z,
        );
        Isometry3::from_parts(
            Translation3::new(x, y, z),
            Rotation3::from_axis_angle(&Vector3::x_axis(), -tilt).into(),
        )
    }

    pub(crate) fn drawn(&mut self, range: (f64, f64)) -> f64 {
        self.tree.between(range.0..range.1)
    }

    pub(crate) fn up_to(&mut self, most: usize) -> usize {
        self.tree.rng.random_range(0..=most)
    }

    pub(crate) fn apple(&mut self) -> Apple {
        let varieties = [
            Variety::Red,
            Variety::Red,
            Variety::Blushed,
            Variety::Yellow,
        ];
        let variety = varieties[self.tree.rng.random_range(0..varieties.len())];
        let radius = self.drawn(self.orchard.apple_radius);
        self.tree.apple(radius, variety)
    }

    /// The target's branch, and the target on it: the apple at the origin, the
    /// branch in any direction but more often above than below.
    fn bearing_branch(&mut self, target: &Apple) -> usize {
        let radius = self.drawn(self.orchard.branch_radius);
        let nearest = target.radius + radius + 0.001;
        let distance = self
            .tree
            .between(nearest..(1.5 * target.radius).max(nearest + 0.002));
        let direction = (self.tree.isotropic() - Vector3::y() * 0.7).normalize();
        let tangent = across(&self.tree.isotropic(), &direction);
        let length = self.tree.between(0.5..0.9);
        let bow = across(&self.tree.isotropic(), &tangent) * self.tree.between(0.0..0.04);
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

    /// A branch on its course, and the target on it.
    pub(crate) fn bear(&mut self, target: &Apple, course: &Course) -> usize {
        let Course {
            radius,
            distance,
            direction,
            tangent,
            length,
            bow,
        } = *course;
        let foot = Point3::from(direction * distance);
        let taper = self.tree.between(0.0..0.35);
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

    /// A branch that passes the target farther away than its own.
    fn other_branch(&mut self, target_radius: f64) {
        for _ in 0..10 {
            let middle = Point3::from(
                self.tree.isotropic().normalize() * target_radius * self.tree.between(2.2..7.0),
            );
            let tangent = self.tree.isotropic();
            let bow =
                across(&self.tree.isotropic(), &tangent.normalize()) * self.tree.between(0.0..0.05);
            let curve = Curve::through(middle, tangent, self.tree.between(0.4..0.9), bow);
            let radius = self.drawn(self.orchard.branch_radius);
            if self.clearance(&curve) > radius + target_radius {
                let end_radius = radius * self.tree.between(0.5..0.9);
                self.tree.world.add_branch(Branch {
                    curve,
                    start_radius: radius,
                    end_radius,
                });
                return;
            }
        }
    }

    /// Least distance of a curve from an apple's surface.
    fn clearance(&self, curve: &Curve) -> f64 {
        let gap = |apple: &Apple| {
            (curve.point(curve.nearest(&apple.center)) - apple.center).norm() - apple.radius
        };
        self.tree
            .world
            .apples()
            .iter()
            .map(gap)
            .fold(f64::INFINITY, f64::min)
    }

    /// An apple on the same branch, in a third of the cases touching the target.
    pub(crate) fn neighbour(&mut self, branch: usize) {
        let apple = self.apple();
        let bearing = self.tree.world.branches()[branch];
        let target = self.tree.world.apples()[0];
        let gap = if self.tree.rng.random_range(0..3) == 0 {
            0.0005
        } else {
            self.tree.between(0.004..0.06)
        };
        let side = if self.tree.rng.random::<bool>() {
            1.0
        } else {
            -1.0
        };
        let lean = self.tree.isotropic() * 0.4;
        let toward = (target.center - bearing.curve.point(0.5)).normalize() + lean;
        let length = bearing.curve.length();
        // Along the branch in steps of half a millimetre until the gap is there.
        for step in 0..400 {
            let at = 0.5 + side * f64::from(step) * 0.0005 / length;
            if !(0.0..=1.0).contains(&at) {
                return;
            }
            let foot = bearing.curve.point(at);
            let tangent = bearing.curve.derivative(at).normalize();
            let distance = apple.radius + bearing.radius_at(at) + 0.003;
            let center = foot + across(&toward, &tangent) * distance;
            if (center - target.center).norm() >= apple.radius + target.radius + gap {
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
                return;
            }
        }
    }

    /// Spurs on the bearing branch within sight of the target, and the leaves, on
    /// the spurs or at the foot of the target's stalk; half of them towards the camera.
    pub(crate) fn spurs_and_leaves(&mut self, branch: usize, target_radius: f64) {
        let bearing = self.tree.world.branches()[branch];
        let length = bearing.curve.length();
        let mut sites = vec![bearing.curve.point(0.5)];
        for _ in 0..self.up_to(3) {
            let at = 0.5 + self.tree.between(-1.0..1.0) * 4.0 * target_radius / length;
            let root = bearing.curve.point(at.clamp(0.0, 1.0));
            let tangent = bearing.curve.derivative(at.clamp(0.0, 1.0)).normalize();
            let heading = across(&self.tree.isotropic(), &tangent);
            let tip = root + heading * (bearing.radius_at(0.5) + self.tree.between(0.01..0.04));
            let curve = Curve::straight(root, tip);
            if self.clearance(&curve) > 0.004 {
                let spur = Branch {
                    curve,
                    start_radius: 0.003,
                    end_radius: 0.002,
                };
                self.tree.world.add_twig(&spur, Bark::Wood);
                sites.push(tip);
            }
        }
        let leaves = self.up_to(self.orchard.leaves);
        // In half of the scenes some of the leaves hang before the target.
        let veil = if self.tree.rng.random::<bool>() {
            self.up_to(leaves.min(5))
        } else {
            0
        };
        for i in 0..leaves {
            if i < veil {
                self.leaf_before_target(sites[0]);
                continue;
            }
            let site = sites[self.tree.rng.random_range(0..sites.len())];
            let forward = if self.tree.rng.random::<bool>() {
                1.0
            } else {
                0.0
            };
            let heading = self.tree.isotropic() - Vector3::z() * forward;
            let stalk = self.tree.between(0.012..0.03);
            self.tree.leaf_on_stalk(site, heading.normalize(), stalk);
        }
    }

    /// A leaf between camera and target, on a thin shoot from `root`.
    fn leaf_before_target(&mut self, root: Point3<f64>) {
        let target = self.tree.world.apples()[0];
        let aside = self.tree.isotropic() * (0.6 * target.radius);
        let before = target.radius + self.tree.between(0.008..0.06);
        let tip = target.center + Vector3::new(aside.x, aside.y - 0.02, -before);
        let curve = Curve::bow(root, Vector3::new(aside.x, aside.y, -before), tip);
        if self.clearance(&curve) > 0.002 {
            let shoot = Branch {
                curve,
                start_radius: 0.0016,
                end_radius: 0.001,
            };
            self.tree.world.add_twig(&shoot, Bark::Wood);
        }
        let heading = Vector3::new(-aside.x, 0.5 * target.radius - aside.y, 0.3 * aside.z);
        let stalk = self.tree.between(0.005..0.012);
        self.tree.leaf_on_stalk(tip, heading.normalize(), stalk);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shot::Shot;
    use crate::visibility::{look_at, nearest_branch};
    use pomona_cloud::Camera;

    fn camera() -> Camera {
        Shot::paper_camera().with_intrinsics([320, 240], [270.0; 2], [159.5, 119.5])
    }

    #[test]
    fn layouts_keep_to_their_ranges() {
        let orchard = Orchard::default();
        for seed in 0..40 {
            let (world, cast) = orchard.layout(&camera(), seed);
            let target = world.apples()[0];
            assert!((0.030..=0.045).contains(&target.radius));
            assert!((0.7..=1.5).contains(&target.center.z));
            let near = nearest_branch(&world, &target.center).unwrap();
            assert_eq!(
                near.index, 0,
                "seed {seed}: another branch is nearer than its own"
            );
            assert!(near.distance <= 1.51 * target.radius, "seed {seed}");
            let branch = world.branches()[0];
            let radius = branch.radius_at(near.parameter);
            assert!((0.0025..=0.010).contains(&radius));
            assert!(
                near.distance >= target.radius + radius,
                "seed {seed}: the branch cuts in"
            );
            let seen = look_at(&world, &camera(), &cast, 0, 0.0, 1).unwrap();
            assert!(
                seen.visible_share.unwrap() >= orchard.least_visible,
                "seed {seed}"
            );
        }
    }

    #[test]
    fn apples_touch_and_do_not_overlap() {
        let (mut touching, mut pairs) = (0, 0);
        for seed in 0..60 {
            let world = Orchard::default().world(&camera(), seed);
            let apples = world.apples();
            for (i, a) in apples.iter().enumerate() {
                for b in &apples[i + 1..] {
                    let gap = (a.center - b.center).norm() - a.radius - b.radius;
                    assert!(gap > 0.0, "seed {seed}: {gap}");
                    pairs += 1;
                    touching += usize::from(gap < 0.0015);
                }
            }
        }
        assert!(
            touching > 3 && touching < pairs,
            "{touching} of {pairs} touch"
        );
    }
}
