//! A transform's file in any form that is known, with what it says about its frames.

use crate::formats::{
    FormatError, HandEyeType, from_easy_handeye, from_matrix_text, from_opencv_yaml, from_stamped,
    from_static_transform_arguments, from_urdf_origin,
};
use crate::{
    FlangeFrame, FrameTag, NamedTransform, Transform, TransformContentError, TransformFileError,
    json,
};
use nalgebra::{Isometry3, Matrix6};
use pomona_files::{Warning, WarningCode, WithWarnings};
use std::path::Path;

/// A transform as a file of any known form gives it: pomona's JSON, calibration files of `easy_handeye`, a
/// `TransformStamped` of ROS as `ros2 topic echo` prints it (or the lines of `tf2_echo`), the arguments of
/// `static_transform_publisher`, URDF's `<origin>`, OpenCV's `FileStorage`, or a matrix as text.
///
/// Of some forms the frames have no names, and of none is it sure what they are: [`AnyTransform::named`] gives them.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct AnyTransform {
    isometry: Isometry3<f64>,
    covariance: Option<Matrix6<f64>>,
    /// Id of the frame it leads to, where the file names it.
    pub to: Option<String>,
    /// Id of the frame it starts in, where the file names it.
    pub from: Option<String>,
    /// The file's form, for people.
    pub form: &'static str,
    /// Whether the file says that it leads to the flange: a camera on the gripper.
    says_flange: bool,
}

/// Metres from a robot's base, or from its flange, beyond which a camera is not expected: arms reach 3 m, and a platform
/// adds a few. Millimetres taken for metres are farther as soon as they count 10.
const FAR_M: f64 = 10.0;

/// Stands for a frame that the file does not name.
const UNNAMED: &str = "?";

impl AnyTransform {
    /// Reads a transform's file of any known form, told by its content.
    ///
    /// # Errors
    ///
    /// [`TransformFileError::File`]; [`TransformFileError::Content`] for what is of no known form, or not a rigid
    /// transform in metres.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, TransformFileError> {
        let path = path.as_ref();
        let bytes = pomona_files::read(path)?;
        parse(&bytes).map_err(|source| TransformFileError::Content {
            path: path.to_owned(),
            source,
        })
    }

    /// Whether it leads to a robot's flange: the file says so, or the frame has a flange's name (`flange`, `tool0`,
    /// `panda_hand`, `wrist_3_link`, …).
    pub fn leads_to_flange(&self) -> bool {
        self.says_flange || self.to.as_deref().is_some_and(is_flange_name)
    }

    /// The transform between frames of these kinds. Where the file does not name them, they get these ids, and a warning
    /// says so; another says where the translation is so long that its unit may be wrong.
    ///
    /// # Errors
    ///
    /// [`crate::TransformError`] for numbers that are not a rigid transform, which reading excludes.
    pub fn named<To: FrameTag, From: FrameTag>(
        &self,
        to: &str,
        from: &str,
    ) -> Result<WithWarnings<NamedTransform<To, From>>, crate::TransformError> {
        let mut warnings = Vec::new();
        let unnamed: Vec<String> = [(&self.to, "leads to", to), (&self.from, "starts in", from)]
            .into_iter()
            .filter(|(id, ..)| id.is_none())
            .map(|(_, what, id)| format!("{what} `{id}`"))
            .collect();
        if !unnamed.is_empty() {
            let message = format!(
                "{} names no frames; it is taken that it {}",
                self.form,
                unnamed.join(" and ")
            );
            warnings.push(Warning::new(WarningCode::TransformFramesAssumed, message));
        }
        let length_m = self.isometry.translation.vector.norm();
        if length_m > FAR_M {
            let message = format!(
                "the camera is {length_m:.1} m away from {}; give metres, if that are millimetres",
                if self.leads_to_flange() {
                    "the flange"
                } else {
                    "its robot"
                }
            );
            warnings.push(Warning::new(WarningCode::CameraFarFromRobot, message));
        }
        let name =
            |own: &Option<String>, other: &str| own.clone().unwrap_or_else(|| other.to_owned());
        let named = NamedTransform {
            covariance: self.covariance,
            ..NamedTransform::new(
                Transform::from_isometry(&self.isometry)?,
                name(&self.to, to),
                name(&self.from, from),
            )
        };
        Ok(WithWarnings::new(named, warnings))
    }

    fn of<To: FrameTag, From: FrameTag>(
        named: NamedTransform<To, From>,
        form: &'static str,
        says_flange: bool,
    ) -> Self {
        let id = |id: String| (id != UNNAMED).then_some(id);
        Self {
            isometry: named.transform.isometry(),
            covariance: named.covariance,
            to: id(named.to),
            from: id(named.from),
            form,
            says_flange,
        }
    }
}

/// Words that name the end of an arm, in ids such as `tool0`, `panda_hand` or `end_effector_link`.
const FLANGE_WORDS: [&str; 10] = [
    "flange",
    "tool",
    "tcp",
    "ee",
    "eef",
    "effector",
    "endeffector",
    "gripper",
    "hand",
    "wrist",
];
/// Words that name its base, also beside one of the others (`hand_base_link` is neither).
const BASE_WORDS: [&str; 3] = ["base", "world", "map"];

