use crate::binary::{pomona, tree};
use crate::scene::{Bench, frame};
use pomona::record::PicksRecord;
use pomona_cloud::PointCloud;
use std::path::PathBuf;

fn record(bench: &Bench, name: &str) -> PicksRecord {
    serde_json::from_slice(&bench.read(name)).unwrap()
}

#[test]
fn one_frame_gives_picks_picture_and_a_cloud() {
    let bench = Bench::new();
    let run = pomona(&["pick", &bench.text("a"), "--out", &bench.text("deep/out")]).succeeded();

    let names = ["apple-0.ply", "picks.json", "picture.png"].map(PathBuf::from);
    assert_eq!(tree(&bench.path("deep/out")), names);
    let record = record(&bench, "deep/out/picks.json");
    let statuses: Vec<_> = record.picks.iter().map(|p| p.status.name()).collect();
    assert_eq!(statuses, ["picked", "no_depth", "too_few_points"]);
    let [x, y, z] = record.picks[0].direction.unwrap();
    assert!(y < -0.9, "the branch is above: {x} {y} {z}");

    let picture = pomona_cloud::ColorImage::read(bench.path("deep/out/picture.png")).unwrap();
    assert_eq!((picture.width, picture.height), (320, 240));
    let cloud = PointCloud::read(bench.path("deep/out/apple-0.ply")).unwrap();
    let red = cloud
        .colors
        .unwrap()
        .iter()
        .filter(|&&c| c == [235, 15, 25])
        .count();
    assert!(red > 50, "the direction is drawn in points, {red} of them");

    for part in ["r mm", "angle deg", "picked", "no_depth", "blind"] {
        assert!(run.out.contains(part), "{part}: {}", run.out);
    }
    let last = run.out.lines().last().unwrap();
    let summary =
        "3 apples in 1 frame: 1 picked, 2 refused (1 no_depth, 1 too_few_points); written to ";
    assert!(last.starts_with(summary), "{last}");
}

#[test]
fn several_frames_get_a_folder_each() {
    let bench = Bench::new();
    frame("b").write(bench.path("b")).unwrap();
    let arguments = [
        "pick",
        &bench.text("a"),
        &bench.text("b"),
        "--no-picture",
        "--clouds",
        "none",
    ];
    let run = pomona(&[&arguments[..], &["--out", &bench.text("out")]].concat()).succeeded();
    let names = ["a", "a/picks.json", "b", "b/picks.json"].map(PathBuf::from);
    assert_eq!(tree(&bench.path("out")), names);
    assert!(run.out.contains("6 apples in 2 frames"), "{}", run.out);
    assert_eq!(record(&bench, "out/b/picks.json").frame.id, "b");
}

#[test]
fn a_frame_that_fails_leaves_no_folder_and_the_others_theirs() {
    let bench = Bench::new();
    let arguments = [
        "pick",
        &bench.text("a"),
        &bench.text("gone"),
        "--out",
        &bench.text("out"),
        "--json",
    ];
    let run = pomona(&arguments);
    assert_eq!(run.code, 2);
    assert!(
        run.err.contains("gone") && run.err.contains("1 of 2 frames failed"),
        "{}",
        run.err
    );
    assert_eq!(run.json().as_array().unwrap().len(), 1);
    assert!(bench.path("out/a/picks.json").exists() && !bench.path("out/gone").exists());
}

#[test]
fn frames_of_one_name_are_refused() {
    let bench = Bench::new();
    frame("a").write(bench.path("a/a")).unwrap();
    let (first, second) = (bench.text("a"), bench.text("a/a"));
    let run = pomona(&["pick", &first, &second, "--out", &bench.text("out")]);
    run.refused(&[&first, &second, "rename"]);
    assert!(!bench.path("out").exists());
}

#[test]
fn json_goes_to_standard_output_alone() {
    let bench = Bench::new();
    let out = bench.text("out");
    let run = pomona(&["pick", &bench.text("a"), "--json", "--out", &out]).succeeded();
    assert_eq!(run.json(), bench.read_json("out/picks.json"));
    frame("b").write(bench.path("b")).unwrap();
    let arguments = [
        "pick",
        &bench.text("a"),
        &bench.text("b"),
        "--json",
        "--out",
        &bench.text("both"),
    ];
    let both = pomona(&arguments).succeeded().json();
    assert_eq!(both.as_array().unwrap().len(), 2);
    assert_eq!(both[1], bench.read_json("both/b/picks.json"));
}

