//! One apple as one frame shows it, in the robot's frame.

use nalgebra::{Matrix3, Vector3};
use pomona::{AppleAnswer, FusionConfig, PickDirection, RobotFromCamera, Status};
use pomona_transforms::{Direction, RobotFrame};

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
    /// `None` where the answer has no apple, or one with numbers that are not finite or not positive.
    pub(crate) fn new(
        frame: usize,
        answer: &AppleAnswer,
        pose: &RobotFromCamera,
        config: &FusionConfig,
    ) -> Option<Self> {
        let apple = answer.apple.as_ref()?;
        let transform = &pose.transform;
        let center = transform.position(&apple.center).point().coords;
        if !center.iter().all(|c| c.is_finite()) || !(apple.radius_m > 0.0) {
            return None;
        }
        let own = apple.center_covariance.map_or_else(
            || Matrix3::identity() * config.center_sd_m.powi(2),
            |own| own.rotated(transform).matrix_m2(),
        );
        let floor = config.center_floor_m.max(MIN_LENGTH_SD_M);
        let covariance = own + Matrix3::identity() * floor.powi(2);
        covariance.cholesky()?;
        let radius_sd = apple.radius_sd_m.unwrap_or(config.center_sd_m);
        let radius_floor = config.radius_floor_m.max(MIN_LENGTH_SD_M);
        let stated = answer.confidence.unwrap_or(config.confidence);
        let confidence = stated.clamp(CONFIDENCE_RANGE.0, CONFIDENCE_RANGE.1);
        Some(Self {
            frame,
            pick: answer.id,
            status: answer.status,
            center,
            covariance,
            radius_m: apple.radius_m,
            radius_variance_m2: radius_sd.powi(2) + radius_floor.powi(2),
            visible_fraction: apple.visible_share.unwrap_or(1.0),
            direction: answer
                .pick
                .map(|pick| ObservedDirection::new(&pick, confidence, pose, config)),
            foot_distance_m: answer.pick.map(|pick| pick.foot.distance(&apple.center)),
            next_view: answer.view_from.map(|view| transform.direction(&view)),
        })
    }
}

impl ObservedDirection {
    /// Its variance is the sum of the direction's own, of the floor, and of the pose's rotation error across it.
    fn new(
        pick: &PickDirection,
        confidence: f64,
        pose: &RobotFromCamera,
        config: &FusionConfig,
    ) -> Self {
        let direction = pose.transform.direction(&pick.direction);
        let own = pick.sd_rad.unwrap_or(config.direction_sd_rad);
        let rotation = pose.uncertain().rotation_covariance_rad2();
        let along = direction.vector().dot(&(rotation * direction.vector()));
        // The two axes across the direction share the rest of the trace.
        let across = (0.5 * (rotation.trace() - along)).max(0.0);
        let variance = own.powi(2) + config.direction_floor_rad.powi(2) + across;
        Self {
            direction,
            sd_rad: variance.sqrt().max(MIN_DIRECTION_SD_RAD),
            confidence,
        }
    }
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
