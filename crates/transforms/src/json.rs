//! The form of a transform's file, and what may be wrong in it.

use crate::{
    CovarianceError, FrameTag, NamedTransform, Transform, TransformError, TransformFileError,
    uncertain,
};
use nalgebra::{Matrix4, Matrix6, Vector3};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::path::Path;

/// Name and version of the form of a transform's file.
pub const SCHEMA: &str = "pomona.transform/1";

/// The longest translation that a file may give, in metres: more than an arm on its platform
/// spans, and less than the same in millimetres, taken for metres.
pub const MAX_TRANSLATION_M: f64 = 100.0;

const REMEDY: &str = "give schema, to, from, and translation_m [x, y, z] with quaternion_xyzw [x, y, z, w], or in their place matrix as four rows of four; and, if known, covariance (perturbation left, order rotation_translation, matrix as six rows of six); nothing else";
const FINITE_REMEDY: &str = "give finite numbers: repeat the calibration, or copy its result again";

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    schema: String,
    to: String,
    from: String,
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

pub(crate) fn parse<To: FrameTag, From: FrameTag>(
    bytes: &[u8],
) -> Result<NamedTransform<To, From>, Fault> {
    let syntax = |e: serde_json::Error| Fault::json(&e, bytes);
    // The schema first: in a file of another one, its fields are not what is wrong.
    let value: Value = serde_json::from_slice(bytes).map_err(syntax)?;
    let found = value.get("schema");
    if found.is_none_or(|s| s != SCHEMA) {
        return Err(Fault::Schema {
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
    Ok(named)
}

pub(crate) fn format<To: FrameTag, From: FrameTag>(
    named: &NamedTransform<To, From>,
) -> Result<String, Fault> {
    check(named, "translation_m")?;
    let document = Document {
        schema: SCHEMA.to_owned(),
        to: named.to.clone(),
        from: named.from.clone(),
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
) -> Result<(), Fault> {
    for (field, id) in [("to", &named.to), ("from", &named.from)] {
        if id.trim().is_empty() {
            return Err(Fault::NoFrameId { field });
        }
    }
    if let Some(covariance) = &named.covariance {
        uncertain::check(covariance).map_err(Fault::Covariance)?;
    }
    let length_m = length(&named.transform.translation_m());
    if !(length_m <= MAX_TRANSLATION_M) {
        return Err(Fault::TooFar {
            field: translation_field,
            length_m,
        });
    }
    Ok(())
}

/// Finite wherever the length itself is, also where squares are not.
fn length(v: &Vector3<f64>) -> f64 {
    v.x.hypot(v.y).hypot(v.z)
}

impl Document {
    /// The transform, and the field that gave its translation.
    fn transform<To: FrameTag, From: FrameTag>(
        &self,
    ) -> Result<(Transform<To, From>, &'static str), Fault> {
        let (rotation, translation) = ("rotation", "translation");
        let (transform, field) = match (self.translation_m, self.quaternion_xyzw, self.matrix) {
            (Some(t), Some(q), None) => (Transform::from_quaternion(t, q), "translation_m"),
            (None, None, Some(rows)) => {
                let matrix = Matrix4::from_fn(|row, column| rows[row][column]);
                (Transform::from_matrix(&matrix), "matrix")
            }
            (_, Some(_), Some(_)) => {
                return Err(Fault::TwoForms {
                    part: rotation,
                    field: "quaternion_xyzw",
                });
            }
            (Some(_), None, Some(_)) => {
                return Err(Fault::TwoForms {
                    part: translation,
                    field: "translation_m",
                });
            }
            (_, None, None) => return Err(Fault::MissingPart { part: rotation }),
            (None, Some(_), None) => return Err(Fault::MissingPart { part: translation }),
        };
        Ok((transform.map_err(Fault::Numbers)?, field))
    }
}

/// What is wrong in a file; it becomes a [`TransformFileError`] where the file's name is known.
#[derive(Debug)]
pub(crate) enum Fault {
    Json {
        line: usize,
        column: usize,
        problem: String,
        remedy: &'static str,
    },
    Schema {
        found: Option<String>,
    },
    NoFrameId {
        field: &'static str,
    },
    MissingPart {
        part: &'static str,
    },
    TwoForms {
        part: &'static str,
        field: &'static str,
    },
    TooFar {
        field: &'static str,
        length_m: f64,
    },
    Covariance(CovarianceError),
    Numbers(TransformError),
}

impl Fault {
    fn json(error: &serde_json::Error, bytes: &[u8]) -> Self {
        let (line, column) = (error.line(), error.column());
        let problem = error.to_string();
        let place = format!(" at line {line} column {column}");
        let problem = problem.strip_suffix(&place).unwrap_or(&problem).to_owned();
        match non_finite_word(bytes, line, column) {
            Some(word) => {
                let problem = format!("{word} is no number of JSON");
                Self::Json {
                    line,
                    column,
                    problem,
                    remedy: FINITE_REMEDY,
                }
            }
            None => Self::Json {
                line,
                column,
                problem,
                remedy: REMEDY,
            },
        }
    }

    pub(crate) fn at(self, path: &Path) -> TransformFileError {
        let path = path.to_owned();
        match self {
            Self::Json {
                line,
                column,
                problem,
                remedy,
            } => TransformFileError::Json {
                path,
                line,
                column,
                problem,
                remedy,
            },
            Self::Schema { found } => TransformFileError::Schema { path, found },
            Self::NoFrameId { field } => TransformFileError::NoFrameId { path, field },
            Self::MissingPart { part } => TransformFileError::MissingPart { path, part },
            Self::TwoForms { part, field } => TransformFileError::TwoForms { path, part, field },
            Self::TooFar { field, length_m } => TransformFileError::TooFar {
                path,
                field,
                length_m,
            },
            Self::Covariance(source) => TransformFileError::Covariance { path, source },
            Self::Numbers(source) => TransformFileError::Numbers { path, source },
        }
    }
}

/// The word at which many programs' JSON is none: they print what is not finite as it is.
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
