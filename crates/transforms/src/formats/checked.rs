//! Numbers and names that go in and out of other programs' texts.

use super::error::FormatError;
use crate::schema::excessive_length_m;
use crate::{FrameTag, NamedTransform, Transform};

/// A named transform whose numbers and names have been checked.
pub(super) fn checked<To: FrameTag, From: FrameTag>(
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
    if let Some(length_m) = excessive_length_m(&transform.translation_m()) {
        return Err(FormatError::TooFar { length_m });
    }
    Ok(NamedTransform::new(transform, to, from))
}

pub(super) fn number(text: &str, place: &str, remedy: &'static str) -> Result<f64, FormatError> {
    let number = text.parse().ok().filter(|n: &f64| n.is_finite());
    number.ok_or_else(|| FormatError::new(place, format!("`{text}` is no finite number"), remedy))
}

/// Digits that read back to the same number.
pub(super) fn shown(number: f64) -> String {
    // Adding 0 turns −0 into 0.
    format!("{:?}", number + 0.0)
}
