//! Parts that several records share, declared elsewhere in crates that know no schemas.

use crate::shapes::Share;
use schemars::JsonSchema;

/// What detected, so that a result can be traced.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct DetectorReport {
    /// Name of the detector or of the model's file.
    pub name: String,
    /// How the model's outputs were read, such as yolox.
    #[schemars(skip_serializing_if = "Option::is_none")]
    pub family: Option<String>,
    /// Name of the class that counts, or the names of several; absent where the model's classes have none.
    #[schemars(skip_serializing_if = "Option::is_none")]
    pub class_name: Option<String>,
    /// The inference backend; absent where none of ours ran.
    #[schemars(skip_serializing_if = "Option::is_none")]
    pub runtime: Option<RuntimeReport>,
    /// What was assumed about the model, and how to state it.
    #[schemars(skip_serializing_if = "Vec::is_empty")]
    pub notes: Vec<String>,
}

/// What segmented, so that a result can be traced.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct SegmenterReport {
    /// Name of the segmenter or of the model's file.
    pub name: String,
    /// The inference backend; absent where none of ours ran.
    #[schemars(skip_serializing_if = "Option::is_none")]
    pub runtime: Option<RuntimeReport>,
    /// What was assumed about the model, and how to state it.
    #[schemars(skip_serializing_if = "Vec::is_empty")]
    pub notes: Vec<String>,
}

/// The inference backend that ran the network.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct RuntimeReport {
    /// onnxruntime or embedded.
    pub name: String,
    /// Its version.
    pub version: String,
    /// The library that was loaded; absent for the embedded one.
    #[schemars(skip_serializing_if = "Option::is_none")]
    pub library: Option<String>,
    /// Why a backend that was preferred could not be used; absent where none was.
    #[schemars(skip_serializing_if = "Option::is_none")]
    pub fallback_reason: Option<String>,
}

/// A share of a whole with its 95 % Wilson interval.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Proportion {
    /// How many.
    pub count: usize,
    /// Of how many.
    pub of: usize,
    /// The one over the other; 0 of nothing.
    #[schemars(with = "Share")]
    pub share: f64,
    /// Lower end of the interval; 0 of nothing.
    #[schemars(with = "Share")]
    pub low: f64,
    /// Upper end of the interval; 1 of nothing.
    #[schemars(with = "Share")]
    pub high: f64,
}
