//! Reading and writing `robot_from_camera.json`.

use nalgebra::UnitQuaternion;
use pomona_transforms::{
    CameraFrame, FileError, NamedTransform, RobotFrame, SCHEMA, Transform, TransformContentError,
    TransformError, TransformFileError,
};
use proptest::prelude::*;
use std::fs;

type RobotFromCamera = NamedTransform<RobotFrame, CameraFrame>;

const GOOD: &str = r#"{
  "schema": "pomona.transform/1",
  "to": "base_link",
  "from": "camera_color_optical_frame",
  "translation_m": [0.1, -0.2, 1.3],
  "quaternion_xyzw": [0.5, -0.5, 0.5, -0.5]
}"#;

const MATRIX: &str = r#"{"schema":"pomona.transform/1","to":"base_link","from":"optical",
  "matrix":[[0,0,1,0.1],[-1,0,0,-0.2],[0,-1,0,1.3],[0,0,0,1]]}"#;

fn read(text: &str) -> Result<RobotFromCamera, TransformFileError> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("robot_from_camera.json");
    fs::write(&path, text).expect("room for a small file");
    RobotFromCamera::read(path)
}

/// What is wrong with `text`; the message names the file.
fn refusal(text: &str) -> TransformContentError {
    let error = read(text).expect_err("to be refused");
    assert!(
        error.to_string().contains("robot_from_camera.json: "),
        "{error}"
    );
    content(error)
}

fn content(error: TransformFileError) -> TransformContentError {
    match error {
        TransformFileError::Content { source, .. } => source,
        other => panic!("{other}"),
    }
}

fn numbers(text: &str) -> TransformError {
    match refusal(text) {
        TransformContentError::Numbers(source) => source,
        other => panic!("{other}"),
    }
}

fn replaced(text: &str, old: &str, new: &str) -> String {
    assert!(text.contains(old), "{old}");
    text.replace(old, new)
}

#[test]
fn reads_either_form() {
    let named = read(GOOD).unwrap();
    assert_eq!(named.to, "base_link");
    assert_eq!(named.from, "camera_color_optical_frame");
    assert_eq!(named.transform.quaternion_xyzw(), [-0.5, 0.5, -0.5, 0.5]);
    let by_matrix = read(MATRIX).unwrap().transform;
    assert!((by_matrix.matrix() - named.transform.matrix()).amax() < 1e-15);
    let back = named.inverse();
    assert_eq!(
        (back.to.as_str(), back.from.as_str()),
        ("camera_color_optical_frame", "base_link")
    );
}

#[test]
fn a_missing_file_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let error = RobotFromCamera::read(folder.path().join("none.json")).unwrap_err();
    assert!(matches!(
        error,
        TransformFileError::File(FileError::Read { .. })
    ));
    let message = error.to_string();
    assert!(
        message.contains("none.json") && message.contains("check the path"),
        "{message}"
    );
}

#[test]
fn what_is_no_json_has_a_place() {
    for text in ["", "translation: 1", "{\"schema\":", "\u{0}", "{} {}"] {
        let error = refusal(text);
        assert!(
            matches!(error, TransformContentError::Json { .. }),
            "{error}"
        );
    }
    match refusal(&replaced(GOOD, "1.3]", "1.3")) {
        TransformContentError::Json { line, .. } => assert_eq!(line, 6),
        other => panic!("{other}"),
    }
}

#[test]
fn the_fields_are_those_of_the_schema() {
    for (old, new, named) in [
        (
            "\"translation_m\"",
            "\"translation_mm\"",
            "unknown field `translation_mm`",
        ),
        (
            "\"quaternion_xyzw\"",
            "\"quaternion\"",
            "unknown field `quaternion`",
        ),
        ("\"to\": \"base_link\",", "", "missing field `to`"),
        ("\"base_link\"", "7", "expected a string"),
        ("-0.2, 1.3", "-0.2", "invalid length 2"),
        ("-0.2, 1.3", "-0.2, 1.3, 0.0", "trailing characters"),
        ("1.3", "null", "expected f64"),
        ("\"to\"", "\"from\"", "duplicate field `from`"),
    ] {
        let error = refusal(&replaced(GOOD, old, new));
        assert!(
            matches!(error, TransformContentError::Json { .. }),
            "{error}"
        );
        let message = error.to_string();
        assert!(
            message.contains(named) && message.contains("; give schema, to, from"),
            "{message}"
        );
        assert_eq!(message.matches("column").count(), 1, "{message}");
    }
}

