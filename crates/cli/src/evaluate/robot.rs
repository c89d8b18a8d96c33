//! The simulated robot: its settings, and the noise with which its camera is calibrated.

use clap::Args;
use pomona::{ApproachConfig, Robot};
use pomona_evaluate::{CalibrationNoise, RobotTrial};
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(super) struct RobotArguments {
    /// Simulate a robot: for each frame a camera is mounted on it and calibrated from noisy samples, the picks are
    /// planned, and the gripper is compared with the ground truth in the base frame. With =FILE, the settings of a
    /// robot (see `pomona config --robot`).
    #[arg(long, value_name = "FILE", num_args = 0..=1, require_equals = true, conflicts_with = "calipers")]
    #[allow(
        clippy::option_option,
        reason = "an option whose value may be left out, as clap has it"
    )]
    pub(super) robot: Option<Option<PathBuf>>,
    /// Rotation noise of the calibration samples, root mean square of the angle.
    #[arg(long, value_name = "DEG", default_value_t = 0.2, requires = "robot")]
    pub(super) calibration_noise_deg: f64,
    /// Translation noise of the calibration samples, root mean square of the length.
    #[arg(long, value_name = "MM", default_value_t = 1.0, requires = "robot")]
    pub(super) calibration_noise_mm: f64,
    /// Number of calibration samples.
    #[arg(long, value_name = "N", default_value_t = 15, requires = "robot")]
    pub(super) calibration_poses: usize,
}

impl RobotArguments {
    /// The robot that is asked for and the noise of its calibration.
    pub(super) fn trial(&self) -> anyhow::Result<Option<RobotTrial>> {
        let config = match &self.robot {
            None => return Ok(None),
            Some(None) => ApproachConfig::default(),
            Some(Some(path)) => ApproachConfig::read(path)?,
        };
        let mut noise = CalibrationNoise::default();
        noise.poses = self.calibration_poses;
        noise.rotation_rad = self.calibration_noise_deg.to_radians();
        noise.translation_m = self.calibration_noise_mm / 1e3;
        Ok(Some(RobotTrial::new(Robot::new(config)?, noise)))
    }
}
