//! Files of samples: what is read, and what is refused with which message.

use pomona_calibrate::{SampleSet, Samples};
use proptest::prelude::*;

const POINTS: &str = r#"{ "schema": "pomona.calibration-samples/1", "robot_frame": "base_link",
  "points": [
    { "id": "a", "camera_m": [0.1, 0.2, 0.9], "robot_m": [1.0, 0.0, 0.5] },
    { "id": "b", "camera_m": [0.0, 0.2, 0.9], "robot_m": [1.1, 0.0, 0.5] } ] }"#;
const POSES: &str = r#"{ "schema": "pomona.calibration-samples/1",
  "poses": [ { "id": "s1",
    "robot_from_flange": { "translation_m": [0.6, 0.1, 0.5], "quaternion_xyzw": [0, 0.7071068, 0, 0.7071068] },
    "camera_from_target": { "matrix": [[1,0,0,0.1],[0,-1,0,0.2],[0,0,-1,0.8],[0,0,0,1]] } } ] }"#;
const POINTS_CSV: &str = "id,robot_x_m,robot_y_m,robot_z_m,camera_x_m,camera_y_m,camera_z_m
a, 1.0,0.0,0.5, 0.1,0.2,0.9
b, 1.1,0.0,0.5, 0.0,0.2,0.9
";
const POSES_CSV: &str = "id,robot_from_flange_x_m,robot_from_flange_y_m,robot_from_flange_z_m,robot_from_flange_qx,robot_from_flange_qy,robot_from_flange_qz,robot_from_flange_qw,camera_from_target_x_m,camera_from_target_y_m,camera_from_target_z_m,camera_from_target_qx,camera_from_target_qy,camera_from_target_qz,camera_from_target_qw
s1,0.6,0.1,0.5,0,0.7071068,0,0.7071068,0.1,0.2,0.8,1,0,0,0
";

fn read(text: &str) -> Result<SampleSet, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("samples.txt");
    std::fs::write(&path, text).unwrap();
    SampleSet::read(&path).map_err(|e| {
        let message = e.to_string();
        assert!(
            message.contains("samples.txt: ") && message.contains("; "),
            "{message}"
        );
        message
    })
}

proptest! {
    #[test]
    fn nothing_panics(
        file in prop::sample::select(vec![POINTS, POSES, POINTS_CSV, POSES_CSV]),
        at in any::<prop::sample::Index>(), length in 0..20usize, other in "[-0-9a-z\\[\\]{}\",.:\n\u{e9}]{0,6}",
    ) {
        let mut text: Vec<char> = file.chars().collect();
        let start = at.index(text.len());
        let end = (start + length).min(text.len());
        text.splice(start..end, other.chars());
        let text: String = text.into_iter().collect();
        let _ = read(&text);
    }
}

#[test]
fn both_forms_hold_the_same() {
    let json = read(POINTS).unwrap();
    assert_eq!(json.frames.robot.as_deref(), Some("base_link"));
    assert_eq!(json.samples, read(POINTS_CSV).unwrap().samples);
    let (Samples::Poses(json), Samples::Poses(csv)) = (
        read(POSES).unwrap().samples,
        read(POSES_CSV).unwrap().samples,
    ) else {
        panic!("poses");
    };
    let apart = |a: nalgebra::Matrix4<f64>, b: nalgebra::Matrix4<f64>| (a - b).amax();
    assert!(
        apart(
            json[0].camera_from_target.matrix(),
            csv[0].camera_from_target.matrix()
        ) < 1e-12
    );
    assert_eq!(json[0].robot_from_flange, csv[0].robot_from_flange);
}

#[test]
fn what_is_wrong_is_named_with_its_place() {
    for (text, old, new, words) in [
        (
            POINTS,
            "samples/1",
            "samples/2",
            &["schema", "samples/2"][..],
        ),
        (POINTS, "\"b\"", "\"a\"", &["points[1]", "`a`", "points[0]"]),
        (POINTS, "\"b\"", "\" \"", &["points[1]", "empty"]),
        (POINTS, "robot_m", "robot_mm", &["line 3", "robot_mm"]),
        (POINTS, "0.9]", "]", &["line 3"]),
        (POINTS, "points", "point", &["line 2", "point"]),
        (
            POSES,
            "0.7071068, 0, 0.7071068",
            "0.7, 0, 0.6",
            &["s1", "robot_from_flange", "norm"],
        ),
        (
            POSES,
            "\"matrix\"",
            "\"translation_m\": [0,0,0], \"matrix\"",
            &["s1", "camera_from_target", "twice"],
        ),
        (POSES, "[0,-1,0,0.2]", "[0,1,0,0.2]", &["s1", "mirrors"]),
        (POINTS_CSV, "robot_x_m", "robot_u", &["line 1", "robot_u"]),
        (
            POINTS_CSV,
            "camera_x_m",
            "robot_x_m",
            &["line 1", "robot_x_m", "twice"],
        ),
        (POINTS_CSV, "b, 1.1", "a, 1.1", &["line 3", "`a`", "line 2"]),
        (POINTS_CSV, "1.1,", "one,", &["line 3", "robot_x_m", "one"]),
        (POINTS_CSV, "1.1,", "NaN,", &["line 3", "NaN"]),
        (POINTS_CSV, "1.1,", "1.1,2,", &["line 3"]),
        (
            POSES_CSV,
            ",1,0,0,0",
            ",1,1,0,0",
            &["line 2", "camera_from_target", "norm"],
        ),
    ] {
        let wrong = text.replacen(old, new, 1);
        assert_ne!(wrong, text);
        let message = read(&wrong).unwrap_err();
        for word in words {
            assert!(message.contains(word), "{word}: {message}");
        }
    }
    assert!(read("").unwrap_err().contains("line 1"));
    let missing = SampleSet::read("/no/such/file.csv")
        .unwrap_err()
        .to_string();
    assert!(missing.contains("/no/such/file.csv") && missing.contains("check the path"));
}
