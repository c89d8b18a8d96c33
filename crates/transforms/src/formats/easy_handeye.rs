//! Calibration files of `easy_handeye` and `easy_handeye2`.

use super::checked::{checked, shown};
use super::error::FormatError;
use crate::{FrameTag, NamedTransform, Transform};
use serde::Deserialize;

const REMEDY: &str = "give a calibration file of easy_handeye or easy_handeye2: parameters with the frames, and transform (translation x y z, rotation x y z w) or transformation (x y z qx qy qz qw)";

/// What the camera is fixed to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HandEyeType {
    /// The camera is on the flange.
    EyeInHand,
    /// The camera is fixed in the base frame.
    EyeOnBase,
}

impl HandEyeType {
    fn name(self) -> &'static str {
        match self {
            Self::EyeInHand => "eye_in_hand",
            Self::EyeOnBase => "eye_on_base",
        }
    }
}

#[derive(Deserialize)]
struct Document {
    #[serde(default)]
    parameters: Parameters,
    // easy_handeye wrote some of these beside the transformation.
    #[serde(flatten)]
    beside: Parameters,
    transform: Option<Nested>,
    transformation: Option<Flat>,
}

#[derive(Default, Deserialize)]
struct Parameters {
    calibration_type: Option<String>,
    eye_on_hand: Option<bool>,
    robot_base_frame: Option<String>,
    robot_effector_frame: Option<String>,
    tracking_base_frame: Option<String>,
}

#[derive(Deserialize)]
struct Nested {
    translation: Xyz,
    rotation: Xyzw,
}

#[derive(Deserialize)]
struct Xyz {
    x: f64,
    y: f64,
    z: f64,
}

#[derive(Deserialize)]
struct Xyzw {
    x: f64,
    y: f64,
    z: f64,
    w: f64,
}

#[derive(Deserialize)]
struct Flat {
    x: f64,
    y: f64,
    z: f64,
    qx: f64,
    qy: f64,
    qz: f64,
    qw: f64,
}

/// The file as `easy_handeye2` has it: the destination is the base's frame, or the effector's with
/// [`HandEyeType::EyeInHand`], and the source the tracking base's, which is the camera's.
///
/// `other_frame` is the frame that is not in the transform: the effector's for an eye on the base, the base's for
/// an eye in hand. The rotation is a quaternion with named components.
pub fn to_easy_handeye<To: FrameTag, From: FrameTag>(
    named: &NamedTransform<To, From>,
    hand_eye: HandEyeType,
    name: &str,
    other_frame: &str,
    marker_frame: &str,
) -> String {
    let t: [f64; 3] = named.transform.translation_m().into();
    let q = named.transform.quaternion_xyzw();
    let (base, effector) = match hand_eye {
        HandEyeType::EyeOnBase => (named.to.as_str(), other_frame),
        HandEyeType::EyeInHand => (other_frame, named.to.as_str()),
    };
    // JSON's strings are YAML's as well.
    let quoted = |s: &str| serde_json::Value::from(s).to_string();
    let [x, y, z] = t.map(shown);
    let [qx, qy, qz, qw] = q.map(shown);
    format!(
        "parameters:\n  name: {}\n  calibration_type: {}\n  tracking_base_frame: {}\n  tracking_marker_frame: {}\n  \
         robot_base_frame: {}\n  robot_effector_frame: {}\n  freehand_robot_movement: true\n\
         transform:\n  translation:\n    x: {x}\n    y: {y}\n    z: {z}\n  rotation:\n    x: {qx}\n    y: {qy}\n    z: {qz}\n    w: {qw}\n",
        quoted(name),
        hand_eye.name(),
        quoted(&named.from),
        quoted(marker_frame),
        quoted(base),
        quoted(effector),
    )
}

/// The transform of such a file, and what the camera is fixed to. Both generations are read: `transform` with
/// nested numbers, and `transformation` with flat ones.
///
/// # Errors
///
/// [`FormatError`] for what is no such file, or does not say which frames it joins.
pub fn from_easy_handeye<To: FrameTag, From: FrameTag>(
    text: &str,
) -> Result<(NamedTransform<To, From>, HandEyeType), FormatError> {
    let document: Document = serde_saphyr::from_str(text).map_err(|e| {
        let place = e
            .location()
            .map_or_else(|| "YAML".to_owned(), |at| format!("line {}", at.line()));
        FormatError::new(place, e.without_snippet(), REMEDY)
    })?;
    let (p, b) = (document.parameters, document.beside);
    let kind = p.calibration_type.or(b.calibration_type);
    let on_hand = p.eye_on_hand.or(b.eye_on_hand);
    let hand_eye = match (kind.as_deref(), on_hand) {
        (Some("eye_in_hand" | "eye_on_hand"), _) | (None, Some(true)) => HandEyeType::EyeInHand,
        (Some("eye_on_base"), _) | (None, Some(false)) => HandEyeType::EyeOnBase,
        (Some(other), _) => {
            let problem = format!("`{other}` is neither eye_in_hand nor eye_on_base");
            return Err(FormatError::new("calibration_type", problem, REMEDY));
        }
        (None, None) => {
            return Err(FormatError::new(
                "calibration_type",
                "it is missing",
                REMEDY,
            ));
        }
    };
    let (field, to) = match hand_eye {
        HandEyeType::EyeOnBase => (
            "robot_base_frame",
            p.robot_base_frame.or(b.robot_base_frame),
        ),
        HandEyeType::EyeInHand => (
            "robot_effector_frame",
            p.robot_effector_frame.or(b.robot_effector_frame),
        ),
    };
    let missing = |field: &str| FormatError::new(field, "it is missing", REMEDY);
    let to = to.ok_or_else(|| missing(field))?;
    let from = p.tracking_base_frame.or(b.tracking_base_frame);
    let from = from.ok_or_else(|| missing("tracking_base_frame"))?;
    let (t, q) = match (document.transform, document.transformation) {
        (
            Some(Nested {
                translation: t,
                rotation: q,
            }),
            None,
        ) => ([t.x, t.y, t.z], [q.x, q.y, q.z, q.w]),
        (None, Some(f)) => ([f.x, f.y, f.z], [f.qx, f.qy, f.qz, f.qw]),
        (Some(_), Some(_)) => {
            let problem = "transform and transformation are both given";
            return Err(FormatError::new("transform", problem, REMEDY));
        }
        (None, None) => return Err(missing("transform")),
    };
    let transform = Transform::from_quaternion(t, q)?;
    Ok((checked(transform, &to, &from, REMEDY)?, hand_eye))
}
