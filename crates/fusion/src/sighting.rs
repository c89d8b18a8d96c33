//! One apple as one frame shows it, in the robot's frame.

use nalgebra::{Matrix3, UnitVector3, Vector3};
use pomona::{AppleAnswer, FusionConfig, PickDirection, RobotFromCamera, Status};

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
    /// `None` where the answer has no apple, or one whose numbers are none.
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
        // The least that keeps it invertible is a hundredth of a millimetre.
        let floor = config.center_floor_m.max(1e-5);
        let covariance = own + Matrix3::identity() * floor.powi(2);
        covariance.cholesky()?;
        let sd = apple.radius_sd_m.unwrap_or(config.center_sd_m);
        let direction = answer.pick.map(|pick| {
            let unit = transform.direction(&pick.direction).unit();
            DirectionSighting {
                unit,
                sd: direction_sd(&pick, &unit, pose, config),
                confidence: answer
                    .confidence
                    .unwrap_or(config.confidence)
                    .clamp(0.001, 0.999),
            }
        });
        Some(Self {
            frame,
            pick: answer.id,
            status: answer.status,
            center,
            covariance,
            radius: apple.radius_m,
            visible_share: apple.visible_share.unwrap_or(1.0),
            radius_variance: sd.powi(2) + config.radius_floor_m.max(1e-5).powi(2),
            direction,
            foot_distance: answer.pick.map(|pick| pick.foot.distance(&apple.center)),
            view_from: answer
                .view_from
                .map(|direction| transform.direction(&direction).vector()),
        })
    }
}

/// The direction's own error, the floor, and the pose's across it.
fn direction_sd(
    pick: &PickDirection,
    unit: &UnitVector3<f64>,
    pose: &RobotFromCamera,
    config: &FusionConfig,
) -> f64 {
    let own = pick.sd_rad.unwrap_or(config.direction_sd_rad);
    let omega = pose.uncertain().rotation_covariance_rad2();
    let along = unit.dot(&(omega * unit.into_inner()));
    let across = (0.5 * (omega.trace() - along)).max(0.0);
    (own.powi(2) + config.direction_floor_rad.powi(2) + across)
        .sqrt()
        .max(1e-4)
}
