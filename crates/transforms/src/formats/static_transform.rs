//! Arguments of ROS's `static_transform_publisher`.

use super::checked::{checked, number, shown};
use super::error::FormatError;
use crate::{EulerZyx, FrameTag, NamedTransform, Transform};

const REMEDY: &str = "give `x y z yaw pitch roll frame_id child_frame_id`, `x y z qx qy qz qw frame_id child_frame_id`, or --x --y --z with --qx --qy --qz --qw or --roll --pitch --yaw, --frame-id and --child-frame-id";

const OPTIONS: [&str; 10] = [
    "x", "y", "z", "qx", "qy", "qz", "qw", "roll", "pitch", "yaw",
];

/// The forms that `static_transform_publisher` has had.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum StaticTransformForm {
    /// `--x … --qx … --frame-id … --child-frame-id …`: ROS 2 since Humble.
    Named,
    /// The same with `--roll --pitch --yaw`.
    NamedAngles,
    /// `x y z qx qy qz qw frame_id child_frame_id`: ROS 1, and ROS 2 with a warning.
    Quaternion,
    /// `x y z yaw pitch roll frame_id child_frame_id`: note the order, yaw first.
    YawPitchRoll,
}

/// The arguments for a transform; `frame_id` is its destination, `child_frame_id` its source, as in TF.
///
/// Quaternions are x y z w. Angles are those of [`EulerZyx`]: roll rx, pitch ry, yaw rz, about fixed axes.
pub fn to_static_transform_arguments<To: FrameTag, From: FrameTag>(
    named: &NamedTransform<To, From>,
    form: StaticTransformForm,
) -> Vec<String> {
    let t: [f64; 3] = named.transform.translation_m().into();
    let q = named.transform.quaternion_xyzw();
    let EulerZyx { rx, ry, rz } = EulerZyx::from_rotation(&named.transform.rotation());
    let pairs = |numbers: &[(&str, f64)]| -> Vec<String> {
        let options = numbers.iter();
        options
            .flat_map(|(name, n)| [format!("--{name}"), shown(*n)])
            .collect()
    };
    let place = [("x", t[0]), ("y", t[1]), ("z", t[2])];
    let mut arguments = match form {
        StaticTransformForm::Named => {
            let turn = [("qx", q[0]), ("qy", q[1]), ("qz", q[2]), ("qw", q[3])];
            [pairs(&place), pairs(&turn)].concat()
        }
        StaticTransformForm::NamedAngles => {
            let turn = [("roll", rx), ("pitch", ry), ("yaw", rz)];
            [pairs(&place), pairs(&turn)].concat()
        }
        StaticTransformForm::Quaternion => t.iter().chain(&q).map(|n| shown(*n)).collect(),
        StaticTransformForm::YawPitchRoll => {
            let turn = [rz, ry, rx];
            t.iter().chain(&turn).map(|n| shown(*n)).collect()
        }
    };
    let named_form = matches!(
        form,
        StaticTransformForm::Named | StaticTransformForm::NamedAngles
    );
    if named_form {
        arguments.extend(["--frame-id".into(), named.to.clone()]);
        arguments.extend(["--child-frame-id".into(), named.from.clone()]);
    } else {
        arguments.extend([named.to.clone(), named.from.clone()]);
    }
    arguments
}

/// The transform of arguments in any of the forms; what is not given is 0, as for the publisher. A
/// period in milliseconds after the frames, as ROS 1 has it, is passed over, and so are leading words
/// without a number up to `static_transform_publisher`.
///
/// # Errors
///
/// [`FormatError`]; angles and quaternion given both, numbers or frames missing.
pub fn from_static_transform_arguments<To: FrameTag, From: FrameTag>(
    arguments: &str,
) -> Result<NamedTransform<To, From>, FormatError> {
    let mut words: Vec<&str> = arguments.split_whitespace().collect();
    let own_name = words
        .iter()
        .position(|w| w.ends_with("static_transform_publisher"));
    if let Some(at) = own_name {
        words.drain(..=at);
    }
    if words.iter().any(|w| is_option(w)) {
        named_form(&words)
    } else {
        positional(&words)
    }
}

