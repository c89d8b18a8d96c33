//! The pipeline on generated frames: what it finds, what it refuses, and that it repeats itself.

#![allow(
    clippy::unwrap_used,
    reason = "a test that cannot go on should fail where it stands"
)]

use nalgebra::{Isometry3, Point3, UnitQuaternion, Vector3};
use pomona::{Config, Method, PickError, Picker, RobotFromCamera, Status};
use pomona_cloud::{DepthImage, PixelBox};
use pomona_scenes::{Scene, Suite};
use pomona_transforms::Transform;

fn lab(orientation: &str) -> Scene {
    let suffix = format!("-{orientation}-s0");
    Suite::Lab15
        .cases()
        .find(|case| case.name.ends_with(&suffix))
        .unwrap()
        .scene()
}

fn picker() -> Picker {
    Picker::new(Config {
        method: Method::Paper,
        ..Config::default()
    })
    .unwrap()
}

fn degrees_between(a: [f64; 3], b: [f64; 3]) -> f64 {
    Vector3::from(a).angle(&Vector3::from(b)).to_degrees()
}

#[test]
fn finds_the_lab_apple_and_its_branch() {
    let scene = lab("x0");
    let outcome = picker().pick(&scene.frame, 0, None).unwrap();
    let [pick] = &outcome.record.picks[..] else {
        panic!("one box, one pick")
    };
    let truth = &scene.truth.apples[0];
    assert_eq!(pick.status, Status::Picked);
    let apple = pick.apple.as_ref().unwrap();
    assert!((Point3::from(apple.center) - Point3::from(truth.center)).norm() < 0.002);
    assert!((apple.radius - truth.radius).abs() < 0.002);
    // The line lies on the branch's visible side, half its thickness off the axis: about
    // atan(2.5 / 33) = 4.3° at this distance.
    assert!(degrees_between(pick.direction.unwrap(), truth.direction.unwrap()) < 8.0);
    let foot = Point3::from(pick.foot.unwrap());
    let along = foot - Point3::from(apple.center);
    let branch = pick.branch.as_ref().unwrap();
    assert!(
        along.dot(&Vector3::from(branch.direction)).abs() < 1e-12,
        "OC is across the branch"
    );
    assert!(degrees_between(along.into(), pick.direction.unwrap()) < 1e-5);

    let evidence = &outcome.evidence[0];
    assert_eq!(evidence.surface.len(), apple.inliers);
    assert_eq!(evidence.branch.len(), branch.inliers);
    assert!(pick.robot.is_none());
}

#[test]
fn threads_and_repetition_do_not_change_the_record() {
    let scene = Suite::Demo.scenes().next().unwrap();
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        let outcome = pool
            .install(|| picker().pick(&scene.frame, 7, None))
            .unwrap();
        (
            serde_json::to_vec(&outcome.record.without_timing()).unwrap(),
            outcome.evidence,
        )
    };
    let once = run(1);
    assert_eq!(once, run(1));
    assert_eq!(once, run(2));
    assert_eq!(once, run(5));
}

#[test]
fn an_answer_does_not_depend_on_the_other_boxes_after_it() {
    let mut scene = Suite::Demo.scenes().next().unwrap();
    let all = picker()
        .pick(&scene.frame, 7, None)
        .unwrap()
        .record
        .without_timing();
    scene.frame.boxes.as_mut().unwrap().truncate(2);
    let two = picker()
        .pick(&scene.frame, 7, None)
        .unwrap()
        .record
        .without_timing();
    assert_eq!(all.picks[..2], two.picks[..]);
}

#[test]
fn the_seed_counts() {
    let scene = lab("z45");
    let run = |seed| {
        picker()
            .pick(&scene.frame, seed, None)
            .unwrap()
            .record
            .picks[0]
            .direction
    };
    assert_ne!(run(0), run(1));
}

