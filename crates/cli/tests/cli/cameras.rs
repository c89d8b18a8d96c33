//! Camera files as other programs write them: the answers are those of the frame's own camera, or there is a reason.

use crate::binary::{Run, pomona};
use crate::scene::Bench;
use serde_json::Value;

/// Picks frame `a` with this camera file in place of its own.
fn run(bench: &Bench, name: &str, text: &str, more: &[&str]) -> Run {
    std::fs::remove_file(bench.path("a/camera.json")).unwrap_or_default();
    bench.write(&format!("a/{name}"), text);
    let (frame, out) = (bench.text("a"), bench.text("out"));
    let base = [
        "pick",
        &frame,
        "--no-picture",
        "--clouds",
        "none",
        "--out",
        &out,
    ];
    pomona(&[&base[..], more].concat())
}

fn codes(record: &Value) -> Vec<&str> {
    let warnings = record["warnings"].as_array();
    warnings
        .into_iter()
        .flatten()
        .map(|warning| warning["code"].as_str().unwrap())
        .collect()
}

/// The centre of the first apple, m.
fn center(record: &Value) -> [f64; 3] {
    let center = record["picks"][0]["apple"]["center"].as_array().unwrap();
    [0, 1, 2].map(|i| center[i].as_f64().unwrap())
}

/// The centre with the frame's own camera, and its depth unit.
fn right(bench: &Bench) -> ([f64; 3], String) {
    let scale = bench.read_json("a/camera.json")["depth_scale"].to_string();
    let (frame, out) = (bench.text("a"), bench.text("own"));
    let base = [
        "pick",
        &frame,
        "--no-picture",
        "--clouds",
        "none",
        "--out",
        &out,
    ];
    pomona(&base).succeeded();
    (center(&bench.read_json("own/picks.json")), scale)
}

/// Checks that frame `a` gives the right answer, to 0.1 mm, with this camera file, and which warnings it gives.
#[track_caller]
fn gives_the_right_answer(name: &str, text: &str, more: &[&str], expected: &[&str]) {
    let bench = Bench::new();
    let (right, scale) = right(&bench);
    let scale = ["--depth-scale", &scale];
    let run = run(&bench, name, text, &[more, &scale[..]].concat());
    assert_eq!(run.code, 0, "{}", run.err);
    let record = bench.read_json("out/picks.json");
    let found = center(&record);
    for (a, b) in found.iter().zip(right) {
        assert!((a - b).abs() < 1e-4, "{found:?} {right:?}");
    }
    assert_eq!(codes(&record), expected, "{}", run.err);
    for code in expected {
        assert!(run.err.contains(&format!("[{code}]")), "{}", run.err);
    }
}

/// Checks that frame `a` is refused with this camera file, by these words.
#[track_caller]
fn is_refused(name: &str, text: &str, more: &[&str], words: &[&str]) {
    let bench = Bench::new();
    let run = run(&bench, name, text, more);
    assert_eq!(run.code, 2, "{}", run.err);
    for word in words.iter().chain([&name]) {
        assert!(run.err.contains(word), "no `{word}` in {}", run.err);
    }
    assert!(!bench.path("out").exists());
}

/// A `CameraInfo` with focal length, principal point, D, P and what else is given.
fn info([width, height]: [usize; 2], k: [f64; 3], d: &str, p: [f64; 3], more: &str) -> String {
    let [[f, cx, cy], [pf, px, py]] = [k, p];
    let one = if f == 0.0 { 0.0 } else { 1.0 };
    format!(
        "header:\n  frame_id: camera_color_optical_frame\nheight: {height}\nwidth: {width}\ndistortion_model: plumb_bob\n\
         d: [{d}]\nk: [{f}, 0.0, {cx}, 0.0, {f}, {cy}, 0.0, 0.0, {one:.1}]\nr: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]\n\
         p: [{pf}, 0.0, {px}, 0.0, 0.0, {pf}, {py}, 0.0, 0.0, 0.0, 1.0, 0.0]\n{more}\n"
    )
}

const ZERO: &str = "0.0, 0.0, 0.0, 0.0, 0.0";
const OWN: [f64; 3] = [540.0, 159.5, 119.5];

#[test]
fn binning_and_region_are_applied() {
    let sensor = [1080.0, 319.5, 239.5];
    let binned = "binning_x: 2\nbinning_y: 2";
    let text = info([640, 480], sensor, ZERO, OWN, binned);
    gives_the_right_answer("camera.yaml", &text, &[], &["sensor_region_applied"]);
    let text = info([320, 240], sensor, ZERO, OWN, binned);
    gives_the_right_answer("camera.yaml", &text, &[], &["sensor_region_applied"]);

    let part = "roi: {x_offset: 100, y_offset: 50, height: 240, width: 320, do_rectify: false}";
    let sensor = [540.0, 259.5, 169.5];
    let text = info([480, 320], sensor, ZERO, OWN, part);
    gives_the_right_answer("camera.yaml", &text, &[], &["sensor_region_applied"]);
    let text = info([320, 240], sensor, ZERO, OWN, part);
    gives_the_right_answer("camera.yaml", &text, &[], &["sensor_region_applied"]);
    let text = info([320, 240], sensor, ZERO, sensor, part);
    is_refused("camera.yaml", &text, &[], &["roi", "320 x 240 at 100, 50"]);
    let text = info([320, 240], OWN, ZERO, OWN, binned);
    is_refused("camera.yaml", &text, &[], &["binning", "160 x 120"]);
}

