use crate::{BLOCK, Covariance, Estimator, StopReason};

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
    /// Initial models that passed all constraints and were scored; they are no hypotheses of a sample.
    pub initial: u64,
    /// Models of samples scored, in full or until they were abandoned.
    pub hypotheses: u64,
    /// Of these, how many did not exceed the best score of their time, abandoned or not.
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
    /// Standard deviation of the noise in one component of a residual, where the estimator gives
    /// derivatives ([`Estimator::PARAMETERS`]) and there are more rows than parameters.
    ///
    /// From σ² = Σ w r²/(rows − parameters) over the inliers, with what the threshold cut off a
    /// Gaussian noise given back: at a threshold of 2σ the inliers show 88 % of σ, at 3σ 98.7 %.
    /// It is at most the threshold, which it reaches where the inliers fill the band evenly
    /// and so do not tell their noise.
    ///
    /// Where data have thresholds tᵢ and weights wᵢ of their own ([`PerDatum`](crate::PerDatum)), it
    /// belongs to a datum with the largest threshold T and weight 1; another's variance is taken as
    /// σ² (tᵢ/T)²/wᵢ. What weights do to the share that is cut off is left out of account.
    pub sigma: Option<f64>,
    /// Covariance of the model's parameters as [`Estimator::linearize`] has them; `None` also where the
    /// inliers do not determine all of them.
    ///
    /// It takes the model for the least-squares fit to its own inliers with the weights of
    /// [`sigma`](Self::sigma), as [`LeastSquares`](crate::LeastSquares) leaves it, errors as independent, and the
    /// inliers as having no outliers among them. Such a fit solves Σ ψ(rᵢ) ∇rᵢ = 0 with
    /// ψ(r) = r within the threshold and 0 beyond, whose covariance is `E[ψ²]/E[ψ′]² (Σ ∇r ∇rᵀ)⁻¹` over
    /// all data (Huber 1964, doi 10.1214/aoms/1177703732). For Gaussian noise `E[ψ′] = E[rψ]/σ²` (Stein's identity),
    /// which makes it `(σ⁴/s²)(JᵀWJ)⁻¹` over the inliers, s being the spread that these show.
    pub covariance: Option<Covariance>,
    /// Probability that a sample of inliers alone was among those drawn, had the samples been uniform
    /// and the final model's inliers all there are to find.
    ///
    /// As the stopping rule reckons it ([`Stopping::confidence`](crate::Stopping::confidence)): without the samples
    /// that were refused for a [`Confidence`](crate::Confidence) that counts the
    /// [accepted ones only](crate::Confidence::accepted_only). For a rule that does not reckon with it, every
    /// sample counts: 1 less [`Confidence::miss_probability`](crate::Confidence::miss_probability).
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
    let mut buffer = [f64::NAN; BLOCK];
    for some in inliers.chunks(BLOCK) {
        let residuals = &mut buffer[..some.len()];
        estimator.residuals_of(model, some, residuals);
        for (&datum, &residual) in some.iter().zip(&*residuals) {
            f(datum, residual);
        }
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
    buffer.resize(inliers.len(), f64::NAN);
    for (some, residuals) in inliers.chunks(BLOCK).zip(buffer.chunks_mut(BLOCK)) {
        estimator.residuals_of(model, some, residuals);
    }
    if buffer.is_empty() {
        return ResidualStatistics::default();
    }
    // Four sums side by side.
    let (mut squares, mut sums, mut largest) = ([0.0; 4], [0.0; 4], [0.0_f64; 4]);
    for four in buffer.chunks(4) {
        for (lane, &r) in four.iter().enumerate() {
            squares[lane] += r * r;
            sums[lane] += r;
            largest[lane] = largest[lane].max(r);
        }
    }
    let total = |lanes: [f64; 4]| (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]);
    let (squares, sum) = (total(squares), total(sums));
    let max = largest.into_iter().fold(0.0, f64::max);
    let n = inliers.len() as f64;
    ResidualStatistics {
        rms: (squares / n).sqrt(),
        mean: sum / n,
        median: median(buffer),
        max,
    }
}

/// The median of numbers, of which there is at least one; reorders them.
///
/// Said here again, since this crate depends on `rand_core` alone.
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
