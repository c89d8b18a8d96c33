//! The mean of numbers, a third of which agree.

use pomona_ransac::{Candidates, Draws, Estimator};
use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};

pub(crate) struct Numbers {
    pub(crate) values: Vec<f64>,
    /// How many residuals were asked for.
    pub(crate) scored: AtomicUsize,
}

impl Numbers {
    /// A third of `len` numbers within 1 of 10, peaked in the middle, the others
    /// between 0 and 100, in random order.
    pub(crate) fn noisy(seed: u64, len: usize) -> Self {
        let mut draws = Draws::new(seed, 0);
        let mut unit = move || (draws.bits() >> 11) as f64 / (1_u64 << 53) as f64;
        let mut value = move || {
            if unit() < 1.0 / 3.0 {
                9.0 + unit() + unit()
            } else {
                100.0 * unit()
            }
        };
        Self {
            values: (0..len).map(|_| value()).collect(),
            scored: AtomicUsize::new(0),
        }
    }
}

impl Estimator for Numbers {
    type Model = f64;
    const SAMPLE_SIZE: usize = 2;

    fn len(&self) -> usize {
        self.values.len()
    }

    fn fit(&self, sample: &[usize], candidates: &mut Candidates<f64>) {
        candidates.push(f64::midpoint(
            self.values[sample[0]],
            self.values[sample[1]],
        ));
    }

    fn refit(&self, inliers: &[usize], _: &f64) -> Option<f64> {
        let sum: f64 = inliers.iter().map(|&i| self.values[i]).sum();
        (!inliers.is_empty()).then(|| sum / inliers.len() as f64)
    }

    fn refit_weighted(&self, inliers: &[usize], weights: &[f64], _: &f64) -> Option<f64> {
        let pairs = || inliers.iter().zip(weights);
        let sum: f64 = pairs().map(|(&i, w)| w * self.values[i]).sum();
        let total: f64 = pairs().map(|(_, w)| w).sum();
        (total > 0.0).then(|| sum / total)
    }

    fn residuals(&self, model: &f64, block: Range<usize>, out: &mut [f64]) {
        self.scored.fetch_add(block.len(), Ordering::Relaxed);
        for (r, i) in out.iter_mut().zip(block) {
            *r = (self.values[i] - model).abs();
        }
    }
}