#[test]
fn another_schema_is_another_file() {
    for (text, found) in [
        (
            replaced(GOOD, "transform/1", "transform/2"),
            "\"pomona.transform/2\"",
        ),
        (
            replaced(GOOD, "\"pomona.transform/1\"", "1"),
            "`schema` is 1 ",
        ),
        ("{}".to_owned(), "missing"),
        ("[\"pomona.transform/1\"]".to_owned(), "missing"),
        ("null".to_owned(), "missing"),
    ] {
        let error = refusal(&text);
        assert!(
            matches!(error, TransformContentError::Schema { .. }),
            "{error}"
        );
        let message = error.to_string();
        assert!(
            message.contains(found) && message.contains(SCHEMA),
            "{message}"
        );
    }
}

#[test]
fn one_rotation_and_one_translation() {
    let without_rotation = replaced(
        &replaced(GOOD, ",\n  \"quaternion_xyzw\": [0.5, -0.5, 0.5, -0.5]", ""),
        "0.1",
        "0.2",
    );
    let message = refusal(&without_rotation).to_string();
    assert!(message.contains("there is no rotation"), "{message}");
    let without_translation = replaced(GOOD, "\"translation_m\": [0.1, -0.2, 1.3],", "");
    let message = refusal(&without_translation).to_string();
    assert!(message.contains("there is no translation"), "{message}");
    for (extra, field) in [
        ("\"quaternion_xyzw\":[0,0,0,1],", "`quaternion_xyzw`"),
        ("\"translation_m\":[0,0,0],", "`translation_m`"),
    ] {
        let error = refusal(&replaced(
            MATRIX,
            "\"matrix\"",
            &format!("{extra}\"matrix\""),
        ));
        assert!(
            matches!(error, TransformContentError::TwoForms { .. }),
            "{error}"
        );
        assert!(error.to_string().contains(field), "{error}");
    }
}

#[test]
fn frames_have_names() {
    for (id, field) in [
        ("\"base_link\"", "`to`"),
        ("\"camera_color_optical_frame\"", "`from`"),
    ] {
        let message = refusal(&replaced(GOOD, id, "\" \"")).to_string();
        assert!(
            message.contains(field) && message.contains("is empty"),
            "{message}"
        );
    }
}

#[test]
fn numbers_are_finite() {
    for word in ["NaN", "nan", "-NaN", "Infinity", "-Infinity", "inf"] {
        for text in [
            replaced(GOOD, "1.3", word),
            replaced(GOOD, "[0.1", &format!("[{word}")),
        ] {
            let message = refusal(&text).to_string();
            assert!(
                message.contains("is not a JSON number; give finite numbers"),
                "{message}"
            );
        }
    }
    let message = refusal(&replaced(GOOD, "1.3", "1e999")).to_string();
    assert!(message.contains("number out of range"), "{message}");
    for (old, new) in [
        ("1.3", "one"),
        ("1.3],", "1.3] \"info\": 1,"),
        ("1.3],", "1.3], info: 1,"),
    ] {
        let message = refusal(&replaced(GOOD, old, new)).to_string();
        assert!(!message.contains("is not a JSON number"), "{message}");
    }
}