#[test]
fn without_k_the_projection_matrix_is_taken() {
    let text = info([320, 240], [0.0; 3], "", OWN, "");
    gives_the_right_answer("camera.yaml", &text, &[], &["projection_matrix_taken"]);
}

#[test]
fn raw_or_rectified_images_are_a_choice() {
    let raw = [530.0, 165.0, 115.0];
    let text = info([320, 240], raw, "0.08, -0.2, 0.0005, -0.0003, 0.1", OWN, "");
    gives_the_right_answer("camera.yaml", &text, &["--images", "rectified"], &[]);
    let (bench, other) = (Bench::new(), Bench::new());
    let scale = right(&bench).1;
    let scale = ["--depth-scale", scale.as_str()];
    let unsaid = run(&bench, "camera.yaml", &text, &scale);
    assert_eq!(unsaid.code, 0, "{}", unsaid.err);
    let record = bench.read_json("out/picks.json");
    assert_eq!(codes(&record), ["raw_images_assumed"]);
    assert!(
        unsaid.err.starts_with("warning: a: camera.yaml: "),
        "{}",
        unsaid.err
    );
    run(
        &other,
        "camera.yaml",
        &text,
        &[&scale[..], &["--images", "raw"]].concat(),
    )
    .succeeded();
    let said = other.read_json("out/picks.json");
    assert_eq!((codes(&said), center(&said)), (vec![], center(&record)));
    // Whatever else reads the frame is told the same.
    let inspected = pomona(&[
        "inspect",
        &bench.text("a"),
        "--json",
        "--images",
        "rectified",
    ]);
    assert_eq!(inspected.succeeded().json()["focal_px"][0], 540.0);
}

#[test]
fn long_lists_of_coefficients_are_the_rational_model() {
    let fourteen =
        "0.5, -2.7, 0.0007, -0.0001, 1.5, 0.38, -2.5, 1.46, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0";
    let rational =
        |d: &str| info([320, 240], OWN, d, OWN, "").replace("plumb_bob", "rational_polynomial");
    let eight = rational(
        fourteen
            .strip_suffix(", 0.0, 0.0, 0.0, 0.0, 0.0, 0.0")
            .unwrap(),
    );
    let fourteen = rational(fourteen);
    let centers = [eight, fourteen].map(|text| {
        let bench = Bench::new();
        let scale = right(&bench).1;
        run(&bench, "camera.yaml", &text, &["--depth-scale", &scale]).succeeded();
        center(&bench.read_json("out/picks.json"))
    });
    assert_eq!(centers[0], centers[1]);
}

#[test]
fn numbers_that_are_no_cameras_are_doubted_or_refused() {
    let own = |f: [f64; 2], c: [f64; 2]| {
        format!(
            r#"{{"width": 320, "height": 240, "fx": {}, "fy": {}, "cx": {}, "cy": {}, "depth_scale": 0.0002,
                "frame_id": "camera_color_optical_frame"}}"#,
            f[0], f[1], c[0], c[1]
        )
    };
    for (text, code) in [
        (
            own([810.0; 2], [239.25, 179.25]),
            "intrinsics_of_another_size",
        ),
        (
            own([540.0; 2], [230.0, 119.5]),
            "principal_point_off_center",
        ),
        (own([540.0, 480.0], [159.5, 119.5]), "focal_lengths_differ"),
        (
            own([1200.0; 2], [159.5, 119.5]),
            "field_of_view_implausible",
        ),
    ] {
        let bench = Bench::new();
        let run = run(&bench, "camera.json", &text, &[]);
        assert_eq!(run.code, 0, "{}", run.err);
        assert!(
            run.err.contains(&format!("[{code}]")),
            "{code}: {}",
            run.err
        );
        let record = bench.read_json("out/picks.json");
        assert!(codes(&record).contains(&code), "{record}");
        assert_eq!(record["warnings"][0]["level"], "warning");
        let inspected = pomona(&["inspect", &bench.text("a/camera.json")]).succeeded();
        assert!(inspected.out.contains(code), "{}", inspected.out);
    }
    let outside = own([540.0; 2], [5000.0, 119.5]);
    is_refused(
        "camera.json",
        &outside,
        &[],
        &["away from the axis", "principal point"],
    );
}

