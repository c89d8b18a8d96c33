use super::mark::Mark;
use pomona_detect::DetectorReport;
use serde::{Deserialize, Serialize};

/// What found an apple.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum FoundBy {
    /// A detector in the colour image.
    Color,
    /// The search in depth.
    Depth,
}

impl FoundBy {
    /// Its name in `picks.json`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Color => "color",
            Self::Depth => "depth",
        }
    }
}

/// How a box was found, and what depth says about it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct FoundRecord {
    /// What found it.
    pub found_by: FoundBy,
    /// What depth says about it.
    pub mark: Mark,
    /// How many detections were joined in it; absent for one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub merged: Option<usize>,
}

/// What found a frame's boxes.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct DetectionRecord {
    /// Name of the detector or of the model's file.
    pub name: String,
    /// How the model's outputs were read.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub family: Option<String>,
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
    pub timing_ms: DetectionTiming,
}

/// Milliseconds of the steps of a frame, from colour to directions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct DetectionTiming {
    /// The detector, from the colour image to boxes.
    pub detector: f64,
    /// Looking at the boxes in depth and joining them.
    pub depth_check: f64,
    /// Looking for apples outside of the boxes, where that is asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub depth_search: Option<f64>,
    /// Spheres, branches and directions of all apples; each apple's own timing has more.
    pub picking: f64,
    /// All of it.
    pub total: f64,
}

impl DetectionRecord {
    pub(super) fn of(report: &DetectorReport) -> Self {
        let runtime = report.runtime.as_ref();
        Self {
            name: report.name.clone(),
            family: report.family.clone(),
            runtime: runtime.map(|r| r.name.clone()),
            version: runtime.map(|r| r.version.clone()),
            library: runtime.and_then(|r| r.library.clone()),
            fallback_reason: runtime.and_then(|r| r.fallback_reason.clone()),
            notes: report.notes.clone(),
            ..Self::default()
        }
    }

    /// Adds what came after the boxes.
    pub(crate) fn add_picking(&mut self, milliseconds: f64) {
        let timing = &mut self.timing_ms;
        timing.picking = milliseconds;
        timing.total = timing.detector
            + timing.depth_check
            + timing.depth_search.unwrap_or(0.0)
            + milliseconds;
    }
}
