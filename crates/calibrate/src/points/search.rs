//! The consensus of most point pairs.

use super::estimator::PointPairs;
use super::similarity::Similarity;
use crate::Options;
use crate::robust::MAX_DRAWS;
use pomona_ransac::{FixedCount, LeastSquares, Msac, Ransac};
use rand_core::Rng;

/// Three points determine the unknowns; a fourth tells whether one of them is wrong.
pub(super) const LEAST_POINTS: usize = 4;

/// How many samples must agree.
pub(super) fn needed(samples: usize) -> usize {
    LEAST_POINTS.max(samples / 2 + 1)
}

pub(super) fn search<R: Rng + ?Sized>(
    pairs: &PointPairs,
    tolerance_m: f64,
    options: &Options,
    rng: &mut R,
) -> Option<(Similarity, Vec<usize>)> {
    let engine = Ransac::new(Msac::within(tolerance_m))
        .local_optimization(LeastSquares::default())
        .stopping(FixedCount::new(u64::from(options.hypotheses)).max_draws(MAX_DRAWS));
    let report = engine.run(pairs, rng).ok()?;
    Some((report.model, report.inliers))
}
