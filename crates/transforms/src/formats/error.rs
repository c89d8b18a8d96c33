use crate::TransformError;
use crate::schema::MAX_TRANSLATION_M;
use thiserror::Error;

/// Why a text of another program is not a transform.
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
    /// The numbers are not a rigid transform.
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
    pub(super) fn new(
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
