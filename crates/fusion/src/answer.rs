//! What several frames say together, typed.

use nalgebra::{Isometry3, Vector3};
use pomona::Status;
use pomona_transforms::{Direction, Position, RobotFrame, UncertainPosition};
use serde::{Deserialize, Serialize};

/// The apples of one tree from several frames.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct FusedTree {
    /// Name of the robot's frame, in which positions and directions are given.
    pub frame_id: String,
    /// The frames, in the order in which they were given.
    pub frames: Vec<FusedFrame>,
    /// The apples, in the order in which the frames show them first.
    pub apples: Vec<FusedApple>,
}

/// One of the frames.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct FusedFrame {
    /// Its id.
    pub id: String,
    /// Name of the camera's frame.
    pub camera_frame_id: String,
    /// How many apples it shows with a sphere.
    pub apples: usize,
    /// How many of these another frame shows at the same position.
    pub shared: usize,
    /// The common shift of its apples; absent for the first frame and where no apple is shared.
    pub shift: Option<FrameShift>,
    /// Takes points of the robot's frame, as the frame's pose gives them, to where the fused apples are: the estimated
    /// motion of the frame taken off.
    pub correction: Isometry3<f64>,
}

/// A shift that all apples of a frame have in common: sway of the tree, or an error of the poses.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct FrameShift {
    /// From the position in the first frame to that in this one, at the centroid of the tree, metres.
    pub by: Vector3<f64>,
    /// Standard deviation of the shift, the mean over the axes, metres.
    pub sd_m: f64,
    /// Whether noise and the stated errors of the poses explain it at the rate of `fusion.moved_rate` only.
    pub significant: bool,
}

/// What became of a fused apple.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[non_exhaustive]
pub enum FusedStatus {
    /// It has a direction.
    Picked,
    /// No frame gives it a direction.
    NoDirection,
    /// The frames' directions contradict each other, and none is sure enough.
    Contradiction,
    /// There is a direction, but it is not sure enough.
    Unsure,
}

impl FusedStatus {
    /// Its name in `fused.json`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Picked => "picked",
            Self::NoDirection => "no_direction",
            Self::Contradiction => "contradiction",
            Self::Unsure => "unsure",
        }
    }
}

/// An apple of the tree.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct FusedApple {
    /// Its number, from 0.
    pub id: usize,
    /// What became of it.
    pub status: FusedStatus,
    /// Its centre, with the covariance that includes the errors of the poses; of an apple that has moved that of the last
    /// frame that shows it.
    pub center: UncertainPosition<RobotFrame>,
    /// Its radius, metres.
    pub radius_m: f64,
    /// Standard deviation of the radius, metres.
    pub radius_sd_m: f64,
    /// Direction of approach, where the status is `Picked`.
    pub direction: Option<FusedDirection>,
    /// Probability that the direction is at most 20 degrees off, also where it is refused.
    pub confidence: Option<f64>,
    /// Where the status and the confidence come from, in words.
    pub reason: String,
    /// How it has moved between frames.
    pub movement: Option<Movement>,
    /// For an apple without a direction: from its centre towards where a camera would see it less occluded, one for each
    /// frame that says so.
    pub next_views: Vec<Direction<RobotFrame>>,
    /// The frames' observations of it, in the order of the frames.
    pub observations: Vec<FusedObservation>,
}

/// The direction of approach to a fused apple.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct FusedDirection {
    /// From the centre to the branch.
    pub direction: Direction<RobotFrame>,
    /// Its standard deviation as an angle, radians.
    pub sd_rad: f64,
    /// Foot of the perpendicular from the centre on the branch, where a frame gives one.
    pub foot: Option<Position<RobotFrame>>,
}

/// A movement of one apple beyond the shift that all apples of a frame have in common.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Movement {
    /// Its other position.
    pub from: Position<RobotFrame>,
    /// From there to its centre, metres.
    pub by: Vector3<f64>,
    /// Standard deviation of the distance, metres.
    pub sd_m: f64,
    /// Indices of the frames that show it at its other position.
    pub frames: Vec<usize>,
}

/// What became of the position at which one frame shows an apple.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[non_exhaustive]
pub enum PositionUse {
    /// It is one of those that agree.
    Used,
    /// The apple has moved: it was there in that frame.
    Elsewhere,
    /// It contradicts a position that is better visible, and counts for nothing.
    Misfit,
}

/// What became of one frame's direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[non_exhaustive]
pub enum DirectionUse {
    /// There is none.
    None,
    /// It is one of those that agree.
    Used,
    /// It contradicts them.
    Outlier,
    /// It is of a position that is not the apple's any more, or never was.
    Stale,
}

/// One frame's observation of an apple, and what it was used for.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct FusedObservation {
    /// Index of the frame.
    pub frame: usize,
    /// Id of the pick there.
    pub pick: usize,
    /// The pick's status.
    pub status: Status,
    /// What became of its position.
    pub position_use: PositionUse,
    /// Distance of its centre, the frame's motion taken off, from the fused one, metres; of an apple that has moved from
    /// that of its position then.
    pub residual_m: f64,
    /// What became of its direction.
    pub direction_use: DirectionUse,
    /// Angle of its direction to the fused one, radians.
    pub direction_offset_rad: Option<f64>,
}
