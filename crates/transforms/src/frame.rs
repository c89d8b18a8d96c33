/// A coordinate frame, as a type that no value is ever made of.
///
/// ```
/// use pomona_transforms::{FrameTag, RobotFrame, Transform};
///
/// enum PlatformFrame {}
/// impl FrameTag for PlatformFrame {
///     const NAME: &'static str = "platform";
/// }
///
/// fn drive(platform_from_robot: &Transform<PlatformFrame, RobotFrame>) {}
/// ```
pub trait FrameTag: 'static {
    /// A short name in lower case, as it stands in `destination_from_source`.
    const NAME: &'static str;
}

/// The camera's frame, REP-103 optical: x right, y down, z forward; its origin is the centre of
/// projection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CameraFrame {}

impl FrameTag for CameraFrame {
    const NAME: &'static str = "camera";
}

/// The frame of the robot's base, in which its arm is commanded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RobotFrame {}

impl FrameTag for RobotFrame {
    const NAME: &'static str = "robot";
}

/// The robot's flange: the plate at the end of the arm, whose pose the robot's program tells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FlangeFrame {}

impl FrameTag for FlangeFrame {
    const NAME: &'static str = "flange";
}

/// The tool's frame, its origin at the tool centre point (TCP): the place that is brought to the
/// fruit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ToolFrame {}

impl FrameTag for ToolFrame {
    const NAME: &'static str = "tool";
}

/// The frame of a calibration target: a marker or a board, as its detector defines it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TargetFrame {}

impl FrameTag for TargetFrame {
    const NAME: &'static str = "target";
}
