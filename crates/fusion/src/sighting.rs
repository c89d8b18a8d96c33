//! One apple as one frame shows it, in the robot's frame.

use nalgebra::{Matrix3, Point3, UnitVector3, Vector3};
use pomona::{FusionConfig, Pick, RobotFromCamera, Status};
use pomona_transforms::{CameraFrame, Direction, Position};

/// One apple as one frame shows it.
#[derive(Clone, Debug)]
pub(crate) struct Sighting {
    pub(crate) frame: usize,
    pub(crate) pick: usize,
    pub(crate) status: Status,
    /// Centre in the robot's frame.
    pub(crate) center: Vector3<f64>,
    /// Its own covariance, without the pose's.
    pub(crate) covariance: Matrix3<f64>,
    pub(crate) radius: f64,
    /// Share of its outline on which its surface shows; 1 where the method does not say.
    pub(crate) visible_share: f64,
    pub(crate) radius_variance: f64,
    pub(crate) direction: Option<DirectionSighting>,
    /// Distance of the foot from the centre.
    pub(crate) foot_distance: Option<f64>,
    pub(crate) view_from: Option<Vector3<f64>>,
}

/// A direction in the robot's frame, and how good it is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DirectionSighting {
    pub(crate) unit: UnitVector3<f64>,
    pub(crate) sd: f64,
    pub(crate) confidence: f64,
}

impl Sighting {
    /// `None` where the pick has no apple, or one whose numbers are none.
    pub(crate) fn new(
        frame: usize,
        pick: &Pick,
        pose: &RobotFromCamera,
        config: &FusionConfig,
    ) -> Option<Self> {
        let apple = pick.apple.as_ref()?;
        let place = Position::<CameraFrame>::new(Point3::from(apple.center));
        let center = pose.transform.position(&place).point().coords;
        if !center.iter().all(|c| c.is_finite()) || !(apple.radius > 0.0) {
            return None;
        }
        let own = apple.center_covariance.map_or_else(
            || Matrix3::identity() * config.center_sd_m.powi(2),
            Matrix3::from,
        );
        // The least that keeps it invertible is a hundredth of a millimetre.
        let floor = config.center_floor_m.max(1e-5);
        let rotation = pose.transform.rotation().to_rotation_matrix().into_inner();
        let turned = rotation * own * rotation.transpose();
        let covariance = (turned + turned.transpose()) * 0.5 + Matrix3::identity() * floor.powi(2);
        covariance.cholesky()?;
        let sd = apple.radius_sd.unwrap_or(config.center_sd_m);
        let turn =
            |v: [f64; 3]| Direction::new(Vector3::from(v)).map(|d| pose.transform.direction(&d));
        let direction = pick
            .direction
            .filter(|_| pick.status == Status::Picked)
            .and_then(turn)
            .map(|d| {
                let unit = d.unit();
                DirectionSighting {
                    unit,
                    sd: direction_sd(pick, &unit, pose, config),
                    confidence: pick
                        .confidence
                        .unwrap_or(config.confidence)
                        .clamp(0.001, 0.999),
                }
            });
        let foot = pick.foot.filter(|_| direction.is_some());
        Some(Self {
            frame,
            pick: pick.id,
            status: pick.status,
            center,
            covariance,
            radius: apple.radius,
            visible_share: apple.visible_share.unwrap_or(1.0),
            radius_variance: sd.powi(2) + config.radius_floor_m.max(1e-5).powi(2),
            direction,
            foot_distance: foot.map(|f| (Vector3::from(f) - Vector3::from(apple.center)).norm()),
            view_from: pick.view_from.and_then(turn).map(|d| d.vector()),
        })
    }
}

/// The direction's own error, the floor, and the pose's across it.
fn direction_sd(
    pick: &Pick,
    unit: &UnitVector3<f64>,
    pose: &RobotFromCamera,
    config: &FusionConfig,
) -> f64 {
    let own = pick.direction_sd.unwrap_or(config.direction_sd_rad);
    let omega = pose.uncertain().rotation_covariance_rad2();
    let along = unit.dot(&(omega * unit.into_inner()));
    let across = (0.5 * (omega.trace() - along)).max(0.0);
    (own.powi(2) + config.direction_floor_rad.powi(2) + across)
        .sqrt()
        .max(1e-4)
}
