use super::mark::Mark;
use serde::{Deserialize, Serialize};

/// What found an apple.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
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

/// How a detector's box was found, and what depth says about it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct BoxOrigin {
    /// What found it.
    pub found_by: FoundBy,
    /// What depth says about it.
    pub mark: Mark,
    /// Number of detections that were joined in it, at least 1.
    pub merged: usize,
}

impl BoxOrigin {
    /// A box of one detection.
    pub fn new(found_by: FoundBy, mark: Mark) -> Self {
        Self {
            found_by,
            mark,
            merged: 1,
        }
    }
}
