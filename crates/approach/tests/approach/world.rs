//! Scenes whose truth is known, and what a planner sees of them.

use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3};
use pomona_approach::{ApproachConfig, ObstacleMap, Planner, StartPose, Target};
use pomona_geometry::{Capsule, Segment, Sphere};
use pomona_transforms::Direction;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// The truth, and the same with errors of at most [`World::error_m`].
pub(crate) struct World {
    pub(crate) apples: Vec<Sphere>,
    pub(crate) branches: Vec<Capsule>,
    pub(crate) leaves: Vec<Point3<f64>>,
    pub(crate) seen: ObstacleMap,
    pub(crate) seen_apples: Vec<Sphere>,
    pub(crate) targets: Vec<Target>,
    pub(crate) start: StartPose,
    /// Every point of the truth is within this of its like as seen.
    pub(crate) error_m: f64,
}

pub(crate) fn unit(rng: &mut ChaCha8Rng) -> Vector3<f64> {
    loop {
        let v = Vector3::from_fn(|_, _| rng.random_range(-1.0..1.0));
        if (0.01..1.0).contains(&v.norm_squared()) {
            return v.normalize();
        }
    }
}

/// One cell for each point, so that none is lost.
pub(crate) fn config() -> ApproachConfig {
    let mut config = ApproachConfig::default();
    config.clearance.voxel_min_points = 1;
    config
}

pub(crate) fn planner() -> Planner {
    Planner::new(config()).unwrap()
}

impl World {
    /// A cluster of apples on branches, with leaves about it.
    pub(crate) fn random(seed: u64) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let half_error = 0.001;
        let center = Point3::new(
            rng.random_range(0.6..0.9),
            rng.random_range(-0.3..0.3),
            rng.random_range(0.2..0.7),
        );
        let (mut apples, mut branches, mut targets) = (Vec::new(), Vec::new(), Vec::new());
        for number in 0..rng.random_range(1..=6) {
            let place = center + unit(&mut rng) * rng.random_range(0.0..0.25);
            let apple = Sphere::new(place, rng.random_range(0.025..0.042)).unwrap();
            // Mostly upwards, as fruit hangs.
            let up = (Vector3::z() + unit(&mut rng) * 0.8).normalize();
            let along = up.cross(&unit(&mut rng)).normalize();
            let radius = rng.random_range(0.002..0.008);
            let foot = place + up * (apple.radius + radius + rng.random_range(0.0..0.02));
            let (back, ahead) = (rng.random_range(0.02..0.3), rng.random_range(0.02..0.3));
            let axis = Segment::new(foot - along * back, foot + along * ahead).unwrap();
            branches.push(Capsule::new(axis, radius).unwrap());
            apples.push(apple);
            let mut target = Target::new(number, Direction::new(up).unwrap());
            target.branch = Some(along);
            target.direction_uncertainty_rad = rng.random_range(0.0..0.4);
            target.confidence = rng.random_range(0.0..1.0);
            targets.push(target);
        }
        let leaves = leaves(&mut rng, &center);
        let jitter = |rng: &mut ChaCha8Rng, p: &Point3<f64>| p + unit(rng) * half_error;
        let seen_apples: Vec<Sphere> = apples
            .iter()
            .map(|a| {
                let radius = a.radius + rng.random_range(-half_error..half_error);
                Sphere::new(jitter(&mut rng, &a.center), radius).unwrap()
            })
            .collect();
        let seen_branches = branches
            .iter()
            .map(|b| {
                let radius = b.radius + rng.random_range(-half_error..half_error);
                let (start, end) = (b.segment.start, b.segment.end);
                let axis = Segment::new(jitter(&mut rng, &start), jitter(&mut rng, &end)).unwrap();
                Capsule::new(axis, radius).unwrap()
            })
            .collect();
        let cloud: Vec<_> = leaves.iter().map(|p| jitter(&mut rng, p)).collect();
        let seen = ObstacleMap::new(
            seen_apples.clone(),
            seen_branches,
            &cloud,
            &config().clearance,
        );
        let turn = UnitQuaternion::from_scaled_axis(unit(&mut rng) * rng.random_range(0.0..1.0));
        let place = Translation3::new(0.3, rng.random_range(-0.3..0.3), rng.random_range(0.1..0.8));
        Self {
            apples,
            branches,
            leaves,
            seen,
            seen_apples,
            targets,
            start: StartPose(Isometry3::from_parts(place, turn)),
            error_m: 2.0 * half_error,
        }
    }
}

/// Discs of points.
fn leaves(rng: &mut ChaCha8Rng, center: &Point3<f64>) -> Vec<Point3<f64>> {
    let mut points = Vec::new();
    for _ in 0..rng.random_range(0..12) {
        let middle = center + unit(rng) * rng.random_range(0.05..0.35);
        let across = unit(rng);
        let along = across.cross(&unit(rng)).normalize();
        let other = across.cross(&along);
        for i in -4..=4_i32 {
            for j in -4..=4_i32 {
                if i * i + j * j <= 16 {
                    let (i, j) = (0.006 * f64::from(i), 0.006 * f64::from(j));
                    points.push(middle + along * i + other * j);
                }
            }
        }
    }
    points
}

/// A scene of one apple under a branch along y, in easy reach, and what more is asked for.
pub(crate) struct Simple {
    pub(crate) apples: Vec<Sphere>,
    pub(crate) branches: Vec<Capsule>,
    pub(crate) cloud: Vec<Point3<f64>>,
    pub(crate) target: Target,
    pub(crate) start: StartPose,
}

impl Simple {
    pub(crate) fn new() -> Self {
        let axis = Segment::new(Point3::new(0.8, -0.3, 0.55), Point3::new(0.8, 0.3, 0.55));
        let mut target = Target::new(0, Direction::new(Vector3::z()).unwrap());
        target.branch = Some(Vector3::y());
        Self {
            apples: vec![Sphere::new(Point3::new(0.8, 0.0, 0.5), 0.035).unwrap()],
            branches: vec![Capsule::new(axis.unwrap(), 0.005).unwrap()],
            cloud: Vec::new(),
            target,
            start: StartPose::looking_along_x(Point3::new(0.3, 0.0, 0.3)),
        }
    }

    pub(crate) fn scene(&self, config: &ApproachConfig) -> ObstacleMap {
        let (apples, branches) = (self.apples.clone(), self.branches.clone());
        ObstacleMap::new(apples, branches, &self.cloud, &config.clearance)
    }

    /// A ball of cloud points, as of a bundle of leaves.
    pub(crate) fn lump(&mut self, center: [f64; 3]) {
        let center = Point3::from(center);
        for i in 0..200 {
            let i = f64::from(i);
            let (z, angle) = (i / 100.0 - 0.995, 2.4 * i);
            let ring = (1.0 - z * z).sqrt() * 0.01;
            let (s, c) = angle.sin_cos();
            self.cloud
                .push(center + Vector3::new(ring * c, ring * s, 0.01 * z));
        }
    }
}
