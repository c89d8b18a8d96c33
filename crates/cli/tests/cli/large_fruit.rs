//! One flag lets fruit of another size through the whole program: detection, depth check and method.

use crate::binary::{Run, pomona};
use pomona_scenes::{CameraAxis, Lab, Orientation, Sensor, Shot};
use serde_json::Value;
use std::path::Path;

/// Twice the radius of an apple; beyond the default window of radii.
const RADIUS_M: f64 = 0.070;

/// A frame of one fruit of 70 mm under its branch, with its box.
fn write_frame(folder: &Path) {
    let camera = Shot::paper_camera().with_intrinsics([640, 480], [540.0; 2], [319.5, 239.5]);
    let mut lab = Lab::default();
    lab.apple_radius = RADIUS_M;
    lab.branch_radius = 0.006;
    lab.branch_length = 0.6;
    let upright = Orientation {
        axis: CameraAxis::X,
        degrees: 0,
    };
    let scene = Shot::new("large", camera, Sensor::paper(), 1).take(&lab.world(upright));
    scene.frame.write(folder).unwrap();
}

fn pick(folder: &Path, flags: &[&str]) -> Run {
    let (frame, out) = (folder.join("large"), folder.join("out"));
    let (frame, out) = (frame.to_str().unwrap(), out.to_str().unwrap());
    pomona(&[&["pick", frame, "--json", "--out", out][..], flags].concat()).succeeded()
}

/// Checks that the fruit was picked where it is, towards the branch above it.
fn picked(record: &Value) {
    let picks = record["picks"].as_array().unwrap();
    let of_fruit = picks.iter().find(|pick| pick["status"] == "picked");
    let pick = of_fruit.unwrap_or_else(|| panic!("{record}"));
    let radius = pick["apple"]["radius"].as_f64().unwrap();
    assert!((radius - RADIUS_M).abs() < 1e-3, "{radius}");
    let center = pick["apple"]["center"].as_array().unwrap();
    let expected = [0.0, 0.0, Lab::default().distance];
    for (c, e) in center.iter().zip(expected) {
        assert!((c.as_f64().unwrap() - e).abs() < 2e-3, "{center:?}");
    }
    let down = pick["direction"][1].as_f64().unwrap();
    assert!(down < -0.98, "{pick}");
}

#[test]
fn a_boxed_fruit_is_picked_with_one_flag_and_refused_without() {
    let dir = tempfile::tempdir().unwrap();
    write_frame(&dir.path().join("large"));
    for method in ["robust", "paper"] {
        let with = pick(dir.path(), &["--radius-max-mm", "80", "--method", method]);
        picked(&with.json());
        let without = pick(dir.path(), &["--method", method]).json();
        assert_ne!(without["picks"][0]["status"], "picked", "{without}");
    }
}

#[test]
fn a_detected_fruit_is_found_checked_and_picked_with_one_flag() {
    let dir = tempfile::tempdir().unwrap();
    write_frame(&dir.path().join("large"));
    let detect = ["--detect", "--runtime", "embedded"];
    let with = pick(
        dir.path(),
        &[&detect[..], &["--radius-max-mm", "80"]].concat(),
    );
    let record = with.json();
    picked(&record);
    let marks: Vec<&Value> = record["picks"].as_array().unwrap().iter().collect();
    assert!(
        marks.iter().any(|p| p["box"]["mark"] == "plausible"),
        "{record}"
    );
    let without = pick(dir.path(), &detect).json();
    for pick in without["picks"].as_array().unwrap() {
        assert_ne!(pick["status"], "picked", "{pick}");
    }
}
