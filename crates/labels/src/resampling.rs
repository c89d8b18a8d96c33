//! Figures of several sources over the same images, with paired intervals.

use pomona_statistics::{RESAMPLES, draw_counts, percentile_interval};
use rand_chacha::ChaCha8Rng;
use rand_core::SeedableRng;
use rayon::prelude::*;
use serde::Serialize;

/// A figure with its 95 % interval: percentile bootstrap over images, or over the photographs that they are cut from.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema), schemars(deny_unknown_fields))]
#[non_exhaustive]
pub struct Estimate {
    /// The figure.
    pub value: f64,
    /// Lower end of the interval.
    pub low: f64,
    /// Upper end of the interval.
    pub high: f64,
}

impl Estimate {
    /// The figure with the interval of its resamples, or no width where there are none.
    fn of(value: f64, mut resampled: Vec<f64>) -> Self {
        let [low, high] = percentile_interval(&mut resampled).unwrap_or([value; 2]);
        Self { value, low, high }
    }
}

/// `N` figures of each source on all images, and on each resample of the images.
///
/// A resample is the same for all sources, so that their differences are paired.
pub(crate) struct Resampled<const N: usize> {
    own: Vec<[f64; N]>,
    /// For each resample in which the figures exist, those of each source.
    resampled: Vec<Vec<[f64; N]>>,
}

impl<const N: usize> Resampled<N> {
    /// Resamples `images` images with replacement, [`RESAMPLES`] times; resample i depends on (seed, i) alone.
    ///
    /// `figures` computes those of one source where image i counts `weights[i]` times, with working memory that it may
    /// leave in any state; `None` where they do not exist. `None` where they do not exist on all images.
    pub(crate) fn new<S: Sync, W: Default>(
        sources: &[S],
        images: usize,
        seed: u64,
        figures: impl Fn(&S, &[u64], &mut W) -> Option<[f64; N]> + Sync,
    ) -> Option<Self> {
        let of_all = |weights: &[u64], working: &mut W| -> Option<Vec<[f64; N]>> {
            let each = sources.iter();
            each.map(|source| figures(source, weights, working))
                .collect()
        };
        let own = of_all(&vec![1; images], &mut W::default())?;
        let resampled = (0..RESAMPLES as u64)
            .into_par_iter()
            .map_init(
                || (vec![0; images], W::default()),
                |(weights, working), number| {
                    let mut rng = ChaCha8Rng::seed_from_u64(seed);
                    rng.set_stream(number);
                    draw_counts(&mut rng, weights);
                    of_all(weights, working)
                },
            )
            .flatten()
            .collect();
        Some(Self { own, resampled })
    }

    /// One figure of one source.
    pub(crate) fn estimate(&self, source: usize, figure: usize) -> Estimate {
        let of = |all: &Vec<[f64; N]>| all[source][figure];
        Estimate::of(of(&self.own), self.resampled.iter().map(of).collect())
    }

    /// One figure of `second` less that of `first`.
    pub(crate) fn difference(&self, first: usize, second: usize, figure: usize) -> Estimate {
        let less = |all: &Vec<[f64; N]>| all[second][figure] - all[first][figure];
        Estimate::of(less(&self.own), self.resampled.iter().map(less).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Weighted mean of a source's values.
    fn mean(values: &[f64; 30], weights: &[u64], _: &mut bool) -> Option<[f64; 1]> {
        let sum: f64 = values.iter().zip(weights).map(|(v, &w)| v * w as f64).sum();
        let weight = weights.iter().sum::<u64>();
        (weight > 0).then(|| [sum / weight as f64])
    }

    #[test]
    fn a_constant_difference_has_no_width_in_pairs() {
        let first: [f64; 30] = std::array::from_fn(|i| i as f64);
        let second = first.map(|v| v + 2.0);
        let found = Resampled::new(&[first, second], 30, 1, mean).unwrap();
        let estimate = found.estimate(0, 0);
        assert!(estimate.low < estimate.value - 2.0 && estimate.high > estimate.value + 2.0);
        let difference = found.difference(0, 1, 0);
        for value in [difference.value, difference.low, difference.high] {
            assert!((value - 2.0).abs() < 1e-12, "{difference:?}");
        }
    }

    #[test]
    fn what_does_not_exist_on_all_images_has_no_figures() {
        assert!(Resampled::new(&[[1.0; 30]], 0, 0, mean).is_none());
    }
}
