use crate::{Estimator, StopReason, estimator::blocks};

/// How many constraint rules a report counts apart; further rules count with the last one.
pub const MAX_RULES: usize = 8;

/// What one constraint refused.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rejections {
    /// Name of the constraint.
    pub constraint: &'static str,
    /// Samples refused before a model was fitted.
    pub samples: u64,
    /// Models refused before they were scored.
    pub models: u64,
    /// Refits refused; the model before the refit was kept.
    pub refits: u64,
}

/// What a search did.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Counts {
    /// Samples drawn.
    pub draws: u64,
    /// Samples of which at least one model passed all constraints.
    pub accepted: u64,
    /// Samples from which no model came.
    pub degenerate: u64,
    /// Models scored, in full or until they were given up.
    pub hypotheses: u64,
    /// Of these, how many did not exceed the best score of their time, given up or not.
    pub pruned: u64,
    /// Refits tried.
    pub refits: u64,
    /// What each constraint refused; the first [`rules`](Self::rules) entries are in use.
    pub rejections: [Rejections; MAX_RULES],
    /// How many entries of `rejections` are in use.
    pub rules: usize,
}

impl Counts {
    /// What each constraint refused, in the order in which they were added.
    pub fn rejections(&self) -> &[Rejections] {
        &self.rejections[..self.rules]
    }

    pub(crate) fn rejection(&mut self, rule: usize) -> &mut Rejections {
        &mut self.rejections[rule.min(MAX_RULES - 1)]
    }
}

/// Size of the inliers' residuals.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ResidualStatistics {
    /// Root mean square.
    pub rms: f64,
    /// Mean of the absolute values.
    pub mean: f64,
    /// Median of the absolute values; the mean of the middle two where their number is even.
    pub median: f64,
    /// Largest.
    pub max: f64,
}

/// The outcome of a search; everything in it belongs to the final `model`.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Report<M> {
    /// The final model, after the last refit.
    pub model: M,
    /// Its inliers, ascending.
    pub inliers: Vec<usize>,
    /// Its score.
    pub score: f64,
    /// Its inliers' residuals.
    pub residuals: ResidualStatistics,
    /// Probability that a sample of inliers alone was among those drawn, had the samples been uniform
    /// and the final model's inliers all there are to find: 1 less
    /// [`Confidence::miss_probability`](crate::Confidence::miss_probability).
    pub confidence: f64,
    /// Why the search ended.
    pub stopped: StopReason,
    /// What the search did.
    pub counts: Counts,
}

/// Calls `f(datum, residual)` for each of `inliers`, which ascend.
pub(crate) fn for_each_residual<E: Estimator>(
    estimator: &E,
    model: &E::Model,
    inliers: &[usize],
    mut f: impl FnMut(usize, f64),
) {
    let mut next = inliers.iter().copied().peekable();
    for block in blocks(estimator.len()) {
        if next.peek().is_none_or(|&i| i >= block.end) {
            continue;
        }
        estimator.fold_residuals(model, block, (), |(), i, r| {
            if next.next_if_eq(&i).is_some() {
                f(i, r);
            }
        });
    }
}

/// Statistics of the residuals of `inliers`, which ascend; `buffer` is overwritten.
pub(crate) fn residual_statistics<E: Estimator>(
    estimator: &E,
    model: &E::Model,
    inliers: &[usize],
    buffer: &mut Vec<f64>,
) -> ResidualStatistics {
    buffer.clear();
    let (mut squares, mut sum, mut max) = (0.0, 0.0, 0.0_f64);
    for_each_residual(estimator, model, inliers, |_, r| {
        squares += r * r;
        sum += r;
        max = max.max(r);
        buffer.push(r);
    });
    if buffer.is_empty() {
        return ResidualStatistics::default();
    }
    let n = inliers.len() as f64;
    ResidualStatistics {
        rms: (squares / n).sqrt(),
        mean: sum / n,
        median: median(buffer),
        max,
    }
}

/// The median of numbers, of which there is at least one; reorders them.
fn median(numbers: &mut [f64]) -> f64 {
    let even = numbers.len().is_multiple_of(2);
    let (below, &mut upper, _) = numbers.select_nth_unstable_by(numbers.len() / 2, f64::total_cmp);
    if even {
        let lower = below.iter().copied().fold(0.0, f64::max);
        f64::midpoint(lower, upper)
    } else {
        upper
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_is_the_middle() {
        assert_eq!(median(&mut [3.0]), 3.0);
        assert_eq!(median(&mut [3.0, 1.0]), 2.0);
        assert_eq!(median(&mut [3.0, 9.0, 1.0]), 3.0);
        assert_eq!(median(&mut [3.0, 9.0, 1.0, 5.0]), 4.0);
    }
}
