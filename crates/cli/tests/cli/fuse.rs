//! Several frames of one tree.

use crate::binary::{pomona, tree};
use crate::scene::Bench;
use pomona_cloud::PointCloud;
use pomona_fusion::FusedRecord;
use pomona_scenes::{CameraAxis, Lab, Orientation, Sensor, Shot};
use std::path::PathBuf;

const POSE: &str = r#"{"schema": "pomona.transform/1", "to": "base", "from": "camera_color_optical_frame",
    "translation_m": [X, 0, 0.5], "quaternion_xyzw": [0, 0, 0, 1]}"#;

/// Frames `left` and `right` of one lab apple, the right camera 50 mm to the right.
pub(crate) fn bench() -> Bench {
    let bench = Bench::new();
    let camera = Shot::paper_camera().with_intrinsics([320, 240], [540.0; 2], [159.5, 119.5]);
    let upright = Orientation {
        axis: CameraAxis::X,
        degrees: 0,
    };
    let world = Lab::default().world(upright);
    for (name, x, seed) in [("left", 0.0, 1), ("right", 0.05, 2)] {
        let seen = world.transformed(&nalgebra::Isometry3::translation(-x, 0.0, 0.0));
        let shot = Shot::new(name, camera.clone(), Sensor::paper(), seed).take(&seen);
        shot.frame.write(bench.path(name)).unwrap();
        let pose = POSE.replace('X', &x.to_string());
        bench.write(&format!("{name}/robot_from_camera.json"), pose);
    }
    bench
}

#[test]
fn two_frames_give_one_apple_and_a_cloud() {
    let bench = bench();
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
    ];
    let run = pomona(&[&base[..], &["--fused-cloud"]].concat()).succeeded();
    let names = [
        "fused.json",
        "fused.ply",
        "left",
        "left/picks.json",
        "right",
        "right/picks.json",
    ];
    assert_eq!(tree(&bench.path("out")), names.map(PathBuf::from));
    let fused: FusedRecord = serde_json::from_slice(&bench.read("out/fused.json")).unwrap();
    assert_eq!(fused.apples.len(), 1);
    assert_eq!(fused.apples[0].sightings.len(), 2);
    for part in [
        "fused in base: 1 apple from 2 frames",
        "2 directions agree",
        "right: 1 apple shared",
    ] {
        assert!(run.out.contains(part), "{part}: {}", run.out);
    }
    let cloud = PointCloud::read(bench.path("out/fused.ply")).unwrap();
    let one =
        PointCloud::from_frame(&pomona_cloud::Frame::read(bench.path("left")).unwrap()).unwrap();
    assert!(cloud.len() > 1000 && cloud.len() < one.len() * 2 && cloud.colors.is_some());

    // The frames' own answers are in the robot's frame too, and a later run without a cloud removes it.
    assert!(bench.read_json("out/right/picks.json")["picks"][0]["robot"].is_object());
    let again = pomona(&[&base[..], &["--json"]].concat()).succeeded();
    assert_eq!(again.json(), bench.read_json("out/fused.json"));
    assert!(!bench.path("out/fused.ply").exists());
}

#[test]
fn what_cannot_be_fused_is_refused_and_writes_nothing() {
    let bench = bench();
    let (left, right, out) = (bench.text("left"), bench.text("right"), bench.text("out"));
    let fuse = |frames: &[&str]| pomona(&[&["pick", "--fuse", "--out", &out], frames].concat());
    fuse(&[&left]).refused(&["at least two frames"]);
    fuse(&[&left, &left]).refused(&["given twice"]);
    fuse(&[&left, &bench.text("a")]).refused(&["no pose", "robot_from_camera.json"]);
    assert!(!bench.path("out").exists());
    bench.write(
        "right/robot_from_camera.json",
        POSE.replace('X', "0").replace("base", "other"),
    );
    fuse(&[&left, &right]).refused(&["'base'", "'other'"]);
    assert!(!bench.path("out/fused.json").exists());
    let alone = pomona(&["pick", &left, "--fused-cloud", "--out", &out]);
    assert!(
        alone.code == 2 && alone.err.contains("--fuse"),
        "{}",
        alone.err
    );
    std::fs::create_dir_all(bench.path("out")).unwrap();
    bench.write("out/fused.json", "{}");
    fuse(&[&left, &right]).refused(&["not a result of this program"]);
}

#[test]
fn answers_of_an_earlier_run_do_not_stay_beside_those_of_this_one() {
    let bench = bench();
    let (left, right, out) = (bench.text("left"), bench.text("right"), bench.text("out"));
    let fixed = ["--out", &out, "--no-picture", "--clouds", "none"];
    let run = |arguments: &[&str]| {
        pomona(&[&["pick"], arguments, &fixed[..]].concat()).succeeded();
        let names = tree(&bench.path("out"));
        names
            .into_iter()
            .filter(|path| path.components().count() == 1)
            .collect::<Vec<_>>()
    };
    let folders = ["left", "right"].map(PathBuf::from);
    let fused = run(&[&left, &right, "--fuse", "--fused-cloud"]);
    assert_eq!(
        fused,
        ["fused.json", "fused.ply", "left", "right"].map(PathBuf::from)
    );
    assert_eq!(run(&[&left, &right]), folders);
    bench.write("out/notes.txt", "mine");
    assert_eq!(
        run(&[&left]),
        ["left", "notes.txt", "picks.json", "right"].map(PathBuf::from)
    );
    assert_eq!(
        run(&[&left, &right]),
        ["left", "notes.txt", "right"].map(PathBuf::from)
    );
    // Somebody else's file of that name is left alone.
    bench.write("out/fused.json", "{}");
    assert!(run(&[&left, &right]).contains(&PathBuf::from("fused.json")));
}
