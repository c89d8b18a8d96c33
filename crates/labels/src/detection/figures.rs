use super::matched_image::MatchedImage;
use super::matching::IOU_THRESHOLDS;
use super::ranked::{Ranked, Steps, ranked};

/// A figure of a detector that is given with an interval.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Figure {
    /// Average precision at an intersection over union of 0.5, all points.
    Ap50,
    /// Mean of the average precisions at 0.50 to 0.95, all points.
    Ap50To95,
    /// Best F1.
    F1,
    /// Recall at the threshold.
    Recall,
    /// Precision at the threshold.
    Precision,
}

/// How many they are.
pub(super) const FIGURES: usize = 5;

/// The detections of one source, ranked, so that their figures can be computed for any weights of the images.
pub(super) struct RankedSource {
    /// For each threshold of intersection over union the ranked detections of all images.
    ranked: Vec<Vec<Ranked>>,
    /// Labels of each image.
    labels: Vec<u64>,
    threshold: f64,
}

impl RankedSource {
    pub(super) fn new(images: &[MatchedImage], threshold: f64) -> Self {
        Self {
            ranked: (0..IOU_THRESHOLDS.len())
                .map(|t| ranked(images, t))
                .collect(),
            labels: images
                .iter()
                .map(|image| image.label_count() as u64)
                .collect(),
            threshold,
        }
    }

    /// Every [`Figure`], in order, where image i counts `weights[i]` times; `None` where that leaves no label.
    pub(super) fn figures(&self, weights: &[u64], steps: &mut Steps) -> Option<[f64; FIGURES]> {
        let labels: u64 = self.labels.iter().zip(weights).map(|(n, w)| n * w).sum();
        if labels == 0 {
            return None;
        }
        let (mut ap50, mut ap50_to_95) = (0.0, 0.0);
        for ranked in self.ranked.iter().rev() {
            steps.fill(ranked, |image| weights[image]);
            ap50 = steps.all_points(labels);
            ap50_to_95 += ap50 / IOU_THRESHOLDS.len() as f64;
        }
        // The steps are now those of the lowest threshold.
        let f1 = |&(_, hits, count): &(f64, u64, u64)| 2.0 * hits as f64 / (count + labels) as f64;
        let best_f1 = steps.steps.iter().map(f1).fold(0.0, f64::max);
        let counted = steps
            .steps
            .iter()
            .take_while(|(score, ..)| *score >= self.threshold)
            .last();
        let (hits, count) = counted.map_or((0, 0), |&(_, hits, count)| (hits, count));
        let recall = hits as f64 / labels as f64;
        let precision = if count == 0 {
            0.0
        } else {
            hits as f64 / count as f64
        };
        let mut figures = [0.0; FIGURES];
        for (figure, value) in [
            (Figure::Ap50, ap50),
            (Figure::Ap50To95, ap50_to_95),
            (Figure::F1, best_f1),
            (Figure::Recall, recall),
            (Figure::Precision, precision),
        ] {
            figures[figure as usize] = value;
        }
        Some(figures)
    }
}
