use super::outcome::ImageOutcome;
use super::ranked::{OVERLAPS, Ranked, Steps, ranked};
use super::result::Estimate;
use crate::statistics::{RESAMPLES, below, quantile};
use rand_chacha::ChaCha8Rng;
use rand_core::SeedableRng;
use rayon::prelude::*;

/// How many figures are drawn anew: those of [`Figures`].
pub(super) const FIGURES: usize = 5;

/// AP50 (all points), AP50–95 (all points), best F1, recall and precision at the threshold.
pub(super) type Figures = [f64; FIGURES];

/// The detections of one source, ready to be drawn image by image.
pub(super) struct Drawable {
    /// For each overlap the ranked detections of all images.
    ranked: Vec<Vec<Ranked>>,
    /// Labels of each image.
    labels: Vec<u64>,
    threshold: f64,
}

impl Drawable {
    pub(super) fn new(images: &[ImageOutcome], threshold: f64) -> Self {
        Self {
            ranked: (0..OVERLAPS.len()).map(|o| ranked(images, o)).collect(),
            labels: images
                .iter()
                .map(|image| image.label_count() as u64)
                .collect(),
            threshold,
        }
    }

    /// The figures where image i counts `weights[i]` times; `None` where that leaves no label.
    fn figures(&self, weights: &[u64], steps: &mut Steps) -> Option<Figures> {
        let labels: u64 = self.labels.iter().zip(weights).map(|(n, w)| n * w).sum();
        if labels == 0 {
            return None;
        }
        let mut mean = 0.0;
        let mut first = 0.0;
        for ranked in self.ranked.iter().rev() {
            steps.fill(ranked, |image| weights[image]);
            first = steps.all_points(labels);
            mean += first / OVERLAPS.len() as f64;
        }
        // The steps are now those of the first overlap.
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
        Some([first, mean, best_f1, recall, precision])
    }
}

/// The figures of every source for one draw of the images after the other; the draw is the same for all sources, so that
/// their differences are paired.
pub(super) struct Draws {
    own: Vec<Figures>,
    /// For each draw that holds a label, the figures of each source.
    drawn: Vec<Vec<Figures>>,
}

impl Draws {
    /// Draws as many images as there are, with replacement, again and again. Draw i depends on (seed, i) alone.
    ///
    /// `None` where no image holds a label.
    pub(super) fn new(sources: &[Drawable], seed: u64) -> Option<Self> {
        let images = sources.first()?.labels.len();
        let figures = |weights: &[u64], steps: &mut Steps| -> Option<Vec<Figures>> {
            sources
                .iter()
                .map(|source| source.figures(weights, steps))
                .collect()
        };
        let own = figures(&vec![1; images], &mut Steps::default())?;
        let drawn = (0..RESAMPLES as u64)
            .into_par_iter()
            .map_init(
                || (vec![0; images], Steps::default()),
                |(weights, steps), draw| {
                    let mut rng = ChaCha8Rng::seed_from_u64(seed);
                    rng.set_stream(draw);
                    weights.fill(0);
                    for _ in 0..images {
                        weights[below(&mut rng, images)] += 1;
                    }
                    figures(weights, steps)
                },
            )
            .flatten()
            .collect();
        Some(Self { own, drawn })
    }

    /// One figure of one source with its interval.
    pub(super) fn estimate(&self, source: usize, figure: usize) -> Estimate {
        let drawn = self.drawn.iter().map(|draw| draw[source][figure]).collect();
        interval(self.own[source][figure], drawn)
    }

    /// One figure of `second` less that of `first`.
    pub(super) fn difference(&self, first: usize, second: usize, figure: usize) -> Estimate {
        let less = |of: &Vec<Figures>| of[second][figure] - of[first][figure];
        interval(less(&self.own), self.drawn.iter().map(less).collect())
    }
}

/// 95 % percentile interval.
fn interval(value: f64, mut drawn: Vec<f64>) -> Estimate {
    drawn.sort_by(f64::total_cmp);
    if drawn.is_empty() {
        return Estimate {
            value,
            low: value,
            high: value,
        };
    }
    Estimate {
        value,
        low: quantile(&drawn, 0.025),
        high: quantile(&drawn, 0.975),
    }
}
