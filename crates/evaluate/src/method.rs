use pomona::{CheckedFrame, FrameAnswer, PickError, Picker, RobotFromCamera};

/// What can be evaluated: something that answers a frame.
///
/// A [`Picker`] is one; tests wrap it to see whether a broken method is caught.
pub trait PickMethod: Sync {
    /// Its name in tables and files.
    fn name(&self) -> &str;

    /// The answers for the boxes of a frame, in the camera's frame.
    ///
    /// # Errors
    ///
    /// Where the frame cannot be worked on at all.
    fn answer(&self, frame: &CheckedFrame<'_>, seed: u64) -> Result<FrameAnswer, PickError>;

    /// The same with the answers in a robot's frame too. Without a method's own the answers stay in the camera's
    /// frame, and nothing is measured in the base's.
    ///
    /// # Errors
    ///
    /// As [`PickMethod::answer`].
    fn answer_for_robot(
        &self,
        frame: &CheckedFrame<'_>,
        seed: u64,
        _robot_from_camera: &RobotFromCamera,
    ) -> Result<FrameAnswer, PickError> {
        self.answer(frame, seed)
    }
}

impl PickMethod for Picker {
    fn name(&self) -> &str {
        self.config().method.name()
    }

    fn answer(&self, frame: &CheckedFrame<'_>, seed: u64) -> Result<FrameAnswer, PickError> {
        self.pick(frame, seed, None)
    }

    fn answer_for_robot(
        &self,
        frame: &CheckedFrame<'_>,
        seed: u64,
        robot_from_camera: &RobotFromCamera,
    ) -> Result<FrameAnswer, PickError> {
        self.pick(frame, seed, Some(robot_from_camera))
    }
}
