//! Where the camera is: transforms in other programs' forms, and cameras on the gripper.

use crate::binary::{Run, pomona};
use crate::{fuse, scene::Bench};
use serde_json::Value;

const OWN: &str = r#"{"schema": "pomona.transform/1", "to": "base_link", "from": "camera_color_optical_frame",
    "translation_m": [0.3, -0.1, 1.2], "quaternion_xyzw": [-0.5, 0.5, -0.5, 0.5]}"#;

fn pick(bench: &Bench, transform: &str, more: &[&str]) -> Run {
    let (frame, out, transform) = (bench.text("a"), bench.text("out"), bench.text(transform));
    let base = [
        "pick",
        &frame,
        "--no-picture",
        "--clouds",
        "none",
        "--out",
        &out,
        "--transform",
        &transform,
    ];
    pomona(&[&base[..], more].concat())
}

/// The first apple's centre in the robot's frame, and the codes of the warnings.
fn robot(bench: &Bench) -> ([f64; 3], Vec<String>) {
    let record = bench.read_json("out/picks.json");
    let center = record["picks"][0]["robot"]["center"].as_array().unwrap();
    let codes = record["warnings"].as_array().into_iter().flatten();
    let codes = codes.map(|w: &Value| w["code"].as_str().unwrap().to_owned());
    (
        [0, 1, 2].map(|i| center[i].as_f64().unwrap()),
        codes.collect(),
    )
}

fn close(a: [f64; 3], b: [f64; 3]) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-9)
}

#[test]
fn transforms_of_other_programs_are_taken() {
    let bench = Bench::new();
    bench.write("own.json", OWN);
    pick(&bench, "own.json", &[]).succeeded();
    let (expected, codes) = robot(&bench);
    assert_eq!(codes, [""; 0]);

    let easy_handeye = "parameters:\n  eye_on_hand: false\n  robot_base_frame: base_link\n  robot_effector_frame: tool0\n\
        \x20 tracking_base_frame: camera_color_optical_frame\ntransformation: {x: 0.3, y: -0.1, z: 1.2, qx: -0.5, qy: 0.5, qz: -0.5, qw: 0.5}\n";
    let echoed = "transform:\n  translation: {x: 0.3, y: -0.1, z: 1.2}\n  rotation: {x: -0.5, y: 0.5, z: -0.5, w: 0.5}\n";
    let matrix = "0 0 1 0.3\n-1 0 0 -0.1\n0 -1 0 1.2\n0 0 0 1\n";
    for (name, text, warned) in [
        ("easy.yaml", easy_handeye, &[][..]),
        ("echo.yaml", echoed, &["transform_frames_assumed"]),
        ("matrix.txt", matrix, &["transform_frames_assumed"]),
    ] {
        bench.write(name, text);
        let run = pick(&bench, name, &[]);
        assert_eq!(run.code, 0, "{}", run.err);
        let (found, codes) = robot(&bench);
        assert!(close(found, expected), "{name}: {found:?} {expected:?}");
        assert_eq!(codes, warned, "{name}");
        assert_eq!(run.err.contains(&format!("{name}: ")), !warned.is_empty());
        let inspected = pomona(&["inspect", &bench.text(name)]).succeeded();
        assert!(inspected.out.contains("transform"), "{}", inspected.out);
        assert!(
            inspected.out.contains("300.0 -100.0 1200.0 mm"),
            "{}",
            inspected.out
        );
    }
}

#[test]
fn a_translation_in_millimetres_is_refused_or_doubted() {
    let bench = Bench::new();
    bench.write(
        "mm.json",
        OWN.replace("[0.3, -0.1, 1.2]", "[300, -100, 1200]"),
    );
    pick(&bench, "mm.json", &[]).refused(&["mm.json", "millimetres"]);
    bench.write(
        "near.json",
        OWN.replace("[0.3, -0.1, 1.2]", "[30, -10, 12]"),
    );
    let run = pick(&bench, "near.json", &[]);
    assert!(
        run.code == 0 && run.err.contains("[camera_far_from_robot]"),
        "{}",
        run.err
    );
}

/// A camera 50 mm before the flange, which points forward; and the flange's pose with which it is where [`OWN`] puts it.
fn in_hand(bench: &Bench) {
    let camera = r#"{"schema": "pomona.transform/1", "to": "wrist_plate", "from": "camera_color_optical_frame", "to_kind": "flange",
        "translation_m": [0.05, 0.0, 0.0], "quaternion_xyzw": [-0.5, 0.5, -0.5, 0.5]}"#;
    let flange = r#"{"schema": "pomona.transform/1", "to": "base_link", "from": "wrist_plate",
        "translation_m": [0.25, -0.1, 1.2], "quaternion_xyzw": [0, 0, 0, 1]}"#;
    bench.write("flange_from_camera.json", camera);
    bench.write("a/base_from_flange.json", flange);
}