#[test]
fn the_same_picks_for_any_number_of_threads_and_on_every_run() {
    let bench = Bench::new();
    let picks = |out: &str, more: &[&str]| {
        let (frame, out_path) = (bench.text("a"), bench.text(out));
        let arguments = [
            "pick",
            &frame,
            "--no-picture",
            "--clouds",
            "none",
            "--out",
            &out_path,
        ];
        pomona(&[&arguments[..], more].concat()).succeeded();
        let record = record(&bench, &format!("{out}/picks.json")).without_timing();
        serde_json::to_vec_pretty(&record).unwrap()
    };
    let once = picks("1", &["--threads", "1"]);
    assert_eq!(once, picks("2", &["--threads", "2"]));
    assert_eq!(once, picks("3", &["--threads", "2"]));
    assert_eq!(once, picks("4", &[]));
    assert_ne!(once, picks("5", &["--seed", "1"]));
}

#[test]
fn a_later_run_replaces_our_files_and_no_others() {
    let bench = Bench::new();
    let (frame, out) = (bench.text("a"), bench.text("out"));
    pomona(&["pick", &frame, "--out", &out]).succeeded();
    bench.write("out/notes.txt", "mine");
    pomona(&[
        "pick",
        &frame,
        "--out",
        &out,
        "--clouds",
        "none",
        "--no-picture",
    ])
    .succeeded();
    assert_eq!(
        tree(&bench.path("out")),
        ["notes.txt", "picks.json"].map(PathBuf::from)
    );

    std::fs::remove_file(bench.path("out/picks.json")).unwrap();
    bench.write("out/picture.png", "a holiday");
    pomona(&["pick", &frame, "--out", &out]).refused(&["picture.png", "another folder by --out"]);
    assert_eq!(bench.read("out/picture.png"), b"a holiday");
    bench.write("file", "");
    pomona(&["pick", &frame, "--out", &bench.text("file")]).refused(&["file", "name a folder"]);
}

#[test]
fn clouds_are_chosen() {
    let bench = Bench::new();
    let out = bench.text("out");
    let run = |which: &str| pomona(&["pick", &bench.text("a"), "--out", &out, "--clouds", which]);
    run("all").succeeded();
    assert!(bench.path("out/apple-0.ply").exists() && !bench.path("out/apple-1.ply").exists());
    let blind = run("0,1");
    assert_eq!(blind.code, 0);
    assert!(blind.err.contains("apple 1 has no sphere"), "{}", blind.err);
    run("7").refused(&["--clouds 7", "3 apples"]);
    assert_eq!(run("some").code, 2);
}

#[test]
fn a_transform_adds_the_robots_frame() {
    let bench = Bench::new();
    // The camera looks along the robot's x axis, half a metre up.
    let transform = r#"{"schema": "pomona.transform/1", "to": "base_link", "from": "camera_color_optical_frame",
        "translation_m": [0, 0, 0.5], "quaternion_xyzw": [-0.5, 0.5, -0.5, 0.5]}"#;
    bench.write("t.json", transform);
    let arguments = [
        "pick",
        &bench.text("a"),
        "--transform",
        &bench.text("t.json"),
        "--out",
        &bench.text("out"),
    ];
    let run = pomona(&arguments).succeeded();
    assert!(
        run.out.contains("robot x mm") && run.out.contains("rz deg"),
        "{}",
        run.out
    );
    let record = record(&bench, "out/picks.json");
    let (pick, robot) = (&record.picks[0], record.picks[0].robot.as_ref().unwrap());
    let [x, y, z] = pick.apple.as_ref().unwrap().center;
    let expected = [z, -x, 0.5 - y];
    for (found, expected) in robot.center.iter().zip(expected) {
        assert!(
            (found - expected).abs() < 1e-9,
            "{:?} {expected:?}",
            robot.center
        );
    }
    assert_eq!(robot.frame_id, "base_link");
    assert!(robot.direction[2] > 0.9);
    assert!(record.picks[1].robot.is_none());

    bench.write("t.json", transform.replace("camera_color", "left_camera"));
    let other = pomona(&[
        "pick",
        &bench.text("a"),
        "--transform",
        &bench.text("t.json"),
        "--out",
        &bench.text("no"),
    ]);
    other.refused(&["left_camera_optical_frame", "camera_color_optical_frame"]);
    assert!(!bench.path("no").exists());
}

