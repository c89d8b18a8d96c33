use pomona_detect::DetectorReport;
use std::time::Duration;

/// What found a frame's boxes, and what became of them.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct DetectionSummary {
    /// The detector.
    pub detector: DetectorReport,
    /// Number of boxes that the detector gave.
    pub detections: usize,
    /// Number of boxes that were joined into others.
    pub merged: usize,
    /// Number of boxes that depth refuses.
    pub marked: usize,
    /// Number of apples that only depth shows.
    pub by_depth: usize,
    /// How long each step took.
    pub times: DetectionTimes,
}

/// The times of a frame's steps, from colour to directions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct DetectionTimes {
    /// The detector, from the colour image to boxes.
    pub detector: Duration,
    /// Checking the boxes against depth and joining them.
    pub depth_check: Duration,
    /// Looking for apples outside of the boxes, where that is asked for.
    pub depth_search: Option<Duration>,
    /// Spheres, branches and directions of all apples; each apple's own times have more.
    pub picking: Duration,
}

impl DetectionTimes {
    /// All of it.
    pub fn total(&self) -> Duration {
        self.detector + self.depth_check + self.depth_search.unwrap_or_default() + self.picking
    }
}
