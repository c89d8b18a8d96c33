//! A transform's file: JSON of our own schema.

use crate::schema::{SCHEMA, excessive_length_m};
use crate::{
    FlangeFrame, FrameTag, NamedTransform, Transform, TransformContentError, TransformFileError,
    uncertain,
};
use nalgebra::{Matrix4, Matrix6};
use pomona_files::write_atomically;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::path::Path;

const REMEDY: &str = "give schema, to, from, and translation_m [x, y, z] with quaternion_xyzw [x, y, z, w], or in their place matrix as four rows of four; and, if known, covariance (perturbation left, order rotation_translation, matrix as six rows of six); nothing else";
const FINITE_REMEDY: &str = "give finite numbers: repeat the calibration, or copy its result again";

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    schema: String,
    to: String,
    from: String,
    /// The kind of the frame that `to` names, where it is not the robot's base.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    to_kind: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    translation_m: Option<[f64; 3]>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    quaternion_xyzw: Option<[f64; 4]>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    matrix: Option<[[f64; 4]; 4]>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    covariance: Option<CovarianceDocument>,
}

/// The covariance, with the convention beside the numbers: there are four in use.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct CovarianceDocument {
    perturbation: Perturbation,
    order: Order,
    matrix: [[f64; 6]; 6],
}

/// T = Exp(ξ) T̂.
#[derive(Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Perturbation {
    Left,
}

/// ξ = (ω, υ), in radians and metres.
#[derive(Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Order {
    RotationTranslation,
}

impl<To: FrameTag, From: FrameTag> NamedTransform<To, From> {
    /// Reads a transform's file.
    ///
    /// The rotation may be rounded: a quaternion is normalised, and a matrix replaced by the
    /// nearest rotation, where they are off by 1e-3 at most.
    ///
    /// # Errors
    ///
    /// [`TransformFileError::File`]; [`TransformFileError::Content`] for what is not JSON or not of the form above.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, TransformFileError> {
        let path = path.as_ref();
        let bytes = pomona_files::read(path)?;
        parse(&bytes).map_err(|source| at(path, source))
    }

    /// Writes a transform's file, with translation and quaternion, w ≥ 0. The file appears as a
    /// whole or not at all.
    ///
    /// # Errors
    ///
    /// [`TransformFileError::Content`] for what could not be read back; [`TransformFileError::File`].
    pub fn write(&self, path: impl AsRef<Path>) -> Result<(), TransformFileError> {
        let path = path.as_ref();
        let text = format(self).map_err(|source| at(path, source))?;
        write_atomically(path, text.as_bytes())?;
        Ok(())
    }
}

fn at(path: &Path, source: TransformContentError) -> TransformFileError {
    TransformFileError::Content {
        path: path.to_owned(),
        source,
    }
}

fn parse<To: FrameTag, From: FrameTag>(
    bytes: &[u8],
) -> Result<NamedTransform<To, From>, TransformContentError> {
    let (named, to_kind) = parse_any(bytes)?;
    match to_kind {
        Some(found) if found != To::NAME => Err(TransformContentError::OtherKind {
            found,
            expected: To::NAME,
        }),
        _ => Ok(named),
    }
}

/// The transform, and the kind of the frame that it leads to, where the file says it.
pub(crate) fn parse_any<To: FrameTag, From: FrameTag>(
    bytes: &[u8],
) -> Result<(NamedTransform<To, From>, Option<String>), TransformContentError> {
    let syntax = |e: serde_json::Error| json_error(&e, bytes);
    // The schema first: in a file of another one, its fields are not what is wrong.
    let value: Value = serde_json::from_slice(bytes).map_err(syntax)?;
    let found = value.get("schema");
    if found.is_none_or(|s| s != SCHEMA) {
        return Err(TransformContentError::Schema {
            found: found.map(Value::to_string),
        });
    }
    // From the text again, for the line and the column.
    let document: Document = serde_json::from_slice(bytes).map_err(syntax)?;
    let (transform, field) = document.transform()?;
    let covariance = document
        .covariance
        .map(|c| Matrix6::from_fn(|row, column| c.matrix[row][column]));
    let named = NamedTransform {
        covariance,
        ..NamedTransform::new(transform, document.to, document.from)
    };
    check(&named, field)?;
    Ok((named, document.to_kind))
}

