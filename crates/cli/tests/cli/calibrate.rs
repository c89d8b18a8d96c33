use crate::binary::pomona;
use crate::scene::Bench;
use serde_json::Value;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

/// Points of a camera that looks along the robot's x, 0.5 m above its base; `p3` was noted down wrongly. `unit` is what
/// the camera's numbers count.
fn points(unit: f64) -> String {
    let mut text = "id,camera_x_m,camera_y_m,camera_z_m,robot_x_m,robot_y_m,robot_z_m\n".to_owned();
    for i in 0..9 {
        let i = f64::from(i);
        let (x, y, z) = (
            0.07 * i - 0.3,
            0.2 * (2.0 * i).sin(),
            0.8 + 0.2 * (1.7 * i).cos(),
        );
        let wrong = if i == 3.0 { 0.2 } else { 0.0 };
        let [a, b, c] = [x, y, z].map(|v| v / unit);
        let _ = writeln!(text, "p{i},{a},{b},{c},{},{},{}", z + wrong, -x, 0.5 - y);
    }
    text
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<String> = entries
        .map(|e| e.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

#[test]
fn points_give_the_transform_that_pick_reads() {
    let bench = Bench::new();
    let samples = bench.text("points.csv");
    fs::write(&samples, points(1.0)).unwrap();
    let out = bench.text("robot_from_camera.json");
    let arguments = [
        "calibrate",
        &samples,
        "--out",
        &out,
        "--fruit-distance",
        "0.9",
    ];
    let run = pomona(&arguments).succeeded();
    for word in [
        "off mm",
        "p3",
        "moved between",
        "error at 0.90 m",
        "robot_from_camera.report.json",
    ] {
        assert!(run.out.contains(word), "{word}: {}", run.out);
    }
    let transform: Value = serde_json::from_slice(&fs::read(&out).unwrap()).unwrap();
    assert_eq!(transform["to"], "base_link");
    for (found, expected) in [
        ("quaternion_xyzw", [0.5, -0.5, 0.5, -0.5]),
        ("translation_m", [0.0, 0.0, 0.5, 0.0]),
    ] {
        let numbers = transform[found].as_array().unwrap();
        // One sign of two: w ≥ 0.
        let sign = if found == "quaternion_xyzw" {
            -1.0
        } else {
            1.0
        };
        for (n, e) in numbers.iter().zip(expected) {
            assert!((n.as_f64().unwrap() - sign * e).abs() < 1e-9, "{transform}");
        }
    }
    let report: Value =
        serde_json::from_slice(&fs::read(bench.path("robot_from_camera.report.json")).unwrap())
            .unwrap();
    assert_eq!(report["schema"], "pomona.calibration/1");
    assert_eq!(report["samples"][3]["rejected"]["cause"], "place_far_off");

    // The same again replaces both, bit for bit, and prints the record on demand.
    let again = pomona(&[&arguments[..], &["--json"]].concat()).succeeded();
    assert_eq!(again.json(), report);

    let picked = pomona(&[
        "pick",
        &bench.text("a"),
        "--transform",
        &out,
        "--out",
        &bench.text("out"),
    ]);
    assert_eq!(picked.code, 0, "{}", picked.err);
    assert!(
        picked.out.contains("rz deg") || picked.out.contains("robot"),
        "{}",
        picked.out
    );
}

#[test]
fn bad_samples_are_refused_and_leave_nothing() {
    let bench = Bench::new();
    let folder = bench.path("calibration");
    fs::create_dir(&folder).unwrap();
    let file = |name: &str| folder.join(name).to_str().unwrap().to_owned();
    let samples = file("s.csv");
    let out = file("t.json");
    fs::write(&samples, points(1e-3)).unwrap();
    pomona(&["calibrate", &samples, "--out", &out])
        .refused(&["s.csv", "camera's points look like millimetres"]);
    fs::write(&samples, points(1.0)).unwrap();
    pomona(&[
        "calibrate",
        &samples,
        "--kind",
        "eye-in-hand",
        "--out",
        &out,
    ])
    .refused(&["s.csv", "eye-in-hand", "points"]);
    pomona(&["calibrate", &samples, "--tolerance-mm", "0", "--out", &out])
        .refused(&["translation_tolerance_m", "positive"]);
    pomona(&["calibrate", &samples, "--out", &samples]).refused(&["s.csv", "--out"]);
    pomona(&["calibrate", &samples, "--out", &file("no/t.json")]).refused(&["cannot be written"]);
    fs::write(&samples, points(1.0).replace("p4", "p5")).unwrap();
    pomona(&["calibrate", &samples, "--out", &out]).refused(&["s.csv", "line 7", "p5", "line 6"]);
    assert_eq!(names(&folder), ["s.csv"]);
}
