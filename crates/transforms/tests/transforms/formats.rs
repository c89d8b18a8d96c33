//! Forms of other programs: what they print is read, and what we print is what they read.

use nalgebra::{UnitQuaternion, Vector3};
use pomona_transforms::formats::{
    FormatError, HandEyeType, StaticTransformForm, from_easy_handeye, from_opencv_yaml,
    from_static_transform_arguments, from_urdf_origin, to_easy_handeye, to_opencv_yaml,
    to_static_transform_arguments, to_urdf_joint, to_urdf_origin,
};
use pomona_transforms::{CameraFrame, NamedTransform, RobotFrame, Transform};
use proptest::prelude::*;

type Named = NamedTransform<RobotFrame, CameraFrame>;
type Read = Result<Named, FormatError>;

const FORMS: [StaticTransformForm; 4] = [
    StaticTransformForm::Named,
    StaticTransformForm::NamedAngles,
    StaticTransformForm::Quaternion,
    StaticTransformForm::YawPitchRoll,
];

fn apart(a: &Named, b: &Named) -> f64 {
    assert_eq!((&a.to, &a.from), (&b.to, &b.from));
    (a.transform.matrix() - b.transform.matrix()).amax()
}

/// 0.1 −0.2 1.3, a quarter turn about z.
fn quarter() -> Named {
    let h = 0.5_f64.sqrt();
    let t = Transform::from_quaternion([0.1, -0.2, 1.3], [0.0, 0.0, h, h]).unwrap();
    Named::new(t, "base_link", "camera_optical")
}

proptest! {
    #[test]
    fn everything_comes_back(
        t in prop::array::uniform3(-5.0..5.0f64), axis_angle in prop::array::uniform3(-2.0..2.0f64),
    ) {
        let q: [f64; 4] = UnitQuaternion::from_scaled_axis(Vector3::from(axis_angle)).coords.into();
        let named = Named::new(Transform::from_quaternion(t, q).unwrap(), "base_link", "camera_optical");
        for form in FORMS {
            let text = to_static_transform_arguments(&named, form).join(" ");
            prop_assert!(apart(&from_static_transform_arguments(&text).unwrap(), &named) < 1e-12);
        }
        let read: Named = from_urdf_origin(&to_urdf_origin(&named), "base_link", "camera_optical").unwrap();
        prop_assert!(apart(&read, &named) < 1e-12);
        let read: Named = from_urdf_origin(&to_urdf_joint(&named, "a & b"), "", "").unwrap();
        prop_assert!(apart(&read, &named) < 1e-12);
        for kind in [HandEyeType::EyeOnBase, HandEyeType::EyeInHand] {
            let text = to_easy_handeye(&named, kind, "cal: 1", "tool0", "marker");
            let (read, found) = from_easy_handeye(&text).unwrap();
            prop_assert_eq!(found, kind);
            prop_assert!(apart(&read, &named) < 1e-12);
        }
        let read: Named = from_opencv_yaml(&to_opencv_yaml(&named), "base_link", "camera_optical").unwrap();
        prop_assert!(apart(&read, &named) < 1e-12);
    }

    #[test]
    fn nothing_panics(text in "[-a-z0-9. :{}<>/=\"\\[\\],\n]{0,80}") {
        let _: Read = from_static_transform_arguments(&text);
        let _: Read = from_urdf_origin(&text, "a", "b");
        let _: Read = from_opencv_yaml(&text, "a", "b");
        let _ = from_easy_handeye::<RobotFrame, CameraFrame>(&text);
    }
}

#[test]
fn orders_by_hand() {
    let h = "0.7071067811865476";
    let join = |form| to_static_transform_arguments(&quarter(), form).join(" ");
    assert_eq!(
        join(StaticTransformForm::Quaternion),
        format!("0.1 -0.2 1.3 0.0 0.0 {h} {h} base_link camera_optical")
    );
    assert!(join(StaticTransformForm::YawPitchRoll).starts_with("0.1 -0.2 1.3 1.57"));
    assert!(
        join(StaticTransformForm::Named)
            .contains(&format!("--qz {h} --qw {h} --frame-id base_link"))
    );
    assert!(to_urdf_origin(&quarter()).contains("rpy=\"0.0 0.0 1.57"));
}