#[test]
fn a_robot_adds_its_plan_and_messages() {
    let bench = Bench::new();
    bench.write(
        "t.json",
        r#"{"schema": "pomona.transform/1", "to": "base_link", "from": "camera_color_optical_frame",
            "translation_m": [0, 0, 0.5], "quaternion_xyzw": [-0.5, 0.5, -0.5, 0.5]}"#,
    );
    bench.write("r.toml", "[clearance]\ncloud_margin_m = -0.05\n");
    let (frame, out) = (bench.text("a"), bench.text("out"));
    let (t, r) = (bench.text("t.json"), bench.text("r.toml"));
    let plain = ["pick", &frame, "--out", &out, "--transform", &t];
    let run = |more: &[&str]| pomona(&[&plain[..], more].concat());
    run(&["--robot", &r, "--ros"]).succeeded();
    let planned = record(&bench, "out/picks.json");
    let plan = &planned.picks[0].plan;
    assert_eq!(plan.order.as_ref().unwrap().rank, 0);
    assert!(planned.picks[1].plan.approach.is_none());
    let pose = String::from_utf8(bench.read("out/ros-pose-0.yaml")).unwrap();
    assert!(pose.contains("frame_id: \"base_link\""), "{pose}");
    for name in ["grasps", "scene", "grasp-0", "pregrasp-0"] {
        assert!(!bench.read(&format!("out/ros-{name}.yaml")).is_empty());
    }
    let planned_picture = bench.read("out/picture.png");

    // Without a robot the record is what it was, and the messages of the run before are gone.
    run(&[]).succeeded();
    let text = String::from_utf8(bench.read("out/picks.json")).unwrap();
    assert!(!text.contains("clearance") && !text.contains("gripper"));
    assert!(!bench.path("out/ros-pose-0.yaml").exists());
    assert_ne!(bench.read("out/picture.png"), planned_picture);

    let alone = run(&["--ros"]);
    assert!(alone.code == 2 && alone.err.contains("--robot"));
    bench.write("r.toml", "[gripper]\njaw_width_m = -1.0\n");
    run(&["--robot", &r]).refused(&[
        "r.toml",
        "line 2",
        "gripper.jaw_width_m = -1.0",
        "over 0 and at most 1",
    ]);
    bench.write("r.toml", "[griper]\n");
    let unknown = run(&["--robot", &r]);
    assert!(unknown.code == 2 && unknown.err.contains("r.toml") && unknown.err.contains("griper"));
    bench.write("r.toml", "");
    let alone = pomona(&["pick", &frame, "--out", &out, "--robot", &r]);
    assert!(
        alone.code != 0 && alone.err.contains("--transform"),
        "{}",
        alone.err
    );
}

#[test]
fn boxes_can_come_from_elsewhere() {
    let bench = Bench::new();
    std::fs::rename(bench.path("a/boxes.xml"), bench.path("boxes.xml")).unwrap();
    let (frame, out, boxes) = (bench.text("a"), bench.text("out"), bench.text("boxes.xml"));
    let runtime = bench.text("libnowhere.so");
    let without = ["pick", &frame, "--out", &out, "--runtime", &runtime];
    pomona(&without).refused(&["'a' has no boxes", "boxes.xml", "--boxes FILE"]);
    let twice = pomona(&[&without[..], &["--detect", "--boxes", &boxes]].concat());
    assert!(
        twice.code == 2 && twice.err.contains("--detect"),
        "{}",
        twice.err
    );
    assert!(!bench.path("out").exists());
    pomona(&["pick", &frame, "--out", &out, "--boxes", &boxes]).succeeded();
    assert_eq!(record(&bench, "out/picks.json").picks.len(), 3);
    let both = [&*frame, &frame];
    let arguments = [&["pick"], &both[..], &["--out", &out, "--boxes", &boxes]].concat();
    pomona(&arguments).refused(&["--boxes", "one frame"]);
}
