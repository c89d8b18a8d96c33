//! `geometry_msgs/TransformStamped` as `ros2 topic echo` prints it, and the lines that `tf2_echo` prints.

use super::checked::checked;
use super::error::FormatError;
use crate::{FrameTag, NamedTransform, Transform};
use serde::Deserialize;

const REMEDY: &str = "give translation x y z and rotation x y z w, as `ros2 topic echo` or `tf2_echo` print them, of one transform";

/// How far the norm of a quaternion may be from 1 that is printed with three digits.
const PRINTED_NORM: f64 = 2e-3;

#[derive(Deserialize)]
struct Document {
    #[serde(default)]
    header: Header,
    #[serde(default)]
    child_frame_id: String,
    transform: Option<Rigid>,
    translation: Option<Xyz>,
    rotation: Option<Xyzw>,
    transforms: Option<Vec<Document>>,
}

#[derive(Default, Deserialize)]
struct Header {
    #[serde(default)]
    frame_id: String,
}

#[derive(Deserialize)]
struct Rigid {
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

/// The transform of an echoed message (the first of several, up to `---`), alone or in a list of one, in YAML or JSON; or
/// of the lines `Translation: [x, y, z]` and `in Quaternion [x, y, z, w]`. The header's frame is the destination, the
/// child's the source; `to` and `from` name those that it does not.
///
/// # Errors
///
/// [`FormatError`] for what is no such text, for several transforms, and for what is no rigid transform.
pub fn from_stamped<To: FrameTag, From: FrameTag>(
    text: &str,
    to: &str,
    from: &str,
) -> Result<NamedTransform<To, From>, FormatError> {
    if text.contains("Quaternion") {
        return printed(text, to, from);
    }
    let body = text.strip_prefix("---").unwrap_or(text);
    let body = body.find("\n---").map_or(body, |end| &body[..end]);
    let mut document: Document = serde_saphyr::from_str(body).map_err(|e| {
        let place = e
            .location()
            .map_or_else(|| "YAML".to_owned(), |at| format!("line {}", at.line()));
        FormatError::new(place, e.without_snippet(), REMEDY)
    })?;
    if let Some(transforms) = document.transforms.take() {
        let count = transforms.len();
        let mut transforms = transforms.into_iter();
        let (Some(only), None) = (transforms.next(), transforms.next()) else {
            let problem = format!("{count} transforms, where one is asked for");
            return Err(FormatError::new("transforms", problem, REMEDY));
        };
        document = only;
    }
    let rigid = match (document.transform, document.translation, document.rotation) {
        (Some(rigid), None, None) => rigid,
        (None, Some(translation), Some(rotation)) => Rigid {
            translation,
            rotation,
        },
        _ => {
            let problem = "there is no translation with a rotation, or two of them";
            return Err(FormatError::new("transform", problem, REMEDY));
        }
    };
    let Rigid {
        translation: t,
        rotation: q,
    } = rigid;
    let transform = Transform::from_quaternion([t.x, t.y, t.z], [q.x, q.y, q.z, q.w])?;
    let or = |own: &str, other: &str| if own.is_empty() { other } else { own }.to_owned();
    let (to, from) = (
        or(&document.header.frame_id, to),
        or(&document.child_frame_id, from),
    );
    checked(transform, &to, &from, REMEDY)
}

/// The lines of `tf2_echo`.
fn printed<To: FrameTag, From: FrameTag>(
    text: &str,
    to: &str,
    from: &str,
) -> Result<NamedTransform<To, From>, FormatError> {
    let [x, y, z] = listed(text, "Translation")?;
    let q: [f64; 4] = listed(text, "Quaternion")?;
    let norm = q.iter().map(|c| c * c).sum::<f64>().sqrt();
    // Printed digits; what is farther off is no unit quaternion, and is refused as such.
    let q = if (norm - 1.0).abs() <= PRINTED_NORM {
        q.map(|c| c / norm)
    } else {
        q
    };
    checked(Transform::from_quaternion([x, y, z], q)?, to, from, REMEDY)
}

/// The numbers in brackets after `word`.
fn listed<const N: usize>(text: &str, word: &str) -> Result<[f64; N], FormatError> {
    let after = text.split_once(word).map_or("", |(_, rest)| rest);
    let line = after.lines().next().unwrap_or_default();
    let inside = line
        .split_once('[')
        .and_then(|(_, rest)| Some(rest.split_once(']')?.0));
    let numbers: Option<Vec<f64>> = inside.and_then(|list| {
        list.split(',')
            .map(|n| n.trim().parse().ok().filter(|n: &f64| n.is_finite()))
            .collect()
    });
    numbers
        .and_then(|list| list.try_into().ok())
        .ok_or_else(|| {
            let problem = format!("no list of {N} numbers follows");
            FormatError::new(word, problem, REMEDY)
        })
}