fn is_flange_name(id: &str) -> bool {
    let id = id.to_ascii_lowercase();
    let words = || {
        id.split(|c: char| !c.is_ascii_alphanumeric())
            .map(|word| word.trim_end_matches(|c: char| c.is_ascii_digit()))
    };
    words().any(|word| FLANGE_WORDS.contains(&word))
        && !words().any(|word| BASE_WORDS.contains(&word))
}

fn parse(bytes: &[u8]) -> Result<AnyTransform, TransformContentError> {
    let text = std::str::from_utf8(bytes).map_err(|e| TransformContentError::Form {
        place: format!("byte {}", e.valid_up_to()),
        problem: "not UTF-8 text".to_owned(),
    })?;
    let text = text.trim_start_matches('\u{feff}').trim();
    // A file of ours names its schema; what names another is none of the other forms either.
    if text.starts_with('{') {
        let has_schema = serde_json::from_str::<serde_json::Value>(text)
            .ok()
            .is_none_or(|value| value.get("schema").is_some());
        if has_schema {
            return own(text.as_bytes());
        }
    }
    foreign(text).map_err(|e| TransformContentError::Foreign {
        message: e.to_string(),
    })
}

/// pomona's own form, whatever it leads to.
fn own(bytes: &[u8]) -> Result<AnyTransform, TransformContentError> {
    let (named, to_kind) = json::parse_any::<FlangeFrame, FlangeFrame>(bytes)?;
    let says_flange = to_kind.is_some_and(|kind| kind == FlangeFrame::NAME);
    Ok(AnyTransform::of(named, "the file", says_flange))
}