fn format<To: FrameTag, From: FrameTag>(
    named: &NamedTransform<To, From>,
) -> Result<String, TransformContentError> {
    check(named, "translation_m")?;
    let document = Document {
        schema: SCHEMA.to_owned(),
        to: named.to.clone(),
        from: named.from.clone(),
        to_kind: (To::NAME == FlangeFrame::NAME).then(|| To::NAME.to_owned()),
        translation_m: Some(named.transform.translation_m().into()),
        quaternion_xyzw: Some(named.transform.quaternion_xyzw()),
        matrix: None,
        covariance: named.covariance.map(|c| CovarianceDocument {
            perturbation: Perturbation::Left,
            order: Order::RotationTranslation,
            matrix: std::array::from_fn(|row| std::array::from_fn(|column| c[(row, column)])),
        }),
    };
    // A struct of numbers and strings always serialises.
    Ok(serde_json::to_string_pretty(&document).unwrap_or_default() + "\n")
}

/// What must hold of a file's content beyond its being a rigid transform.
fn check<To: FrameTag, From: FrameTag>(
    named: &NamedTransform<To, From>,
    translation_field: &'static str,
) -> Result<(), TransformContentError> {
    for (field, id) in [("to", &named.to), ("from", &named.from)] {
        if id.trim().is_empty() {
            return Err(TransformContentError::NoFrameId { field });
        }
    }
    if let Some(covariance) = &named.covariance {
        uncertain::check(covariance)?;
    }
    if let Some(length_m) = excessive_length_m(&named.transform.translation_m()) {
        return Err(TransformContentError::TooFar {
            field: translation_field,
            length_m,
        });
    }
    Ok(())
}

impl Document {
    /// The transform, and the field that gave its translation.
    fn transform<To: FrameTag, From: FrameTag>(
        &self,
    ) -> Result<(Transform<To, From>, &'static str), TransformContentError> {
        let (rotation, translation) = ("rotation", "translation");
        let (transform, field) = match (self.translation_m, self.quaternion_xyzw, self.matrix) {
            (Some(t), Some(q), None) => (Transform::from_quaternion(t, q), "translation_m"),
            (None, None, Some(rows)) => {
                let matrix = Matrix4::from_fn(|row, column| rows[row][column]);
                (Transform::from_matrix(&matrix), "matrix")
            }
            (_, Some(_), Some(_)) => {
                return Err(TransformContentError::TwoForms {
                    part: rotation,
                    field: "quaternion_xyzw",
                });
            }
            (Some(_), None, Some(_)) => {
                return Err(TransformContentError::TwoForms {
                    part: translation,
                    field: "translation_m",
                });
            }
            (_, None, None) => return Err(TransformContentError::MissingPart { part: rotation }),
            (None, Some(_), None) => {
                return Err(TransformContentError::MissingPart { part: translation });
            }
        };
        Ok((transform?, field))
    }
}

/// What the JSON reader found wrong, with the place.
fn json_error(error: &serde_json::Error, bytes: &[u8]) -> TransformContentError {
    let (line, column) = (error.line(), error.column());
    let problem = error.to_string();
    let place = format!(" at line {line} column {column}");
    let problem = problem.strip_suffix(&place).unwrap_or(&problem).to_owned();
    let (problem, remedy) = match non_finite_word(bytes, line, column) {
        Some(word) => (format!("{word} is not a JSON number"), FINITE_REMEDY),
        None => (problem, REMEDY),
    };
    TransformContentError::Json {
        line,
        column,
        problem,
        remedy,
    }
}

/// The non-finite number at which the text stops being JSON; many programs print `NaN` and `inf` all the same.
fn non_finite_word(bytes: &[u8], line: usize, column: usize) -> Option<&'static str> {
    let text = bytes.split(|b| *b == b'\n').nth(line.checked_sub(1)?)?;
    // The parser stops at the word's first letter or its second: `nan` begins as `null` does.
    [1, 2].into_iter().find_map(|back| {
        let start = column.checked_sub(back)?;
        let before = start.checked_sub(1).and_then(|i| text.get(i));
        if before.is_some_and(|b| *b == b'"' || b.is_ascii_alphanumeric()) {
            return None;
        }
        let rest = text.get(start..)?;
        let rest = rest.strip_prefix(b"-").unwrap_or(rest);
        let word = rest.split(|b| !b.is_ascii_alphanumeric()).next()?;
        [
            ("nan", "NaN"),
            ("inf", "infinity"),
            ("infinity", "infinity"),
        ]
        .into_iter()
        .find_map(|(w, name)| word.eq_ignore_ascii_case(w.as_bytes()).then_some(name))
    })
}