fn is_option(word: &str) -> bool {
    word.starts_with("--")
}

fn positional<To: FrameTag, From: FrameTag>(
    words: &[&str],
) -> Result<NamedTransform<To, From>, FormatError> {
    let is_number = |w: &&str| w.parse::<f64>().is_ok();
    let leading = words.iter().take_while(|w| is_number(w)).count();
    let numbers = words[..leading].iter().enumerate();
    let numbers: Vec<f64> = numbers
        .map(|(i, w)| number(w, &format!("argument {}", i + 1), REMEDY))
        .collect::<Result<_, _>>()?;
    let [frame, child] = match words[leading..] {
        [frame, child] => [frame, child],
        [frame, child, period] if is_number(&period) => [frame, child],
        _ => {
            let problem = "the two frames do not follow the numbers";
            return Err(FormatError::new("arguments", problem, REMEDY));
        }
    };
    let transform = match numbers[..] {
        [x, y, z, qx, qy, qz, qw] => Transform::from_quaternion([x, y, z], [qx, qy, qz, qw])?,
        [x, y, z, rz, ry, rx] => with_angles([x, y, z], EulerZyx { rx, ry, rz })?,
        _ => {
            let problem = format!("{leading} numbers stand before the frames, 6 or 7 must");
            return Err(FormatError::new("arguments", problem, REMEDY));
        }
    };
    checked(transform, frame, child, REMEDY)
}

fn named_form<To: FrameTag, From: FrameTag>(
    words: &[&str],
) -> Result<NamedTransform<To, From>, FormatError> {
    let mut numbers: [Option<f64>; 10] = [None; 10];
    let mut frames: [Option<&str>; 2] = [None; 2];
    let mut rest = words.iter();
    while let Some(&word) = rest.next() {
        let (name, value) = match word.split_once('=') {
            Some((name, value)) => (name, value),
            None => match rest.next() {
                Some(&value) => (word, value),
                None => return Err(FormatError::new(word, "its value is missing", REMEDY)),
            },
        };
        let bare = name.strip_prefix("--").unwrap_or(name);
        let twice = || FormatError::new(name, "it is given twice", REMEDY);
        if let Some(at) = OPTIONS.iter().position(|o| *o == bare) {
            if numbers[at].replace(number(value, name, REMEDY)?).is_some() {
                return Err(twice());
            }
        } else if let Some(at) = ["frame-id", "child-frame-id"]
            .iter()
            .position(|o| *o == bare)
        {
            if frames[at].replace(value).is_some() {
                return Err(twice());
            }
        } else {
            return Err(FormatError::new(name, "it is no option", REMEDY));
        }
    }
    let [Some(frame), Some(child)] = frames else {
        return Err(FormatError::new("arguments", "a frame is missing", REMEDY));
    };
    let n = numbers.map(|n| n.unwrap_or(0.0));
    let (by_quaternion, by_angles) = (
        numbers[3..7].iter().any(Option::is_some),
        numbers[7..].iter().any(Option::is_some),
    );
    let transform = match (by_quaternion, by_angles) {
        (true, true) => {
            let problem = "a quaternion and angles are given";
            return Err(FormatError::new("arguments", problem, REMEDY));
        }
        (true, false) => Transform::from_quaternion([n[0], n[1], n[2]], [n[3], n[4], n[5], n[6]])?,
        (false, _) => {
            let angles = EulerZyx {
                rx: n[7],
                ry: n[8],
                rz: n[9],
            };
            with_angles([n[0], n[1], n[2]], angles)?
        }
    };
    checked(transform, frame, child, REMEDY)
}

pub(super) fn with_angles<To: FrameTag, From: FrameTag>(
    translation_m: [f64; 3],
    angles: EulerZyx,
) -> Result<Transform<To, From>, FormatError> {
    let quaternion: [f64; 4] = angles.rotation().coords.into();
    Ok(Transform::from_quaternion(translation_m, quaternion)?)
}