#[test]
fn other_programs_forms_are_read() {
    let file_storage = "%YAML:1.0\n---\nimage_width: 320\nimage_height: 240\ncamera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n\
        \x20  dt: d\n   data: [ 540., 0., 159.5, 0., 540., 119.5, 0., 0., 1. ]\ndistortion_coefficients: !!opencv-matrix\n   rows: 1\n\
        \x20  cols: 5\n   dt: d\n   data: [ 0., 0., 0., 0., 0. ]\n";
    gives_the_right_answer("camera.yaml", file_storage, &[], &["frame_id_assumed"]);
    let ros1 = "image_width: 320\nimage_height: 240\ncamera_name: camera_color_optical_frame\ncamera_matrix:\n  rows: 3\n  cols: 3\n\
        \x20 data: [540.0,   0.     , 159.5,\n           0.     , 540.0, 119.5,\n           0.     ,   0.     ,   1.     ]\n\
        camera_model: plumb_bob\ndistortion_coefficients:\n  rows: 1\n  cols: 5\n  data: [0.0, 0.0, 0.0, 0.0, 0.0]\n";
    gives_the_right_answer("ost.yaml", ros1, &[], &[]);
    let kalibr = "cam0:\n  camera_model: pinhole\n  distortion_coeffs: [0.0, 0.0, 0.0, 0.0]\n  distortion_model: radtan\n\
        \x20 intrinsics: [540.0, 540.0, 159.5, 119.5]\n  resolution: [320, 240]\n";
    gives_the_right_answer("camera.yaml", kalibr, &[], &["frame_id_assumed"]);
    let realsense = r#"{"width": 320, "height": 240, "ppx": 159.5, "ppy": 119.5, "fx": 540.0, "fy": 540.0,
        "model": "distortion.inverse_brown_conrady", "coeffs": [0.0, 0.0, 0.0, 0.0, 0.0]}"#;
    gives_the_right_answer("intrinsics.json", realsense, &[], &["frame_id_assumed"]);
    let message = r#"{"header": {"frame_id": "camera_color_optical_frame"}, "width": 320, "height": 240, "distortion_model": "plumb_bob",
        "d": [0, 0, 0, 0, 0], "k": [540, 0, 159.5, 0, 540, 119.5, 0, 0, 1], "binning_x": 0, "binning_y": 0}"#;
    gives_the_right_answer("camera_info.json", message, &[], &[]);
    let own = "\u{feff}{\"width\": 320, \"height\": 240, \"fx\": 540, \"fy\": 540, \"cx\": 159.5, \"cy\": 119.5}";
    gives_the_right_answer("camera.json", own, &[], &["frame_id_assumed"]);
}

#[test]
fn a_second_camera_file_is_mentioned() {
    let bench = Bench::new();
    bench.write("a/camera_info.yaml", info([320, 240], OWN, ZERO, OWN, ""));
    let (frame, out) = (bench.text("a"), bench.text("out"));
    let run = pomona(&["pick", &frame, "--no-picture", "--out", &out]);
    assert!(run.err.contains("[other_cameras_ignored]"), "{}", run.err);
    assert!(
        run.err.contains("camera_info.yaml beside it"),
        "{}",
        run.err
    );
}

#[test]
fn a_depth_scale_is_metres_per_unit_or_units_per_metre() {
    let centers = ["0.0002", "5000"].map(|scale| {
        let bench = Bench::new();
        let (frame, out) = (bench.text("a"), bench.text("out"));
        pomona(&[
            "pick",
            &frame,
            "--no-picture",
            "--out",
            &out,
            "--depth-scale",
            scale,
        ])
        .succeeded();
        center(&bench.read_json("out/picks.json"))
    });
    assert_eq!(centers[0], centers[1]);
    let bench = Bench::new();
    let (frame, out) = (bench.text("a"), bench.text("out"));
    for wrong in ["0", "-1", "nan", "much"] {
        let run = pomona(&[
            "pick",
            &frame,
            "--out",
            &out,
            &format!("--depth-scale={wrong}"),
        ]);
        assert_eq!(run.code, 2, "{wrong}");
        assert!(run.err.contains("positive"), "{}", run.err);
    }
}

#[test]
fn one_wrong_factor_in_all_apples_is_suspected() {
    let folder = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../fixtures/frames/orchard-demo"
    );
    let bench = Bench::new();
    let out = bench.text("out");
    let base = [
        "pick",
        folder,
        "--no-picture",
        "--clouds",
        "none",
        "--out",
        &out,
    ];
    let run = pomona(&[&base[..], &["--depth-scale", "0.001"]].concat());
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(run.err.contains("times too large"), "{}", run.err);
    assert_eq!(
        codes(&bench.read_json("out/picks.json")),
        ["sizes_implausible"]
    );
}