#[test]
fn rotations_are_rotations() {
    let error = numbers(&replaced(GOOD, "-0.5]", "-0.6]"));
    assert!(
        matches!(error, TransformError::NotUnit { norm, .. } if norm > 1.05),
        "{error}"
    );
    assert!(read(&replaced(GOOD, "-0.5]", "-0.5009]")).is_ok());

    let error = numbers(&replaced(MATRIX, "[[0,0,1,", "[[0,0.1,1,"));
    assert!(
        matches!(error, TransformError::NotOrthonormal { .. }),
        "{error}"
    );
    assert!(read(&replaced(MATRIX, "[[0,0,1,", "[[0,0.0009,1,")).is_ok());

    let error = numbers(&replaced(MATRIX, "[0,-1,0,", "[0,1,0,"));
    assert!(
        matches!(error, TransformError::LeftHanded { .. }),
        "{error}"
    );

    // Column by column.
    let columns = "[[0,-1,0,0],[0,0,-1,0],[1,0,0,0],[0.1,-0.2,1.3,1]]";
    let error = numbers(&replaced(
        MATRIX,
        "[[0,0,1,0.1],[-1,0,0,-0.2],[0,-1,0,1.3],[0,0,0,1]]",
        columns,
    ));
    assert_eq!(
        error,
        TransformError::LastRow {
            field: "matrix",
            row: [0.1, -0.2, 1.3, 1.0]
        }
    );
}

#[test]
fn millimetres_are_not_metres() {
    for (text, field) in [
        (
            replaced(GOOD, "[0.1, -0.2, 1.3]", "[100, -200, 1300]"),
            "`translation_m`",
        ),
        (
            replaced(&replaced(MATRIX, "0.1]", "100]"), "1.3]", "1300]"),
            "`matrix`",
        ),
        (replaced(GOOD, "1.3", "1e300"), "`translation_m`"),
    ] {
        let error = refusal(&text);
        assert!(
            matches!(error, TransformContentError::TooFar { .. }),
            "{error}"
        );
        let message = error.to_string();
        assert!(
            message.contains(field) && message.contains("millimetres"),
            "{message}"
        );
    }
}

#[test]
fn a_write_replaces_and_leaves_nothing_beside() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("robot_from_camera.json");
    fs::write(&path, "old").unwrap();
    let named = read(GOOD).unwrap();
    named.write(&path).unwrap();
    assert_eq!(RobotFromCamera::read(&path).unwrap(), named);
    let written = fs::read_to_string(&path).unwrap();

    // What could not be read back is not written.
    let nameless = RobotFromCamera {
        to: String::new(),
        ..named.clone()
    };
    assert!(matches!(
        content(nameless.write(&path).unwrap_err()),
        TransformContentError::NoFrameId { .. }
    ));
    let far = Transform::from_quaternion([0.0, 300.0, 0.0], [0.0, 0.0, 0.0, 1.0]).unwrap();
    let far = RobotFromCamera {
        transform: far,
        ..named.clone()
    };
    assert!(matches!(
        content(far.write(&path).unwrap_err()),
        TransformContentError::TooFar { .. }
    ));
    assert_eq!(fs::read_to_string(&path).unwrap(), written);

    let occupied = folder.path().join("folder");
    fs::create_dir(&occupied).unwrap();
    for target in [occupied, folder.path().join("no/such/file")] {
        assert!(matches!(
            named.write(target),
            Err(TransformFileError::File(FileError::Write { .. }))
        ));
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
}

proptest! {
    #[test]
    fn reads_what_it_writes_to_the_last_bit(
        translation_m in prop::array::uniform3(-50.0..50.0f64),
        axis_angle in prop::array::uniform3(-4.0..4.0f64),
    ) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("t.json");
        let rotation: [f64; 4] = UnitQuaternion::from_scaled_axis(axis_angle.into()).coords.into();
        let transform = Transform::from_quaternion(translation_m, rotation).unwrap();
        let named = RobotFromCamera::new(transform, "base \"1\"", "optisch/größer");
        named.write(&path).unwrap();
        let again = RobotFromCamera::read(&path).unwrap();
        prop_assert_eq!(&again, &named);
        prop_assert!(again.transform.quaternion_xyzw()[3] >= 0.0);
    }
}