#[test]
fn each_refusal_has_its_status() {
    let status = |scene: &Scene, picker: &Picker| {
        let picks = picker.pick(&scene.frame, 0, None).unwrap().record.picks;
        assert!(picks[0].direction.is_none() && picks[0].foot.is_none());
        (picks[0].status, picks[0].apple.is_some())
    };
    let scene = lab("x0");

    let mut blind = scene.clone();
    blind.frame.depth = DepthImage::empty(1280, 960);
    assert_eq!(status(&blind, &picker()), (Status::NoDepth, false));

    let mut tiny = scene.clone();
    let b = &mut tiny.frame.boxes.as_mut().unwrap()[0];
    (b.x_max, b.y_max) = (b.x_min + 4.0, b.y_min + 4.0);
    let config = |edit: fn(&mut Config)| {
        let mut config = Config {
            method: Method::Paper,
            ..Config::default()
        };
        edit(&mut config);
        Picker::new(config).unwrap()
    };
    let many = config(|c| c.paper.sphere_min_points = 10_000_000);
    assert_eq!(status(&tiny, &many), (Status::TooFewPoints, false));

    // Only spheres under a tenth of a millimetre: none has the wanted support.
    let small = config(|c| (c.fruit.radius_min_m, c.fruit.radius_max_m) = (1e-6, 1e-4));
    assert_eq!(status(&scene, &small), (Status::NoSphere, false));

    let lonely = config(|c| c.paper.line_min_points = 1_000_000);
    assert_eq!(status(&scene, &lonely), (Status::NoBranch, true));
}

#[test]
fn the_robot_gets_the_same_answer_in_its_frame() {
    let scene = lab("z-45");
    let isometry = Isometry3::from_parts(
        Vector3::new(0.3, -0.1, 1.2).into(),
        UnitQuaternion::from_euler_angles(-1.8, 0.2, -1.4),
    );
    let camera = scene.frame.camera.frame_id.clone();
    let transform = RobotFromCamera::new(
        Transform::from_isometry(&isometry).unwrap(),
        "base_link",
        camera,
    );
    let outcome = picker().pick(&scene.frame, 0, Some(&transform)).unwrap();
    let pick = &outcome.record.picks[0];
    let robot = pick.robot.as_ref().unwrap();
    assert_eq!(robot.frame_id, "base_link");
    let center = isometry * Point3::from(pick.apple.as_ref().unwrap().center);
    assert!((center - Point3::from(robot.center)).norm() < 1e-12);
    let direction = isometry * Vector3::from(pick.direction.unwrap());
    assert!((direction - Vector3::from(robot.direction)).norm() < 1e-12);
    let [x, y, z, w] = robot.quaternion_xyzw;
    let tool = UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(w, x, y, z));
    assert!(
        (tool * Vector3::x() - direction).norm() < 1e-12,
        "the tool's x axis is the approach"
    );
    assert!(!robot.singular && robot.euler_zyx[0] == 0.0);

    let other = RobotFromCamera::new(
        Transform::from_isometry(&isometry).unwrap(),
        "base_link",
        "left_camera",
    );
    let error = picker().pick(&scene.frame, 0, Some(&other)).unwrap_err();
    assert!(matches!(error, PickError::WrongTransform { .. }), "{error}");
}

#[test]
fn frames_that_cannot_be_worked_on_are_errors() {
    let mut scene = lab("x0");
    scene.frame.boxes = None;
    let error = picker()
        .pick(&scene.frame, 0, None)
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("boxes.xml") && error.contains(&scene.frame.id),
        "{error}"
    );

    let bad_box = PixelBox {
        name: "inverted".into(),
        x_min: 50.0,
        y_min: 10.0,
        x_max: 20.0,
        y_max: 30.0,
        score: 1.0,
    };
    scene.frame.boxes = Some(vec![bad_box]);
    let error = picker()
        .pick(&scene.frame, 0, None)
        .unwrap_err()
        .to_string();
    assert!(error.contains("inverted"), "{error}");

    scene.frame.boxes = Some(vec![]);
    assert!(
        picker()
            .pick(&scene.frame, 0, None)
            .unwrap()
            .record
            .picks
            .is_empty()
    );
    scene.frame.camera.fx = 0.0;
    assert!(matches!(
        picker().pick(&scene.frame, 0, None),
        Err(PickError::Frame { .. })
    ));
}
