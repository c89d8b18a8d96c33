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
