use super::apple::{AppleAnswer, Evidence};
use crate::config::Method;
use crate::detection::DetectionSummary;
use pomona_files::Warning;

/// The answers for a frame.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct FrameAnswer {
    /// The method that was asked for the directions.
    pub method: Method,
    /// Seed of the run.
    pub seed: u64,
    /// Id of the frame: the name of its folder.
    pub id: String,
    /// Name of the coordinate frame of positions and directions: the camera's.
    pub camera_frame_id: String,
    /// What found the boxes; `None` where they came with the frame or in a file.
    pub detection: Option<DetectionSummary>,
    /// What was assumed about the frame, or is doubtful about it.
    pub warnings: Vec<Warning>,
    /// One entry for each box, in the boxes' order.
    pub apples: Vec<AppleAnswer>,
}

impl FrameAnswer {
    /// The answers for the boxes of frame `id`, in the coordinate frame `camera_frame_id`.
    pub fn new(
        method: Method,
        seed: u64,
        id: impl Into<String>,
        camera_frame_id: impl Into<String>,
        apples: Vec<AppleAnswer>,
    ) -> Self {
        Self {
            method,
            seed,
            id: id.into(),
            camera_frame_id: camera_frame_id.into(),
            detection: None,
            warnings: Vec::new(),
            apples,
        }
    }

    /// The same without the pixels that support the answers, which take far more memory than the rest.
    #[must_use]
    pub fn without_evidence(mut self) -> Self {
        for apple in &mut self.apples {
            apple.evidence = Evidence::default();
        }
        self
    }

    /// The apples that have a direction.
    pub fn picked(&self) -> impl Iterator<Item = &AppleAnswer> {
        self.apples.iter().filter(|apple| apple.is_picked())
    }
}