#[test]
fn a_camera_on_the_gripper_is_where_the_flange_was() {
    let bench = Bench::new();
    bench.write("own.json", OWN);
    pick(&bench, "own.json", &[]).succeeded();
    let (expected, _) = robot(&bench);
    in_hand(&bench);
    bench.write("robot.toml", "[clearance]\ncloud_margin_m = -0.05\n");
    let settings = bench.text("robot.toml");
    pick(
        &bench,
        "flange_from_camera.json",
        &["--robot", &settings, "--ros"],
    )
    .succeeded();
    let (found, codes) = robot(&bench);
    assert!(close(found, expected), "{found:?} {expected:?}");
    assert_eq!(codes, [""; 0]);
    assert!(bench.path("out/ros-scene.yaml").exists());

    // The same pose as text, which names no frames.
    std::fs::remove_file(bench.path("a/base_from_flange.json")).unwrap();
    bench.write(
        "a/base_from_flange.txt",
        "1 0 0 0.25\n0 1 0 -0.1\n0 0 1 1.2\n0 0 0 1\n",
    );
    let run = pick(&bench, "flange_from_camera.json", &[]);
    assert_eq!(run.code, 0, "{}", run.err);
    let (found, codes) = robot(&bench);
    assert!(
        close(found, expected) && codes == ["transform_frames_assumed"],
        "{codes:?}"
    );
}

#[test]
fn a_transform_that_does_not_lead_to_the_base_is_refused_by_its_frame() {
    let bench = Bench::new();
    in_hand(&bench);
    bench.write("own.json", OWN);
    // A fixed camera and a flange's pose contradict each other.
    pick(&bench, "own.json", &[]).refused(&[
        "`base_link`",
        "`wrist_plate`",
        "remove the flange's pose",
    ]);
    bench.write("other.json", OWN.replace("base_link", "plate"));
    pick(&bench, "other.json", &[]).refused(&[
        "`plate`",
        "`wrist_plate`",
        "correct one of the names",
    ]);
    std::fs::remove_file(bench.path("a/base_from_flange.json")).unwrap();
    let refused = [
        "`wrist_plate`",
        "base_from_flange.json",
        "flange_from_camera.json",
    ];
    pick(&bench, "flange_from_camera.json", &[]).refused(&refused);
    bench.write("tool.json", OWN.replace("base_link", "tool0"));
    pick(&bench, "tool.json", &[]).refused(&["`tool0`", "flange's pose at the shot"]);
    assert!(!bench.path("out").exists());
    let inspected = pomona(&["inspect", &bench.text("flange_from_camera.json")]).succeeded();
    assert!(
        inspected.out.contains("base_from_flange.json"),
        "{}",
        inspected.out
    );
}

#[test]
fn poses_in_a_frames_folder_are_used_or_mentioned() {
    let bench = Bench::new();
    in_hand(&bench);
    let (frame, out) = (bench.text("a"), bench.text("out"));
    let alone = [
        "pick",
        &frame,
        "--no-picture",
        "--clouds",
        "none",
        "--out",
        &out,
    ];
    let run = pomona(&alone);
    assert!(
        run.code == 0 && run.err.contains("[flange_pose_unused]"),
        "{}",
        run.err
    );
    bench.write("a/robot_from_camera.json", OWN);
    let run = pomona(&alone);
    assert!(run.err.contains("[own_pose_taken]"), "{}", run.err);
    assert!(robot(&bench).0[0] > 0.3);
    std::fs::remove_file(bench.path("a/base_from_flange.json")).unwrap();
    pomona(&alone).succeeded();
}

#[test]
fn frames_of_a_moving_gripper_are_fused() {
    let bench = fuse::bench();
    let (left, right, out) = (bench.text("left"), bench.text("right"), bench.text("out"));
    let base = [
        "pick",
        &left,
        &right,
        "--out",
        &out,
        "--no-picture",
        "--clouds",
        "none",
        "--fuse",
        "--json",
    ];
    let with_own = pomona(&base).succeeded().json();

    let camera = r#"{"schema": "pomona.transform/1", "to": "flange", "from": "camera_color_optical_frame",
        "translation_m": [0, 0, 0.1], "quaternion_xyzw": [0, 0, 0, 1]}"#;
    bench.write("flange_from_camera.json", camera);
    for (name, x) in [("left", "0"), ("right", "0.05")] {
        std::fs::remove_file(bench.path(&format!("{name}/robot_from_camera.json"))).unwrap();
        let flange = r#"{"schema": "pomona.transform/1", "to": "base", "from": "flange",
            "translation_m": [X, 0, 0.4], "quaternion_xyzw": [0, 0, 0, 1]}"#;
        bench.write(
            &format!("{name}/base_from_flange.json"),
            flange.replace('X', x),
        );
    }
    let transform = bench.text("flange_from_camera.json");
    let fused = pomona(&[&base[..], &["--transform", &transform]].concat())
        .succeeded()
        .json();
    let center = |record: &Value| -> Vec<f64> {
        let center = &record["apples"][0]["center"];
        let position = center
            .as_array()
            .or_else(|| center["position"].as_array())
            .unwrap();
        position.iter().map(|c| c.as_f64().unwrap()).collect()
    };
    assert_eq!(fused["apples"].as_array().unwrap().len(), 1);
    for (a, b) in center(&fused).iter().zip(center(&with_own)) {
        assert!((a - b).abs() < 1e-9, "{fused} {with_own}");
    }
}
