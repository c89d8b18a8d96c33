//! The robot's stage: what it adds to a record.

use nalgebra::{Isometry3, Point3, Quaternion, UnitQuaternion, Vector3};
use pomona::record::PicksRecord;
use pomona::{ApproachConfig, CheckedFrame, Config, Picker, Robot, RobotFromCamera, RobotPlan};
use pomona_scenes::{Scene, Suite};
use pomona_transforms::Transform;

/// The camera looks along the robot's x axis, half a metre up.
pub(crate) fn transform() -> RobotFromCamera {
    let transform = Transform::from_quaternion([0.0, 0.0, 0.5], [-0.5, 0.5, -0.5, 0.5]).unwrap();
    RobotFromCamera::new(transform, "base_link", "camera_color_optical_frame")
}

fn lab() -> Scene {
    let mut cases = Suite::Lab15.cases();
    cases.find(|c| c.name.ends_with("-x0-s0")).unwrap().scene()
}

fn config() -> ApproachConfig {
    let mut config = ApproachConfig::default();
    // The lab's rig stands beside its apple.
    config.clearance.cloud_margin_m = -0.05;
    config
}

fn planned(scene: &Scene, config: &ApproachConfig) -> (PicksRecord, RobotPlan) {
    let picker = Picker::new(Config::default()).unwrap();
    let transform = transform();
    let frame = CheckedFrame::new(&scene.frame).unwrap();
    let mut answer = picker.pick(&frame, 0, Some(&transform)).unwrap();
    let robot = Robot::new(config.clone()).unwrap();
    let plan = robot.plan(&frame, &mut answer, &transform);
    (PicksRecord::from(&answer), plan)
}

#[test]
fn the_gripper_meets_the_apple_along_the_direction() {
    let scene = lab();
    let (record, _) = planned(&scene, &config());
    let pick = &record.picks[0];
    let (robot, plan) = (pick.robot.as_ref().unwrap(), &pick.plan);
    let gripper = plan.gripper.as_ref().unwrap();
    assert_eq!(gripper.frame_id, "base_link");
    for (found, wanted) in gripper.tool.position.iter().zip(robot.center) {
        assert!((found - wanted).abs() < 1e-12);
    }
    let approach = plan.approach.as_ref().unwrap();
    assert_eq!(
        (approach.status.as_str(), &approach.reason),
        ("free", &None)
    );
    let way = approach.way.as_ref().unwrap();
    let [x, y, z, w] = gripper.tool.quaternion_xyzw;
    let rotation = UnitQuaternion::new_normalize(Quaternion::new(w, x, y, z));
    let direction = Vector3::from(way.direction);
    assert!((rotation * Vector3::x() - direction).norm() < 1e-12);
    assert!((direction.angle(&Vector3::from(robot.direction)) - way.tilt).abs() < 1e-9);
    // Within the fit's errors the gripper ends at the true apple, in the base's frame.
    let truth = transform().transform.isometry() * Point3::from(scene.truth.apples[0].center);
    assert!((truth - Point3::from(gripper.tool.position)).norm() < 0.004);
    // The start is a quarter of a metre before the camera.
    let start = Point3::from(way.path.samples[0].position);
    assert!((start - Point3::new(0.25, 0.0, 0.5)).norm() < 1e-9);
    let [x, y, z, w] = way.path.samples[0].quaternion_xyzw;
    let looking = UnitQuaternion::new_normalize(Quaternion::new(w, x, y, z));
    assert!((looking * Vector3::x() - Vector3::x()).norm() < 1e-9);
    assert!((looking * Vector3::z() - Vector3::z()).norm() < 1e-9);
    assert_eq!(plan.order.as_ref().unwrap().reason, "unobstructed");
    assert!(plan.clearance.as_ref().unwrap().distance.is_finite());
}

#[test]
fn a_record_reads_back_and_is_unchanged_without_a_robot() {
    let scene = lab();
    let (record, _) = planned(&scene, &config());
    let text = serde_json::to_string(&record).unwrap();
    let back: PicksRecord = serde_json::from_str(&text).unwrap();
    assert_eq!(back.picks[0].plan.order, record.picks[0].plan.order);
    let way = |r: &PicksRecord| {
        r.picks[0]
            .plan
            .approach
            .as_ref()
            .unwrap()
            .way
            .clone()
            .unwrap()
    };
    assert_eq!(way(&back).path.pieces.len(), way(&record).path.pieces.len());
    let picker = Picker::new(Config::default()).unwrap();
    let plain = picker
        .pick(&CheckedFrame::new(&scene.frame).unwrap(), 0, None)
        .unwrap();
    let plain = PicksRecord::from(&plain);
    let text = serde_json::to_string(&plain).unwrap();
    assert!(!text.contains("approach") && !text.contains("\"order\""));
    assert_eq!(
        serde_json::from_str::<PicksRecord>(&text).unwrap().picks[0].plan,
        plain.picks[0].plan
    );
}

#[test]
fn a_refusal_says_why() {
    let mut small = config();
    small.gripper.jaw_width_m = 0.04;
    let (record, plan) = planned(&lab(), &small);
    let plan_record = &record.picks[0].plan;
    let approach = plan_record.approach.as_ref().unwrap();
    assert_eq!(approach.status, "gripper_too_small");
    assert!(approach.reason.as_ref().unwrap().contains("opening"));
    assert!(plan_record.gripper.is_none() && plan_record.order.is_none());
    assert!(plan.order.ranks.is_empty());
}

#[test]
fn a_configured_start_is_where_the_path_begins() {
    let mut config = config();
    config.motion.start_m = Some([0.3, 0.1, 0.4]);
    config.motion.start_quaternion_xyzw = Some([0.0, 0.0, 0.0, 1.0]);
    let (_, plan) = planned(&lab(), &config);
    assert_eq!(plan.start.0, Isometry3::translation(0.3, 0.1, 0.4));
}
