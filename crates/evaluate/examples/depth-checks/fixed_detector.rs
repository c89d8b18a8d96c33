use pomona::{CheckedFrame, Config, DetectedApples, PickError, find_apples};
use pomona_cloud::{ColorImage, Frame};
use pomona_detect::{DetectError, Detection, Detector, DetectorReport};

/// A detector that always gives the same boxes: what a truth or a box file says, in place of a network.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct FixedDetector {
    /// What it gives.
    pub(crate) detections: Vec<Detection>,
}

impl Detector for FixedDetector {
    fn detect(&self, _: &ColorImage) -> Result<Vec<Detection>, DetectError> {
        Ok(self.detections.clone())
    }

    fn report(&self) -> DetectorReport {
        DetectorReport::new("fixed")
    }
}

/// What depth says of these detections.
pub(crate) fn find(
    frame: &Frame,
    detections: Vec<Detection>,
    config: &Config,
) -> Result<DetectedApples, PickError> {
    let frame = CheckedFrame::new(frame)?;
    find_apples(&frame, &FixedDetector { detections }, config)
}
