use super::mounting::{CalibrationNoise, Mounting};
use crate::error::EvaluateError;
use crate::method::PickMethod;
use crate::subject::Subject;
use pomona::{CheckedFrame, FrameAnswer, Robot};
use pomona_transforms::NamedTransform;

/// The offset basis and the prime of FNV-1a with 64 bits, whose digests are the same on every machine (RFC 9923).
const FNV_OFFSET_BASIS: u64 = 0xcbf2_9ce4_8422_2325;
const FNV_PRIME: u64 = 0x0100_0000_01b3;

/// Name of the simulated robot's frame.
const BASE: &str = "base_link";

/// A robot to send to the apples of each frame, with a camera that is mounted and calibrated anew for each.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct RobotTrial {
    /// The robot.
    pub robot: Robot,
    /// What its calibrations are made from.
    pub noise: CalibrationNoise,
}

impl RobotTrial {
    /// This robot, calibrated from measurements with this noise.
    pub fn new(robot: Robot, noise: CalibrationNoise) -> Self {
        Self { robot, noise }
    }

    /// The camera's place for a frame: it depends on the frame's suite and name and on `seed`, not on the method.
    ///
    /// # Errors
    ///
    /// [`EvaluateError::Noise`], [`EvaluateError::Calibration`].
    pub(crate) fn mounting(&self, subject: &Subject, seed: u64) -> Result<Mounting, EvaluateError> {
        let mut digest = FNV_OFFSET_BASIS;
        let name = subject.suite.bytes().chain([0]).chain(subject.name.bytes());
        for byte in name.chain(seed.to_le_bytes()) {
            digest = (digest ^ u64::from(byte)).wrapping_mul(FNV_PRIME);
        }
        Mounting::calibrated(digest, &self.noise).map_err(|error| error.of(&subject.name))
    }

    /// The method's answers and the robot's plans under the estimated place of the camera.
    pub(crate) fn answer(
        &self,
        method: &dyn PickMethod,
        frame: &CheckedFrame<'_>,
        seed: u64,
        mounting: &Mounting,
    ) -> Result<FrameAnswer, EvaluateError> {
        let transform = NamedTransform {
            covariance: Some(mounting.estimate.covariance),
            ..NamedTransform::new(
                mounting.estimate.transform,
                BASE,
                frame.frame().camera.frame_id.clone(),
            )
        };
        let mut answer = method.answer_for_robot(frame, seed, &transform)?;
        self.robot.plan(frame, &mut answer, &transform);
        Ok(answer)
    }
}
