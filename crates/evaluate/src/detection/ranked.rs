use super::matching::{Outcome, rank};
use super::outcome::ImageOutcome;

/// The overlaps (intersection over union) that COCO asks of a hit.
pub(super) const OVERLAPS: [f64; 10] = [0.50, 0.55, 0.60, 0.65, 0.70, 0.75, 0.80, 0.85, 0.90, 0.95];

/// One detection that is a hit or a further one, among those of all images.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Ranked {
    pub(super) score: f64,
    pub(super) image: usize,
    pub(super) hit: bool,
}

/// The detections of all images at one overlap, ignored ones left out, the best first.
pub(super) fn ranked(images: &[ImageOutcome], overlap: usize) -> Vec<Ranked> {
    let mut all = Vec::new();
    for (number, image) in images.iter().enumerate() {
        let pairs = image.detections.iter().zip(&image.outcomes[overlap]);
        all.extend(pairs.filter_map(|(detection, outcome)| {
            let hit = match outcome {
                Outcome::Hit { .. } => true,
                Outcome::Further => false,
                Outcome::Ignored => return None,
            };
            Some(Ranked {
                score: rank(detection.score),
                image: number,
                hit,
            })
        }));
    }
    all.sort_by(|a, b| b.score.total_cmp(&a.score));
    all
}

/// What average precision is computed from: hits and detections so far at each score, best first.
///
/// Detections of equal score are one step: no order among them has a meaning, and so the order of the images
/// decides nothing. `weights` says how often each image is drawn.
#[derive(Clone, Debug, Default)]
pub(super) struct Steps {
    /// Score, hits, and detections with this score or a better one.
    pub(super) steps: Vec<(f64, u64, u64)>,
}

impl Steps {
    /// Fills the steps anew.
    pub(super) fn fill(&mut self, ranked: &[Ranked], weight: impl Fn(usize) -> u64) {
        self.steps.clear();
        let (mut hits, mut count) = (0, 0);
        for (index, detection) in ranked.iter().enumerate() {
            let weight = weight(detection.image);
            count += weight;
            hits += weight * u64::from(detection.hit);
            let last = ranked
                .get(index + 1)
                .is_none_or(|next| next.score != detection.score);
            if last && count > 0 {
                self.steps.push((detection.score, hits, count));
            }
        }
    }

    /// Area below the curve whose precision at each recall is the best at that recall or beyond: Everingham et
    /// al. 2015, "The PASCAL Visual Object Classes Challenge: A Retrospective", the measure from 2010 on.
    pub(super) fn all_points(&self, labels: u64) -> f64 {
        let (mut best, mut area) = (0.0_f64, 0.0);
        for (at, &(_, hits, count)) in self.steps.iter().enumerate().rev() {
            best = best.max(hits as f64 / count as f64);
            let before = if at == 0 { 0 } else { self.steps[at - 1].1 };
            area += best * (hits - before) as f64;
        }
        area / labels as f64
    }

    /// Mean of that precision at the recalls 0, 0.01, … 1, as COCO's own program has it.
    pub(super) fn at_101(&self, labels: u64) -> f64 {
        let (mut best, mut sum) = (0.0_f64, 0.0);
        let mut steps = self.steps.iter().rev().peekable();
        for percent in (0..=100_u64).rev() {
            // A recall of percent / 100 and more, in whole numbers: no rounding decides.
            while let Some((_, hits, count)) =
                steps.next_if(|(_, hits, _)| 100 * hits >= percent * labels)
            {
                best = best.max(*hits as f64 / *count as f64);
            }
            sum += best;
        }
        sum / 101.0
    }
}
