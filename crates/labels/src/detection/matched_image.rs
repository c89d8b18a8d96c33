use super::matching::{DetectionMatch, GroundTruthBox, IOU_THRESHOLDS, match_detections};
use pomona_cloud::{LabelKind, LabelledBox};
use pomona_detect::Detection;

/// The detections of one image, matched with its labels.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct MatchedImage {
    /// The labels.
    pub labels: Vec<GroundTruthBox>,
    /// The detections, in the order given.
    pub detections: Vec<Detection>,
    /// The match of each detection, at each of the thresholds 0.50, 0.55, … 0.95 of intersection over union.
    pub matches: Vec<Vec<DetectionMatch>>,
}

impl MatchedImage {
    /// Matches the detections of an image with its labelled boxes at every threshold.
    pub fn new(boxes: &[LabelledBox], detections: Vec<Detection>) -> Self {
        let labels: Vec<GroundTruthBox> = boxes
            .iter()
            .map(|label| GroundTruthBox::new(&label.bounds, label.kind))
            .collect();
        let matches = IOU_THRESHOLDS
            .iter()
            .map(|&least| match_detections(&detections, &labels, least))
            .collect();
        Self {
            labels,
            detections,
            matches,
        }
    }

    /// Number of labels that have to be found.
    pub fn label_count(&self) -> usize {
        self.labels.iter().filter(|label| label.counts()).count()
    }

    /// For each label the intersection over union with the detection of at least this score that finds it, where that
    /// is 0.5 or more.
    pub fn found(&self, threshold: f64) -> Vec<Option<f64>> {
        let mut found = vec![None; self.labels.len()];
        for (detection, of) in self.detections.iter().zip(&self.matches[0]) {
            if let DetectionMatch::TruePositive { label, iou } = *of
                && detection.score >= threshold
            {
                found[label] = Some(iou);
            }
        }
        found
    }

    /// The labels that no detection of at least this score finds at an intersection over union of 0.5.
    pub fn missed(&self, threshold: f64) -> Vec<GroundTruthBox> {
        let found = self.found(threshold);
        let labels = self.labels.iter().zip(found);
        let missed =
            labels.filter(|(label, found)| label.kind == LabelKind::Object && found.is_none());
        missed.map(|(label, _)| *label).collect()
    }

    /// The detections of at least this score whose match at an intersection over union of 0.5 is one of `kind`.
    fn matched(&self, threshold: f64, kind: fn(&DetectionMatch) -> bool) -> Vec<Detection> {
        let pairs = self.detections.iter().zip(&self.matches[0]);
        let chosen = pairs.filter(|(d, of)| d.score >= threshold && kind(of));
        chosen.map(|(d, _)| *d).collect()
    }

    /// The detections of at least this score that find a label.
    pub fn true_positives(&self, threshold: f64) -> Vec<Detection> {
        self.matched(threshold, |of| {
            matches!(of, DetectionMatch::TruePositive { .. })
        })
    }

    /// The detections of at least this score that match no label.
    pub fn false_positives(&self, threshold: f64) -> Vec<Detection> {
        self.matched(threshold, |of| matches!(of, DetectionMatch::FalsePositive))
    }
}
