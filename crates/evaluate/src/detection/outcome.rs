use super::matching::{Label, Outcome, match_detections};
use super::ranked::OVERLAPS;
use pomona_cloud::{LabelKind, LabelledBox};
use pomona_detect::Detection;

/// What a detector said of one image, set beside its labels.
#[derive(Clone, Debug, PartialEq)]
pub struct ImageOutcome {
    /// The labels.
    pub labels: Vec<Label>,
    /// The detections, as they came.
    pub detections: Vec<Detection>,
    /// What became of each detection, for each of the overlaps 0.50, 0.55, … 0.95 that are asked of a hit.
    pub outcomes: Vec<Vec<Outcome>>,
}

impl ImageOutcome {
    /// Joins the detections of an image with its labels at every overlap.
    pub fn new(labels: &[LabelledBox], detections: Vec<Detection>) -> Self {
        let labels: Vec<Label> = labels
            .iter()
            .map(|label| Label::new(&label.bounds, label.kind))
            .collect();
        let outcomes = OVERLAPS
            .iter()
            .map(|&least| match_detections(&detections, &labels, least))
            .collect();
        Self {
            labels,
            detections,
            outcomes,
        }
    }

    /// How many labels have to be found.
    pub fn label_count(&self) -> usize {
        self.labels.iter().filter(|label| label.counts()).count()
    }

    /// Which labels a detection of at least this score finds at an overlap of 0.5, with that overlap.
    pub fn found(&self, threshold: f64) -> Vec<Option<f64>> {
        let mut found = vec![None; self.labels.len()];
        for (detection, outcome) in self.detections.iter().zip(&self.outcomes[0]) {
            if let Outcome::Hit { label, overlap } = *outcome
                && detection.score >= threshold
            {
                found[label] = Some(overlap);
            }
        }
        found
    }

    /// The labels that no detection of at least this score finds at an overlap of 0.5.
    pub fn missed(&self, threshold: f64) -> Vec<Label> {
        let found = self.found(threshold);
        let labels = self.labels.iter().zip(found);
        let missed =
            labels.filter(|(label, found)| label.kind == LabelKind::Object && found.is_none());
        missed.map(|(label, _)| *label).collect()
    }

    /// The detections of at least this score with this fate at an overlap of 0.5.
    fn with(&self, threshold: f64, fate: fn(&Outcome) -> bool) -> Vec<Detection> {
        let pairs = self.detections.iter().zip(&self.outcomes[0]);
        let chosen = pairs.filter(|(d, outcome)| d.score >= threshold && fate(outcome));
        chosen.map(|(d, _)| *d).collect()
    }

    /// The detections of at least this score that find a label.
    pub fn hits(&self, threshold: f64) -> Vec<Detection> {
        self.with(threshold, |outcome| matches!(outcome, Outcome::Hit { .. }))
    }

    /// The detections of at least this score that find nothing.
    pub fn further(&self, threshold: f64) -> Vec<Detection> {
        self.with(threshold, |outcome| matches!(outcome, Outcome::Further))
    }
}
