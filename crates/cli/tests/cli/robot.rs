use crate::binary::{pomona, tree};
use crate::scene::Bench;
use std::path::Path;

/// The camera looks along the robot's x axis, half a metre up.
const POSE: &str = r#"{ "schema": "pomona.transform/1", "to": "base_link", "from": "camera_color_optical_frame",
    "translation_m": [0.0, 0.0, 0.5], "quaternion_xyzw": [-0.5, 0.5, -0.5, 0.5] }"#;

/// Arguments of a pick with the robot whose settings these are.
fn arguments(bench: &Bench, settings: &str, more: &[&str]) -> Vec<String> {
    bench.write("pose.json", POSE);
    bench.write("robot.toml", settings);
    let mut arguments = vec![
        "pick".to_owned(),
        bench.text("a"),
        "--no-picture".to_owned(),
    ];
    for (name, file) in [
        ("--transform", "pose.json"),
        ("--robot", "robot.toml"),
        ("--out", "out"),
    ] {
        arguments.extend([name.to_owned(), bench.text(file)]);
    }
    arguments.extend(more.iter().map(ToString::to_string));
    arguments
}

fn run(arguments: &[String]) -> crate::binary::Run {
    pomona(&arguments.iter().map(String::as_str).collect::<Vec<_>>())
}

#[test]
fn a_robot_adds_its_plans_and_messages() {
    let bench = Bench::new();
    run(&arguments(
        &bench,
        "[clearance]\ncloud_margin_m = -0.05\n",
        &["--ros"],
    ))
    .succeeded();
    let record = bench.read_json("out/picks.json");
    let pick = &record["picks"][0];
    assert!(pick["approach"]["status"].is_string(), "{pick}");
    assert!(record["picks"][1].get("approach").is_none());
    assert!(
        tree(&bench.path("out"))
            .iter()
            .any(|p| p == Path::new("ros-scene.yaml"))
    );
}

#[test]
fn an_unknown_setting_of_a_robot_is_refused_with_the_nearest_name() {
    let bench = Bench::new();
    let old = "[gripper]\nwrist_from_tool_translation_m = [0.0, 0.0, 0.2]\n";
    let parts = [
        "robot.toml",
        "wrist_from_tool_",
        "did you mean `gripper.tcp_from_flange_translation_m`?",
    ];
    run(&arguments(&bench, old, &[])).refused(&parts);
    assert!(!bench.path("out").exists());
}

#[test]
fn evaluation_takes_a_robot_with_settings_or_without() {
    let bench = Bench::new();
    bench.write("robot.toml", "[search]\nrolls = 2\n");
    let (out, with) = (
        bench.text("out"),
        format!("--robot={}", bench.text("robot.toml")),
    );
    let base = ["evaluate", "lab15", "--count", "1", "--out", &out];
    for robot in ["--robot", &with] {
        let run = pomona(&[&base[..], &[robot]].concat()).succeeded();
        assert!(run.out.contains("calibration rotation"), "{}", run.out);
    }
    pomona(&[&base[..], &["--robot", "--calibration-poses", "3"]].concat())
        .refused(&["lab-x-90-s0", "poses"]);
    let alone = pomona(&[&base[..], &["--calibration-poses", "9"]].concat());
    assert!(
        alone.code == 2 && alone.err.contains("--robot"),
        "{}",
        alone.err
    );
}

#[cfg(feature = "mcap")]
#[test]
fn an_mcap_recording_lies_beside_the_picks() {
    let bench = Bench::new();
    run(&arguments(&bench, "", &["--mcap"])).succeeded();
    // The magic bytes at both ends of the format.
    let bytes = bench.read("out/recording.mcap");
    let magic = b"\x89MCAP0\r\n";
    assert!(bytes.starts_with(magic) && bytes.ends_with(magic));
}
