use crate::schema::{MAX_TRANSLATION_M, SCHEMA};
use pomona_files::FileError;
use std::path::PathBuf;
use thiserror::Error;

/// Why numbers are not a rigid transform.
///
/// Every message names the field, what is wrong with it, and what to do about it.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum TransformError {
    /// A number that must be finite is not.
    #[error(
        "`{field}` holds a number that is not finite; repeat the calibration, or copy its result again"
    )]
    NotFinite {
        /// Name of the field.
        field: &'static str,
    },
    /// A quaternion whose norm is not 1 within 1e-3.
    #[error(
        "`{field}` has norm {norm} but a rotation's is 1; copy all digits, in the order x y z w"
    )]
    NotUnit {
        /// Name of the field.
        field: &'static str,
        /// Its norm.
        norm: f64,
    },
    /// A matrix whose upper left 3×3 part is not a rotation within 1e-3.
    #[error(
        "`{field}` is {deviation:.2e} away from a rotation in its upper left 3x3 part (at most 1e-3); copy all digits, and leave scaling out"
    )]
    NotOrthonormal {
        /// Name of the field.
        field: &'static str,
        /// Distance to the nearest orthonormal matrix in the spectral norm, or less.
        deviation: f64,
    },
    /// A matrix that contains a reflection.
    #[error(
        "`{field}` mirrors: its upper left 3x3 part has determinant -1, a rotation's is +1; negate the axis that belongs to a left-handed frame"
    )]
    LeftHanded {
        /// Name of the field.
        field: &'static str,
    },
    /// A matrix whose last row is not 0 0 0 1.
    #[error(
        "`{field}` ends with the row {row:?} but must end with [0, 0, 0, 1]; write it row by row, with the translation in the last column"
    )]
    LastRow {
        /// Name of the field.
        field: &'static str,
        /// The row.
        row: [f64; 4],
    },
}

/// Why numbers are not the covariance of a transform.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum CovarianceError {
    /// A number is not finite.
    #[error(
        "the covariance holds a number that is not finite; repeat the calibration, or leave the covariance out"
    )]
    NotFinite,
    /// The matrix is not symmetric.
    #[error(
        "the covariance is {asymmetry:.2e} away from symmetric; copy all digits, or leave the covariance out"
    )]
    NotSymmetric {
        /// Largest difference between an entry and its mirror image.
        asymmetry: f64,
    },
    /// Some combination of the errors would have a negative variance.
    #[error(
        "the covariance has the negative variance {variance:.2e}; copy all digits in rows, or leave the covariance out"
    )]
    NegativeVariance {
        /// The variance, or the least eigenvalue of the correlations.
        variance: f64,
    },
}

/// Why a transform's file could not be read or written.
///
/// Every message names the file, the place in it, and what to do about it.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum TransformFileError {
    /// The operating system refused to read or write the file, for example because there is none.
    #[error(transparent)]
    File(#[from] FileError),
    /// What the file holds, or was to hold, is not a transform.
    #[error("{}: {source}", .path.display())]
    Content {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        source: TransformContentError,
    },
}

/// Why the content of a transform's file is not a transform.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum TransformContentError {
    /// It is not JSON, or not of the schema's form: a field is unknown, missing, given twice or of another type.
    #[error("line {line} column {column}: {problem}; {remedy}")]
    Json {
        /// Line, from 1.
        line: usize,
        /// Column, from 1; 0 where only the line is known.
        column: usize,
        /// What is wrong there.
        problem: String,
        /// What to do about it.
        remedy: &'static str,
    },
    /// It is of another schema, or does not say of which.
    #[error(
        "`schema` is {} but must be \"{SCHEMA}\"; give a transform's file, in that form",
        .found.as_deref().unwrap_or("missing")
    )]
    Schema {
        /// What `schema` holds, as JSON; `None` where there is none.
        found: Option<String>,
    },
    /// It is no text.
    #[error("{place}: {problem}; give a transform's file in a form that `pomona inspect` knows")]
    Form {
        /// Where in the file.
        place: String,
        /// What is wrong there.
        problem: String,
    },
    /// It is of another program's form, or of none.
    #[error("{message}")]
    Foreign {
        /// What is wrong with it: place, problem and remedy.
        message: String,
    },
    /// It leads to another kind of frame: a camera on the flange is not one on the base.
    #[error(
        "it leads to the robot's {found} (`to_kind`), where its {expected} is asked for; give the other transform, or the flange's pose beside it"
    )]
    OtherKind {
        /// What it leads to.
        found: String,
        /// What is asked for.
        expected: &'static str,
    },
    /// A frame's id is empty.
    #[error("`{field}` is empty; name the frame, as the camera's or the robot's programs do")]
    NoFrameId {
        /// `to` or `from`.
        field: &'static str,
    },
    /// There is no rotation, or no translation.
    #[error("there is no {part}; give `translation_m` and `quaternion_xyzw`, or `matrix`")]
    MissingPart {
        /// `rotation` or `translation`.
        part: &'static str,
    },
    /// A rotation, or a translation, is given twice.
    #[error(
        "`{field}` and `matrix` both give the {part}; keep `translation_m` and `quaternion_xyzw`, or `matrix`"
    )]
    TwoForms {
        /// `rotation` or `translation`.
        part: &'static str,
        /// The field beside `matrix`.
        field: &'static str,
    },
    /// A translation so long that its unit is not metres.
    #[error(
        "the translation in `{field}` is {length_m:.1} m long, more than {MAX_TRANSLATION_M} m; give metres: it looks like millimetres"
    )]
    TooFar {
        /// The field that holds it.
        field: &'static str,
        /// Its length, taken as metres.
        length_m: f64,
    },
    /// The numbers are not a covariance.
    #[error(transparent)]
    Covariance(#[from] CovarianceError),
    /// The numbers are not a rigid transform.
    #[error(transparent)]
    Numbers(#[from] TransformError),
}
