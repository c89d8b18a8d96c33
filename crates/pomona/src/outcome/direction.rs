use super::robot::RobotTarget;
use nalgebra::{Unit, Vector3};
use pomona_transforms::{CameraFrame, Direction, Position};
use serde::{Deserialize, Serialize};

/// The direction in which an apple is approached: from its centre to the foot of the perpendicular on its branch.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct PickDirection {
    /// Foot of the perpendicular from the apple's centre on the branch: the paper's C.
    pub foot: Position<CameraFrame>,
    /// From the centre to the foot.
    pub direction: Direction<CameraFrame>,
    /// Standard deviation of the direction as an angle, radians, where the method states one.
    pub sd_rad: Option<f64>,
}

impl PickDirection {
    /// The direction from `center` to `foot`; `None` where they coincide to within a nanometre.
    pub fn new(center: &Position<CameraFrame>, foot: Position<CameraFrame>) -> Option<Self> {
        const LEAST_DISTANCE_M: f64 = 1e-9;
        let direction = unit(foot.point() - center.point(), LEAST_DISTANCE_M)?;
        Some(Self {
            foot,
            direction,
            sd_rad: None,
        })
    }
}

/// The direction of `vector`; `None` where its length is at most `least`.
pub(crate) fn unit(vector: Vector3<f64>, least: f64) -> Option<Direction<CameraFrame>> {
    Unit::try_new(vector, least).map(Direction::from_unit)
}

/// A direction of approach for an apple whose branch is not known: a guess from its surroundings, no answer.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct FallbackDirection {
    /// The direction of approach.
    pub direction: Direction<CameraFrame>,
    /// What it is derived from.
    pub source: DirectionSource,
    /// The same in the robot's frame, where a transform was given.
    pub robot: Option<RobotTarget>,
}

impl FallbackDirection {
    /// A direction that is not known in the robot's frame.
    pub fn new(direction: Direction<CameraFrame>, source: DirectionSource) -> Self {
        Self {
            direction,
            source,
            robot: None,
        }
    }
}

/// What a fallback direction is derived from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum DirectionSource {
    /// The mean normal of the visible cap.
    SurfaceNormal,
    /// The nearest obstacle.
    AwayFromObstacle,
}

impl DirectionSource {
    /// Its name in `picks.json`.
    pub fn name(self) -> &'static str {
        match self {
            Self::SurfaceNormal => "surface_normal",
            Self::AwayFromObstacle => "away_from_obstacle",
        }
    }
}
