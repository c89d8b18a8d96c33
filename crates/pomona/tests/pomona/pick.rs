//! The pipeline on generated frames: what it finds, what it refuses, and that it repeats itself.

use crate::answers::{answer, picker, try_answer};
use nalgebra::{Isometry3, Point3, UnitQuaternion, Vector3};
use pomona::record::PicksRecord;
use pomona::{CheckedFrame, Config, Method, PickError, Picker, RobotFromCamera, Status};
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

fn paper() -> Picker {
    picker(Method::Paper)
}

#[test]
fn finds_the_lab_apple_and_its_branch() {
    let scene = lab("x0");
    let answer = answer(&paper(), &scene.frame, 0);
    let [answer] = &answer.apples[..] else {
        panic!("one box, one answer")
    };
    let truth = &scene.truth.apples[0];
    assert_eq!(answer.status, Status::Picked);
    let apple = answer.apple.unwrap();
    assert!((apple.center.point() - Point3::from(truth.center)).norm() < 0.002);
    assert!((apple.radius_m - truth.radius).abs() < 0.002);
    // The line lies on the branch's visible side, half its thickness off the axis: about
    // atan(2.5 / 33) = 4.3° at this distance.
    let pick = answer.pick.unwrap();
    let right = Vector3::from(truth.direction.unwrap());
    assert!(pick.direction.vector().angle(&right).to_degrees() < 8.0);
    let along = pick.foot.point() - apple.center.point();
    let branch = answer.branch.unwrap();
    assert!(
        along.dot(&branch.direction.vector()).abs() < 1e-12,
        "OC is across the branch"
    );
    assert!(along.angle(&pick.direction.vector()).to_degrees() < 1e-5);

    assert_eq!(answer.evidence.surface.len(), apple.inliers);
    assert_eq!(answer.evidence.branch.len(), branch.inliers);
    assert!(answer.robot.is_none());
}

#[test]
fn threads_and_repetition_do_not_change_the_record() {
    let scene = Suite::Demo.scenes().next().unwrap();
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        let answer = pool.install(|| answer(&paper(), &scene.frame, 7));
        let evidence: Vec<_> = answer.apples.iter().map(|a| a.evidence.clone()).collect();
        let record = PicksRecord::from(&answer).without_timing();
        (serde_json::to_vec(&record).unwrap(), evidence)
    };
    let once = run(1);
    assert_eq!(once, run(1));
    assert_eq!(once, run(2));
    assert_eq!(once, run(5));
}

#[test]
fn an_answer_does_not_depend_on_the_other_boxes_after_it() {
    let mut scene = Suite::Demo.scenes().next().unwrap();
    let all = PicksRecord::from(&answer(&paper(), &scene.frame, 7)).without_timing();
    scene.frame.boxes.as_mut().unwrap().truncate(2);
    let two = PicksRecord::from(&answer(&paper(), &scene.frame, 7)).without_timing();
    assert_eq!(all.picks[..2], two.picks[..]);
}

#[test]
fn the_seed_counts() {
    let scene = lab("z45");
    let run = |seed| {
        answer(&paper(), &scene.frame, seed).apples[0]
            .pick
            .unwrap()
            .direction
    };
    assert_ne!(run(0), run(1));
}

#[test]
fn each_refusal_has_its_status() {
    let status = |scene: &Scene, picker: &Picker| {
        let answer = answer(picker, &scene.frame, 0);
        assert!(answer.apples[0].pick.is_none());
        (answer.apples[0].status, answer.apples[0].apple.is_some())
    };
    let scene = lab("x0");

    let mut blind = scene.clone();
    blind.frame.depth = DepthImage::empty(1280, 960);
    assert_eq!(status(&blind, &paper()), (Status::NoDepth, false));

    let mut tiny = scene.clone();
    let b = &mut tiny.frame.boxes.as_mut().unwrap()[0];
    (b.x_max, b.y_max) = (b.x_min + 4.0, b.y_min + 4.0);
    let config = |edit: fn(&mut Config)| {
        let paper = Config::default().with(|c| c.method = Method::Paper);
        Picker::new(paper.with(edit)).unwrap()
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
    let frame = CheckedFrame::new(&scene.frame).unwrap();
    let answer = paper().pick(&frame, 0, Some(&transform)).unwrap();
    let answer = &answer.apples[0];
    let robot = answer.robot.as_ref().unwrap();
    assert_eq!(robot.frame_id, "base_link");
    let center = isometry * answer.apple.unwrap().center.point();
    assert!((center - robot.center.point()).norm() < 1e-12);
    let direction = isometry * answer.pick.unwrap().direction.vector();
    assert!((direction - robot.direction.vector()).norm() < 1e-12);
    assert!(
        (robot.tool.quaternion * Vector3::x() - direction).norm() < 1e-12,
        "the tool's x axis is the approach"
    );
    assert!(!robot.tool.singular && robot.tool.euler.rx == 0.0);

    let other = RobotFromCamera::new(
        Transform::from_isometry(&isometry).unwrap(),
        "base_link",
        "left_camera",
    );
    let error = paper().pick(&frame, 0, Some(&other)).unwrap_err();
    assert!(matches!(error, PickError::WrongTransform { .. }), "{error}");
}

#[test]
fn frames_that_cannot_be_worked_on_are_errors() {
    let mut scene = lab("x0");
    scene.frame.boxes = None;
    let error = try_answer(&paper(), &scene.frame, 0)
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
    let error = try_answer(&paper(), &scene.frame, 0)
        .unwrap_err()
        .to_string();
    assert!(error.contains("inverted"), "{error}");

    scene.frame.boxes = Some(vec![]);
    assert!(answer(&paper(), &scene.frame, 0).apples.is_empty());
    scene.frame.camera.fx = 0.0;
    assert!(matches!(
        try_answer(&paper(), &scene.frame, 0),
        Err(PickError::Frame { .. })
    ));
}
