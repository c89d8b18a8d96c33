use crate::{Progress, StopReason, Stopping};

/// Ends once a sample of inliers alone has been drawn with a given probability.
///
/// With I inliers among n data, a uniform sample of m distinct ones is free of
/// outliers with probability ε = Π (I − j)/(n − j), j = 0..m, and k samples
/// miss every such one with probability (1 − ε)ᵏ. The product is the exact
/// combinatorial form; the usual (I/n)ᵐ draws too few where inliers are few
/// (Schönberger et al. 2025, arXiv 2503.07829).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Confidence {
    failure: f64,
    min_draws: u64,
    max_draws: u64,
}

impl Confidence {
    /// Ends when the probability of having missed is at most `1 − confidence`,
    /// or after `max_draws` samples.
    ///
    /// A confidence that is not under 1 (NaN included) never ends the search before `max_draws`.
    pub fn new(confidence: f64, max_draws: u64) -> Self {
        let failure = if confidence < 1.0 {
            1.0 - confidence
        } else {
            0.0
        };
        Self {
            failure,
            min_draws: 0,
            max_draws,
        }
    }

    /// The same, but not before `min_draws` samples.
    #[must_use]
    pub fn min_draws(self, min_draws: u64) -> Self {
        Self { min_draws, ..self }
    }

    /// Probability that none of `draws` samples held inliers alone.
    pub fn miss_probability(progress: &Progress) -> f64 {
        let (inliers, data) = (progress.best_inliers as f64, progress.data as f64);
        let clean: f64 = (0..progress.sample_size)
            .map(|j| ((inliers - j as f64) / (data - j as f64)).max(0.0))
            .product();
        (progress.draws as f64 * (-clean).ln_1p()).exp()
    }
}

impl Stopping for Confidence {
    fn reason(&self, progress: &Progress) -> Option<StopReason> {
        if progress.draws >= self.min_draws && Self::miss_probability(progress) <= self.failure {
            Some(StopReason::Confident)
        } else if progress.draws >= self.max_draws {
            Some(StopReason::DrawsExhausted)
        } else {
            None
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn progress(draws: u64, best_inliers: usize, data: usize, sample_size: usize) -> Progress {
        Progress {
            draws,
            best_inliers,
            data,
            sample_size,
            ..Progress::default()
        }
    }

    #[test]
    fn miss_probability_is_the_combinatorial_one() {
        // 4 inliers among 6, pairs: C(4,2)/C(6,2) = 6/15, so three draws miss with (9/15)³.
        let p = Confidence::miss_probability(&progress(3, 4, 6, 2));
        assert!((p - 0.6_f64.powi(3)).abs() < 1e-15);
        assert_eq!(Confidence::miss_probability(&progress(5, 0, 6, 2)), 1.0);
        assert_eq!(Confidence::miss_probability(&progress(5, 1, 6, 2)), 1.0);
        assert_eq!(Confidence::miss_probability(&progress(1, 6, 6, 2)), 0.0);
    }

    #[test]
    fn stops_at_the_confidence_and_not_before() {
        let rule = Confidence::new(0.99, 1000);
        // (9/15)^9 = 0.0101, (9/15)^10 = 0.006.
        assert_eq!(rule.reason(&progress(9, 4, 6, 2)), None);
        assert_eq!(
            rule.reason(&progress(10, 4, 6, 2)),
            Some(StopReason::Confident)
        );
        assert_eq!(rule.min_draws(11).reason(&progress(10, 4, 6, 2)), None);
        assert_eq!(
            rule.reason(&progress(1000, 0, 6, 2)),
            Some(StopReason::DrawsExhausted)
        );
        assert_eq!(
            Confidence::new(f64::NAN, 10).reason(&progress(9, 5, 6, 2)),
            None
        );
    }
}
