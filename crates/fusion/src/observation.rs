//! One apple as one frame shows it, in the robot's frame.

use nalgebra::{Matrix3, Point3, Vector3};
use pomona::{FusionConfig, Pick, RobotFromCamera, Status};
use pomona_transforms::{CameraFrame, Direction, Position, RobotFrame};

/// Smallest standard deviation of a centre or a radius, metres: keeps covariances invertible where the floors are 0.
const MIN_LENGTH_SD_M: f64 = 1e-5;

/// Smallest standard deviation of a direction, radians, for the same reason.
const MIN_DIRECTION_SD_RAD: f64 = 1e-4;

/// A stated confidence is brought into this range: the odds of 0 and 1 leave nothing to combine.
const CONFIDENCE_RANGE: (f64, f64) = (0.001, 0.999);

/// One apple as one frame shows it.
#[derive(Clone, Debug)]
pub(crate) struct Observation {
    /// Index of the frame.
    pub(crate) frame: usize,
    /// Id of the pick there.
    pub(crate) pick: usize,
    pub(crate) status: Status,
    /// Centre in the robot's frame, metres.
    pub(crate) center: Vector3<f64>,
    /// Covariance of the centre without the pose's share, m².
    pub(crate) covariance: Matrix3<f64>,
    pub(crate) radius_m: f64,
    pub(crate) radius_variance_m2: f64,
    /// Fraction of its silhouette's area on which its surface is visible; 1 where the method does not report it.
    pub(crate) visible_fraction: f64,
    pub(crate) direction: Option<ObservedDirection>,
    /// Distance of the foot of the perpendicular from the centre, metres.
    pub(crate) foot_distance_m: Option<f64>,
    /// Where a camera would see the apple less occluded.
    pub(crate) next_view: Option<Direction<RobotFrame>>,
}

/// A direction in the robot's frame, and how good it is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ObservedDirection {
    pub(crate) direction: Direction<RobotFrame>,
    pub(crate) sd_rad: f64,
    pub(crate) confidence: f64,
}

impl Observation {
    /// `None` where the pick has no apple, or one with numbers that are not finite or not positive.
    pub(crate) fn new(
        frame: usize,
        pick: &Pick,
        pose: &RobotFromCamera,
        config: &FusionConfig,
    ) -> Option<Self> {
        let apple = pick.apple.as_ref()?;
        let center = Position::<CameraFrame>::new(Point3::from(apple.center));
        let center = pose.transform.position(&center).point().coords;
        if !center.iter().all(|c| c.is_finite()) || !(apple.radius > 0.0) {
            return None;
        }
        let own = apple.center_covariance.map_or_else(
            || Matrix3::identity() * config.center_sd_m.powi(2),
            Matrix3::from,
        );
        let floor = config.center_floor_m.max(MIN_LENGTH_SD_M);
        let rotation = pose.transform.rotation().to_rotation_matrix().into_inner();
        let rotated = rotation * own * rotation.transpose();
        let covariance =
            (rotated + rotated.transpose()) * 0.5 + Matrix3::identity() * floor.powi(2);
        covariance.cholesky()?;
        let radius_sd = apple.radius_sd.unwrap_or(config.center_sd_m);
        let radius_floor = config.radius_floor_m.max(MIN_LENGTH_SD_M);
        let to_robot =
            |v: [f64; 3]| Direction::new(Vector3::from(v)).map(|d| pose.transform.direction(&d));
        let direction = pick
            .direction
            .filter(|_| pick.status == Status::Picked)
            .and_then(to_robot)
            .map(|direction| ObservedDirection {
                direction,
                sd_rad: direction_sd(pick.direction_sd, &direction, pose, config),
                confidence: pick
                    .confidence
                    .unwrap_or(config.confidence)
                    .clamp(CONFIDENCE_RANGE.0, CONFIDENCE_RANGE.1),
            });
        let foot = pick.foot.filter(|_| direction.is_some());
        Some(Self {
            frame,
            pick: pick.id,
            status: pick.status,
            center,
            covariance,
            radius_m: apple.radius,
            radius_variance_m2: radius_sd.powi(2) + radius_floor.powi(2),
            visible_fraction: apple.visible_share.unwrap_or(1.0),
            direction,
            foot_distance_m: foot.map(|f| (Vector3::from(f) - Vector3::from(apple.center)).norm()),
            next_view: pick.view_from.and_then(to_robot),
        })
    }
}

/// Standard deviation of a direction from its own error, the floor, and the rotation error of the pose across it.
fn direction_sd(
    stated_rad: Option<f64>,
    direction: &Direction<RobotFrame>,
    pose: &RobotFromCamera,
    config: &FusionConfig,
) -> f64 {
    let own = stated_rad.unwrap_or(config.direction_sd_rad);
    let rotation = pose.uncertain().rotation_covariance_rad2();
    let along = direction.vector().dot(&(rotation * direction.vector()));
    let across = (0.5 * (rotation.trace() - along)).max(0.0);
    (own.powi(2) + config.direction_floor_rad.powi(2) + across)
        .sqrt()
        .max(MIN_DIRECTION_SD_RAD)
}

/// The centroid of all observations, metres.
pub(crate) fn centroid(observations: &[Observation]) -> Vector3<f64> {
    let sum: Vector3<f64> = observations.iter().map(|o| o.center).sum();
    sum / (observations.len().max(1) as f64)
}

/// Mean of the radii, weighted by their inverse variances, and its standard deviation, metres.
pub(crate) fn mean_radius<'a>(
    observations: impl IntoIterator<Item = &'a Observation>,
) -> (f64, f64) {
    let (sum, weight) = observations
        .into_iter()
        .map(|o| (o.radius_m, o.radius_variance_m2.recip()))
        .fold((0.0, 0.0), |(sum, total), (radius, weight)| {
            (sum + radius * weight, total + weight)
        });
    (sum / weight, weight.recip().sqrt())
}