fn foreign(text: &str) -> Result<AnyTransform, FormatError> {
    type Any = NamedTransform<FlangeFrame, FlangeFrame>;
    let has = |words: &[&str]| words.iter().any(|word| text.contains(word));
    if text.starts_with('<') {
        let named: Any = from_urdf_origin(text, UNNAMED, UNNAMED)?;
        return Ok(AnyTransform::of(named, "URDF", false));
    }
    if text.starts_with("--") || has(&["static_transform_publisher"]) {
        let named: Any = from_static_transform_arguments(text)?;
        return Ok(AnyTransform::of(named, "static_transform_publisher", false));
    }
    if text.starts_with("%YAML") || has(&["opencv-matrix"]) {
        let named: Any = from_opencv_yaml(text, UNNAMED, UNNAMED)?;
        return Ok(AnyTransform::of(named, "OpenCV's FileStorage", false));
    }
    if has(&["eye_on_hand", "calibration_type", "robot_effector_frame"]) {
        let (named, hand_eye): (Any, _) = from_easy_handeye(text)?;
        let in_hand = hand_eye == HandEyeType::EyeInHand;
        return Ok(AnyTransform::of(named, "easy_handeye", in_hand));
    }
    if has(&["translation", "Translation"]) {
        let named: Any = from_stamped(text, UNNAMED, UNNAMED)?;
        return Ok(AnyTransform::of(named, "the transform", false));
    }
    let named: Any = from_matrix_text(text, UNNAMED, UNNAMED)?;
    Ok(AnyTransform::of(named, "a matrix", false))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{CameraFrame, RobotFrame};

    fn read(text: &str) -> Result<AnyTransform, String> {
        parse(text.as_bytes()).map_err(|e| e.to_string())
    }

    const EASY_HANDEYE: &str = "parameters:\n  eye_on_hand: false\n  robot_base_frame: base_link\n  robot_effector_frame: tool0\n\
        \x20 tracking_base_frame: optical\ntransformation: {x: 0.3, y: -0.1, z: 1.2, qx: -0.5, qy: 0.5, qz: -0.5, qw: 0.5}\n";
    const OWN: &str = r#"{"schema": "pomona.transform/1", "to": "base_link", "from": "optical",
        "translation_m": [0.3, -0.1, 1.2], "quaternion_xyzw": [-0.5, 0.5, -0.5, 0.5]}"#;
    const STAMPED: &str = "header:\n  frame_id: base_link\nchild_frame_id: optical\ntransform:\n\
        \x20 translation: {x: 0.3, y: -0.1, z: 1.2}\n  rotation: {x: -0.5, y: 0.5, z: -0.5, w: 0.5}\n---\n";
    const ARGUMENTS: &str = "ros2 run tf2_ros static_transform_publisher --x 0.3 --y -0.1 --z 1.2 --qx -0.5 --qy 0.5 --qz -0.5 \
        --qw 0.5 --frame-id base_link --child-frame-id optical";
    const MATRIX: &str = "# robot from camera\n0 0 1 0.3\n-1 0 0 -0.1\n0 -1 0 1.2\n0 0 0 1\n";
    const NUMPY: &str = "[[0., 0., 1., 0.3],\n [-1., 0., 0., -0.1],\n [0., -1., 0., 1.2]]\n";
    const ECHO: &str = "At time 12.5\n- Translation: [0.300, -0.100, 1.200]\n- Rotation: in Quaternion [-0.500, 0.500, -0.500, 0.500]\n\
        \x20           in RPY (radian) [-1.571, 0.000, -1.571]\n";
    const BARE: &str = "transform:\n  translation: {x: 0.3, y: -0.1, z: 1.2}\n  rotation: {x: -0.5, y: 0.5, z: -0.5, w: 0.5}\n";
    const BARE_JSON: &str = r#"{"translation": {"x": 0.3, "y": -0.1, "z": 1.2}, "rotation": {"x": -0.5, "y": 0.5, "z": -0.5, "w": 0.5}}"#;
    const OPENCV: &str = "%YAML:1.0\n---\nT: !!opencv-matrix\n   rows: 4\n   cols: 4\n   dt: d\n   data: [ 0., 0., 1., 0.3, -1., 0., 0.,\n\
        \x20      -0.1, 0., -1., 0., 1.2, 0., 0., 0., 1. ]\n";
    const URDF: &str = r#"<joint name="camera" type="fixed"><parent link="base_link"/><child link="optical"/>
        <origin xyz="0.3 -0.1 1.2" rpy="-1.5707963267948966 0 -1.5707963267948966"/></joint>"#;

    #[test]
    fn every_form_gives_the_same_transform() {
        let expected = read(OWN).unwrap();
        for (text, has_names) in [
            (EASY_HANDEYE, true),
            (STAMPED, true),
            (ARGUMENTS, true),
            (URDF, true),
            (MATRIX, false),
            (NUMPY, false),
            (ECHO, false),
            (BARE, false),
            (BARE_JSON, false),
            (OPENCV, false),
        ] {
            let found = read(text).unwrap_or_else(|e| panic!("{text}\n{e}"));
            let named = found
                .named::<RobotFrame, CameraFrame>("base_link", "optical")
                .unwrap();
            let own = expected.named::<RobotFrame, CameraFrame>("", "").unwrap();
            let (a, b) = (named.value.transform.matrix(), own.value.transform.matrix());
            assert!((a - b).amax() < 1e-9, "{text}");
            assert_eq!(
                (&named.value.to, &named.value.from),
                (&own.value.to, &own.value.from)
            );
            let codes: Vec<_> = named.warnings.iter().map(|w| w.code).collect();
            let assumed = [WarningCode::TransformFramesAssumed];
            assert_eq!(codes, &assumed[usize::from(has_names)..], "{text}");
            assert!(!found.leads_to_flange(), "{text}");
        }
        assert_eq!(
            expected
                .named::<RobotFrame, CameraFrame>("", "")
                .unwrap()
                .warnings,
            []
        );
    }

    #[test]
    fn the_frame_of_a_flange_is_known_by_what_the_file_says_or_by_its_name() {
        let in_hand = EASY_HANDEYE
            .replace("false", "true")
            .replace("tool0", "link_x");
        assert!(read(&in_hand).unwrap().leads_to_flange());
        let kind = OWN.replace(
            r#""to": "base_link""#,
            r#""to": "link_x", "to_kind": "flange""#,
        );
        assert!(read(&kind).unwrap().leads_to_flange());
        for (name, flange) in [
            ("flange", true),
            ("tool0", true),
            ("panda_hand", true),
            ("end_effector_link", true),
            ("wrist_3_link", true),
            ("base_link", false),
            ("world", false),
            ("gripper_base", false),
            ("handler", false),
        ] {
            assert_eq!(is_flange_name(name), flange, "{name}");
        }
    }

    #[test]
    fn lengths_that_look_like_millimetres_are_doubted_or_refused() {
        let near = OWN.replace("[0.3, -0.1, 1.2]", "[30, -10, 12]");
        let named = read(&near)
            .unwrap()
            .named::<RobotFrame, CameraFrame>("", "")
            .unwrap();
        assert_eq!(named.warnings[0].code, WarningCode::CameraFarFromRobot);
        for text in [OWN, MATRIX, BARE, EASY_HANDEYE] {
            let far = text
                .replace("0.3", "300")
                .replace("-0.1", "-100")
                .replace("1.2", "1200");
            let error = read(&far).unwrap_err();
            assert!(error.contains("millimetres"), "{error}");
        }
    }

    #[test]
    fn what_is_of_no_form_is_refused_with_the_forms() {
        for text in [
            "",
            "hello",
            "1 2 3",
            "{}",
            "[]",
            "a: 1",
            "transform: 3",
            "<x/>",
            "--x",
        ] {
            let error = read(text).unwrap_err();
            assert!(error.contains("; "), "{text}: {error}");
        }
        let other = r#"{"schema": "pomona.picks/1"}"#;
        assert!(read(other).unwrap_err().contains("pomona.transform/1"));
        let skewed = MATRIX.replace("0 0 1 0.3", "0 0.2 1 0.3");
        assert!(read(&skewed).unwrap_err().contains("rotation"));
    }
}
