use super::times::milliseconds;
use crate::detection::{BoxOrigin, DetectionSummary, DetectionTimes, FoundBy, Mark};
use serde::{Deserialize, Serialize};

/// How a box was found, and what depth says about it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct BoxOriginRecord {
    /// What found it.
    pub found_by: FoundBy,
    /// What depth says about it.
    pub mark: Mark,
    /// How many detections were joined in it; absent for one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(range(min = 2)))]
    pub merged: Option<usize>,
}

/// What found a frame's boxes.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[cfg_attr(test, schemars(deny_unknown_fields))]
#[non_exhaustive]
pub struct DetectionSummaryRecord {
    /// Name of the detector or of the model's file.
    pub name: String,
    /// How the model's outputs were read.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub family: Option<String>,
    /// Name of the class that counts, or the names of several.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub class_name: Option<String>,
    /// What ran the network: `onnxruntime` or `embedded`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub runtime: Option<String>,
    /// Version of the runtime.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub version: Option<String>,
    /// The library that was loaded.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub library: Option<String>,
    /// Why a runtime that was preferred did not serve.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fallback_reason: Option<String>,
    /// What was assumed about the model.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[cfg_attr(test, schemars(length(min = 1)))]
    pub notes: Vec<String>,
    /// Boxes that the detector gave.
    pub detections: usize,
    /// Boxes that were joined into others.
    pub merged: usize,
    /// Boxes that depth refuses.
    pub marked: usize,
    /// Apples that only depth shows.
    pub by_depth: usize,
    /// How long each step took.
    pub timing_ms: DetectionTimesRecord,
}

/// Milliseconds of the steps of a frame, from colour to directions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[cfg_attr(test, schemars(deny_unknown_fields))]
#[non_exhaustive]
pub struct DetectionTimesRecord {
    /// The detector, from the colour image to boxes.
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub detector: f64,
    /// Looking at the boxes in depth and joining them.
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub depth_check: f64,
    /// Looking for apples outside of the boxes, where that is asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub depth_search: Option<f64>,
    /// Spheres, branches and directions of all apples; each apple's own timing has more.
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub picking: f64,
    /// All of it.
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub total: f64,
}

impl From<&BoxOrigin> for BoxOriginRecord {
    fn from(origin: &BoxOrigin) -> Self {
        Self {
            found_by: origin.found_by,
            mark: origin.mark,
            merged: (origin.merged > 1).then_some(origin.merged),
        }
    }
}

impl From<&DetectionSummary> for DetectionSummaryRecord {
    fn from(summary: &DetectionSummary) -> Self {
        let detector = &summary.detector;
        let runtime = detector.runtime.as_ref();
        Self {
            name: detector.name.clone(),
            family: detector.family.clone(),
            class_name: detector.class_name.clone(),
            runtime: runtime.map(|r| r.name.clone()),
            version: runtime.map(|r| r.version.clone()),
            library: runtime.and_then(|r| r.library.clone()),
            fallback_reason: runtime.and_then(|r| r.fallback_reason.clone()),
            notes: detector.notes.clone(),
            detections: summary.detections,
            merged: summary.merged,
            marked: summary.marked,
            by_depth: summary.by_depth,
            timing_ms: DetectionTimesRecord::from(&summary.times),
        }
    }
}

impl From<&DetectionTimes> for DetectionTimesRecord {
    fn from(times: &DetectionTimes) -> Self {
        Self {
            detector: milliseconds(times.detector),
            depth_check: milliseconds(times.depth_check),
            depth_search: times.depth_search.map(milliseconds),
            picking: milliseconds(times.picking),
            total: milliseconds(times.total()),
        }
    }
}
