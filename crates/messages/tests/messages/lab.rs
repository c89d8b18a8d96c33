//! A frame of the lab and what a robot plans for it.

use pomona::{
    ApproachConfig, CheckedFrame, Config, FrameAnswer, Picker, Robot, RobotFromCamera, RobotPlan,
};
use pomona_scenes::{Scene, Suite};
use pomona_transforms::Transform;

/// The camera looks along the robot's x axis, half a metre up.
pub(crate) fn transform() -> RobotFromCamera {
    let transform = Transform::from_quaternion([0.0, 0.0, 0.5], [-0.5, 0.5, -0.5, 0.5]).unwrap();
    RobotFromCamera::new(transform, "base_link", "camera_color_optical_frame")
}

pub(crate) fn lab() -> Scene {
    let mut cases = Suite::Lab15.cases();
    cases.find(|c| c.name.ends_with("-x0-s0")).unwrap().scene()
}

pub(crate) fn config() -> ApproachConfig {
    let mut config = ApproachConfig::default();
    // The lab's rig stands beside its apple.
    config.clearance.cloud_margin_m = -0.05;
    config
}

pub(crate) fn planned(scene: &Scene, config: &ApproachConfig) -> (FrameAnswer, RobotPlan) {
    let picker = Picker::new(Config::default()).unwrap();
    let transform = transform();
    let frame = CheckedFrame::new(&scene.frame).unwrap();
    let mut answer = picker.pick(&frame, 0, Some(&transform)).unwrap();
    let robot = Robot::new(config.clone()).unwrap();
    let plan = robot.plan(&frame, &mut answer, &transform);
    (answer, plan)
}
