use crate::record::Record;
use pomona_transforms::{CameraFrame, NamedTransform, RobotFrame};

/// The transform that brings camera coordinates into the robot's frame.
pub type RobotFromCamera = NamedTransform<RobotFrame, CameraFrame>;

/// What supports one answer: pixels of the depth image as `v * width + u`, for pictures.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Evidence {
    /// Pixels on the apple's surface.
    pub surface: Vec<u32>,
    /// Pixels on its branch.
    pub branch: Vec<u32>,
}

/// The answers for a frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// What `picks.json` holds.
    pub record: Record,
    /// The evidence of each pick, in the same order.
    pub evidence: Vec<Evidence>,
}
