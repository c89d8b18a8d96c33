use super::matched_image::MatchedImage;
use super::matching::{DetectionMatch, rank};

/// One detection that counts, among those of all images.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Ranked {
    /// Its score; negative infinity where it is not finite.
    pub(super) score: f64,
    /// Number of its image.
    pub(super) image: usize,
    /// Whether it is a true positive.
    pub(super) hit: bool,
}

/// The detections of all images by descending score, those ignored left out; `threshold` is the index of one of the
/// thresholds of intersection over union.
pub(super) fn ranked(images: &[MatchedImage], threshold: usize) -> Vec<Ranked> {
    let mut all = Vec::new();
    for (number, image) in images.iter().enumerate() {
        let pairs = image.detections.iter().zip(&image.matches[threshold]);
        all.extend(pairs.filter_map(|(detection, of)| {
            let hit = match of {
                DetectionMatch::TruePositive { .. } => true,
                DetectionMatch::FalsePositive => false,
                DetectionMatch::Ignored => return None,
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

/// The steps of a precision–recall curve: cumulative true positives and detections at each score, best first.
///
/// Detections of equal score are one step: their order has no meaning, so that the order of the images does not
/// matter.
#[derive(Clone, Debug, Default)]
pub(super) struct Steps {
    /// Score, and the true positives and all detections of this score or a better one.
    pub(super) steps: Vec<(f64, u64, u64)>,
}

impl Steps {
    /// Computes the steps anew; `weight` is the number of times that an image counts.
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

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn steps(detections: &[(f64, bool)]) -> Steps {
        let mut ranked: Vec<Ranked> = detections
            .iter()
            .map(|&(score, hit)| Ranked {
                score,
                image: 0,
                hit,
            })
            .collect();
        ranked.sort_by(|a, b| b.score.total_cmp(&a.score));
        let mut steps = Steps::default();
        steps.fill(&ranked, |_| 1);
        steps
    }

    /// The best precision at a recall of at least `recall`, by trying every score as a threshold.
    fn best_precision(detections: &[(f64, bool)], labels: u64, recall: f64) -> f64 {
        let mut best = 0.0_f64;
        for &(threshold, _) in detections {
            let counted = || detections.iter().filter(|(score, _)| *score >= threshold);
            let hits = counted().filter(|(_, hit)| *hit).count() as f64;
            // A threshold for rounding: recalls are multiples of 1 / labels.
            if hits / labels as f64 >= recall - 1e-9 {
                best = best.max(hits / counted().count() as f64);
            }
        }
        best
    }

    #[test]
    fn closed_forms() {
        // Hit, miss, hit of two labels: precision 1 up to recall 1/2, then 2/3.
        let found = steps(&[(0.9, true), (0.8, false), (0.7, true)]);
        assert!((found.all_points(2) - (0.5 + 0.5 * 2.0 / 3.0)).abs() < 1e-15);
        // Recalls 0 to 0.50 are 51 points.
        let expected = (51.0 + 50.0 * 2.0 / 3.0) / 101.0;
        assert!((found.at_101(2) - expected).abs() < 1e-15);
        // Of four labels half is never found.
        assert!((found.all_points(4) - (0.25 + 0.25 * 2.0 / 3.0)).abs() < 1e-15);
        for (detections, labels, ap) in [
            (&[(0.5, true)][..], 1, 1.0),
            (&[(0.5, false)], 1, 0.0),
            (&[], 1, 0.0),
        ] {
            let steps = steps(detections);
            assert_eq!(steps.all_points(labels), ap);
            assert_eq!(steps.at_101(labels), ap);
        }
    }

    #[test]
    fn equal_scores_are_one_step_in_any_order() {
        let a = steps(&[(0.5, true), (0.5, false), (0.4, true)]);
        let b = steps(&[(0.5, false), (0.5, true), (0.4, true)]);
        assert_eq!(a.steps, [(0.5, 1, 2), (0.4, 2, 3)]);
        assert_eq!(a.steps, b.steps);
    }

    proptest! {
        #[test]
        fn areas_are_those_by_trying_every_threshold(
            detections in prop::collection::vec((0..20_u8, any::<bool>()), 0..30),
            missed in 0..10_u64,
        ) {
            let detections: Vec<_> = detections
                .iter()
                .map(|&(score, hit)| (f64::from(score) / 20.0, hit))
                .collect();
            let labels = detections.iter().filter(|d| d.1).count() as u64 + missed;
            prop_assume!(labels > 0);
            let steps = steps(&detections);
            // The curve's envelope is constant between two recalls of the form k / labels.
            let all_points: f64 = (1..=labels)
                .map(|k| best_precision(&detections, labels, k as f64 / labels as f64))
                .sum::<f64>() / labels as f64;
            prop_assert!((steps.all_points(labels) - all_points).abs() < 1e-9);
            let at_101: f64 = (0..=100)
                .map(|percent| best_precision(&detections, labels, f64::from(percent) / 100.0))
                .sum::<f64>() / 101.0;
            prop_assert!((steps.at_101(labels) - at_101).abs() < 1e-9);
            prop_assert!((0.0..=1.0 + 1e-12).contains(&steps.all_points(labels)));
        }

        #[test]
        fn a_weight_is_the_image_given_so_often(
            detections in prop::collection::vec((0..20_u8, 0..3_usize, any::<bool>()), 0..20),
            weights in prop::array::uniform3(0..4_u64),
        ) {
            let mut once: Vec<Ranked> = detections
                .iter()
                .map(|&(score, image, hit)| Ranked { score: f64::from(score), image, hit })
                .collect();
            once.sort_by(|a, b| b.score.total_cmp(&a.score));
            let copies = |r: &Ranked| vec![*r; weights[r.image] as usize];
            let copied: Vec<Ranked> = once.iter().flat_map(copies).collect();
            let (mut weighted, mut repeated) = (Steps::default(), Steps::default());
            weighted.fill(&once, |image| weights[image]);
            repeated.fill(&copied, |_| 1);
            // A step of weight 0 repeats the one before it and adds no area.
            weighted.steps.dedup_by_key(|step| step.2);
            prop_assert_eq!(weighted.steps, repeated.steps);
        }
    }
}