#[test]
fn what_others_print_is_read() {
    for text in [
        "ros2 run tf2_ros static_transform_publisher --yaw 1.5707963267948966 --x 0.1 --y -0.2 --z=1.3 --frame-id base_link --child-frame-id camera_optical",
        "rosrun tf static_transform_publisher 0.1 -0.2 1.3 1.5707963267948966 0 0 base_link camera_optical 100",
        "0.1 -0.2 1.3 0 0 0.70710678 0.70710678 base_link camera_optical",
    ] {
        let read: Named = from_static_transform_arguments(text).unwrap();
        assert!(apart(&read, &quarter()) < 1e-8, "{text}");
    }
    let joint = r#"<?xml version="1.0"?><robot name="r"><joint name="j" type="fixed"><origin rpy="0 0 1.5707963267948966" xyz="0.1 -0.2 1.3"/>
      <parent link="base_link"/><child link="camera_optical"/></joint></robot>"#;
    assert!(apart(&from_urdf_origin(joint, "x", "y").unwrap(), &quarter()) < 1e-12);
    let empty: Named = from_urdf_origin("<origin/>", "a", "b").unwrap();
    assert_eq!(empty.transform.matrix(), nalgebra::Matrix4::identity());

    let second = "parameters:\n  name: test\n  calibration_type: eye_on_base\n  robot_base_frame: base_link\n  robot_effector_frame: tool0\n  tracking_base_frame: camera_optical\n  tracking_marker_frame: m\n  freehand_robot_movement: true\ntransform:\n  rotation: {w: 0.70710678, x: 0.0, y: 0.0, z: 0.70710678}\n  translation:\n    x: 0.1\n    y: -0.2\n    z: 1.3\n";
    let first = "parameters:\n  eye_on_hand: false\n  namespace: /x/\n  robot_base_frame: base_link\n  robot_effector_frame: tool0\n  tracking_base_frame: camera_optical\n  tracking_marker_frame: m\ntransformation: {qw: 0.70710678, qx: 0, qy: 0, qz: 0.70710678, x: 0.1, y: -0.2, z: 1.3}\n";
    let oldest = "eye_on_hand: true\nrobot_effector_frame: base_link\ntracking_base_frame: camera_optical\ntransformation: {qw: 0.70710678, qx: 0, qy: 0, qz: 0.70710678, x: 0.1, y: -0.2, z: 1.3}\n";
    for (text, kind) in [
        (second, HandEyeType::EyeOnBase),
        (first, HandEyeType::EyeOnBase),
        (oldest, HandEyeType::EyeInHand),
    ] {
        let (read, found) = from_easy_handeye(text).unwrap();
        assert_eq!(found, kind);
        assert!(apart(&read, &quarter()) < 1e-8);
    }

    let head = "%YAML:1.0\n---\nnote: \"by hand\"\ncount: 15\n";
    let whole = "pose: !!opencv-matrix\n   rows: 4\n   cols: 4\n   dt: d\n   data: [ 0., -1., 0., 1.0000000000000001e-01, 1., 0., 0.,\n       -2.0000000000000001e-01, 0., 0., 1., 1.3, 0., 0., 0., 1. ]\n";
    let parts = "R: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n   data: [ 0., -1., 0., 1., 0., 0., 0., 0., 1. ]\nT: !!opencv-matrix\n   rows: 3\n   cols: 1\n   dt: d\n   data: [ 0.1, -0.2, 1.3 ]\n";
    // As cv::FileStorage of OpenCV 4.12 wrote it.
    let written = "pose: !!opencv-matrix\n   rows: 4\n   cols: 4\n   dt: d\n   data: [ 0., -1., 0., 0.10000000000000001, 1., 0., 0.,\n       -0.20000000000000001, 0., 0., 1., 1.3, 0., 0., 0., 1. ]\n";
    let vectors = "rvec: !!opencv-matrix\n   rows: 3\n   cols: 1\n   dt: d\n   data: [ 0., 0., 1.5707963267948966 ]\ntvec: !!opencv-matrix\n   rows: 1\n   cols: 3\n   dt: d\n   data: [ 0.1, -0.2, 1.3 ]\n";
    for body in [whole, written, parts, vectors] {
        let read: Named =
            from_opencv_yaml(&format!("{head}{body}"), "base_link", "camera_optical").unwrap();
        assert!(apart(&read, &quarter()) < 1e-12, "{body}");
    }
}

#[test]
fn what_is_wrong_is_named() {
    let words = |error: FormatError, words: &[&str]| {
        let message = error.to_string();
        for word in words {
            assert!(message.contains(word), "{word}: {message}");
        }
        assert!(message.contains("; "), "{message}");
    };
    let read = |text: &str| -> Read { from_static_transform_arguments(text) };
    for (text, named) in [
        ("1 2 3 4 5 a b", &["5 numbers"][..]),
        ("1 2 3 0 0 0 1 a", &["frames"]),
        ("--x 1 --frame-id a", &["frame is missing"]),
        (
            "--x 1 --qw 1 --yaw 1 --frame-id a --child-frame-id b",
            &["quaternion and angles"],
        ),
        (
            "--x 1 --x 2 --frame-id a --child-frame-id b",
            &["--x", "twice"],
        ),
        ("--foo 1 --frame-id a --child-frame-id b", &["--foo"]),
        ("--x one --frame-id a --child-frame-id b", &["--x", "one"]),
        ("1 2 3 0 0 0 2 a b", &["norm"]),
        ("nan 2 3 0 0 0 1 a b", &["argument 1"]),
        ("1000 0 0 0 0 0 1 a b", &["millimetres"]),
    ] {
        words(read(text).unwrap_err(), named);
    }
    let read = |text: &str| -> Read { from_urdf_origin(text, "a", "b") };
    words(
        read("<origin xyz='1 2'/>").unwrap_err(),
        &["line 1", "xyz", "2 numbers"],
    );
    words(read("<link/>").unwrap_err(), &["no <origin>"]);
    words(read("<origin").unwrap_err(), &["line 1"]);
    let read = |text: &str| -> Read { from_opencv_yaml(text, "a", "b") };
    let matrix = |data: &str| {
        format!("T: !!opencv-matrix\n   rows: 4\n   cols: 4\n   dt: d\n   data: [ {data} ]\n")
    };
    words(read(&matrix("1, 0")).unwrap_err(), &["T", "4x4"]);
    words(
        read(&matrix("1,0,0,0, 0,1,0,0, 0,0,-1,0, 0,0,0,1")).unwrap_err(),
        &["mirrors"],
    );
    words(read("x: 1\n").unwrap_err(), &["translation"]);
    let read = from_easy_handeye::<RobotFrame, CameraFrame>;
    words(read("a: 1\n").unwrap_err(), &["calibration_type"]);
    words(
        read("eye_on_hand: false\nrobot_base_frame: b\ntracking_base_frame: c\n").unwrap_err(),
        &["transform"],
    );
}
