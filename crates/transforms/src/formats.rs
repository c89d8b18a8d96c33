//! Transforms in the forms of other programs.
//!
//! Each form tells which way round its quaternion is and in which order its angles are, here by its
//! fields' names; lengths are metres, angles radians in all of them.

mod easy_handeye;
mod opencv;
mod static_transform;
mod urdf;

pub use easy_handeye::{HandEyeType, from_easy_handeye, to_easy_handeye};
pub use opencv::{from_opencv_yaml, to_opencv_yaml};
pub use static_transform::{
    StaticTransformForm, from_static_transform_arguments, to_static_transform_arguments,
};
pub use urdf::{from_urdf_origin, to_urdf_joint, to_urdf_origin};

use crate::{FrameTag, MAX_TRANSLATION_M, NamedTransform, Transform, TransformError};
use thiserror::Error;

/// Why a text of another program is no transform.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum FormatError {
    /// The text is not of the form.
    #[error("{place}: {problem}; {remedy}")]
    Form {
        /// Where in the text.
        place: String,
        /// What is wrong there.
        problem: String,
        /// What to do about it.
        remedy: &'static str,
    },
    /// The numbers are no rigid transform.
    #[error(transparent)]
    Numbers(#[from] TransformError),
    /// A translation so long that its unit is not metres.
    #[error(
        "the translation is {length_m:.1} m long, more than {MAX_TRANSLATION_M} m; give metres: it looks like millimetres"
    )]
    TooFar {
        /// Its length, taken as metres.
        length_m: f64,
    },
}

impl FormatError {
    fn new(
        place: impl Into<String>,
        problem: impl std::fmt::Display,
        remedy: &'static str,
    ) -> Self {
        Self::Form {
            place: place.into(),
            problem: format!("{problem}"),
            remedy,
        }
    }
}

/// A named transform whose numbers and names have been checked.
fn checked<To: FrameTag, From: FrameTag>(
    transform: Transform<To, From>,
    to: &str,
    from: &str,
    remedy: &'static str,
) -> Result<NamedTransform<To, From>, FormatError> {
    for (place, id) in [("destination frame", to), ("source frame", from)] {
        if id.trim().is_empty() {
            return Err(FormatError::new(place, "its name is empty", remedy));
        }
    }
    let t = transform.translation_m();
    let length_m = t.x.hypot(t.y).hypot(t.z);
    if !(length_m <= MAX_TRANSLATION_M) {
        return Err(FormatError::TooFar { length_m });
    }
    Ok(NamedTransform::new(transform, to, from))
}

fn number(text: &str, place: &str, remedy: &'static str) -> Result<f64, FormatError> {
    let number = text.parse().ok().filter(|n: &f64| n.is_finite());
    number.ok_or_else(|| FormatError::new(place, format!("`{text}` is no finite number"), remedy))
}

/// Digits that read back to the same number.
fn shown(number: f64) -> String {
    // Adding 0 turns −0 into 0.
    format!("{:?}", number + 0.0)
}
