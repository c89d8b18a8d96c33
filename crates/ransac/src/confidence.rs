use crate::{Progress, StopReason, Stopping};

/// Ends once a sample of inliers alone has been drawn with a given probability.
///
/// With I inliers among n data, a uniform sample of m distinct ones is free of
/// outliers with probability ε = Π (I − j)/(n − j), j = 0..m, and k samples
/// miss every such one with probability (1 − ε)ᵏ. The product is the exact
/// combinatorial form; the usual (I/n)ᵐ draws too few where inliers are few
/// (Schönberger et al. 2025, arXiv 2503.07829).
///
/// # Under constraints
///
/// Every sample drawn counts in k, refused or not: right where a sample of inliers alone always obeys
/// the constraints, as it does where these only state what is known of the model. Where
/// noise can throw a clean sample's model out of the constraints (a small sphere through
/// four neighbouring points), [`accepted_only`](Self::accepted_only) counts in the acceptance
/// rate a: clean samples are taken to be refused as often as any other, and (1 − ε)ᵃᵏ is left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Confidence {
    failure: f64,
    min_draws: u64,
    max_draws: u64,
    accepted_only: bool,
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
            accepted_only: false,
        }
    }

    /// The same, but not before `min_draws` samples.
    #[must_use]
    pub fn min_draws(self, min_draws: u64) -> Self {
        Self { min_draws, ..self }
    }

    /// The same, with no sample counted that the constraints refused or that was degenerate.
    ///
    /// `max_draws` still counts them all.
    #[must_use]
    pub fn accepted_only(self) -> Self {
        Self {
            accepted_only: true,
            ..self
        }
    }

    /// Probability that none of `draws` samples held inliers alone.
    pub fn miss_probability(progress: &Progress) -> f64 {
        miss_probability(progress, progress.draws)
    }

    fn counted(&self, progress: &Progress) -> u64 {
        if self.accepted_only {
            progress.accepted
        } else {
            progress.draws
        }
    }
}

/// ln(1 − ε), ε being the probability of a sample of inliers alone.
fn log_unclean(progress: &Progress) -> f64 {
    let (inliers, data) = (progress.best_inliers as f64, progress.data as f64);
    let clean: f64 = (0..progress.sample_size)
        .map(|j| ((inliers - j as f64) / (data - j as f64)).max(0.0))
        .product();
    (-clean).ln_1p()
}

fn miss_probability(progress: &Progress, samples: u64) -> f64 {
    if samples == 0 {
        return 1.0;
    }
    (samples as f64 * log_unclean(progress)).exp()
}

impl Stopping for Confidence {
    fn reason(&self, progress: &Progress) -> Option<StopReason> {
        let miss = miss_probability(progress, self.counted(progress));
        if progress.draws >= self.min_draws && miss <= self.failure {
            Some(StopReason::Confident)
        } else if progress.draws >= self.max_draws {
            Some(StopReason::DrawsExhausted)
        } else {
            None
        }
    }

    fn confidence(&self, progress: &Progress) -> Option<f64> {
        Some(1.0 - miss_probability(progress, self.counted(progress)))
    }

    fn draws_left(&self, progress: &Progress) -> u64 {
        // A division by −0 (no inliers yet) gives infinity, which saturates.
        let needed = (self.failure.ln() / log_unclean(progress)).ceil() as u64;
        let left = needed.saturating_sub(self.counted(progress));
        let least = self.min_draws.saturating_sub(progress.draws);
        let most = self.max_draws.saturating_sub(progress.draws);
        left.max(least).min(most)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::FixedCount;

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

    #[test]
    fn refused_samples_may_be_left_out() {
        let rule = Confidence::new(0.99, 1000).accepted_only();
        let at = |draws, accepted| Progress {
            accepted,
            ..progress(draws, 4, 6, 2)
        };
        assert_eq!(rule.reason(&at(100, 0)), None);
        assert_eq!(rule.reason(&at(100, 9)), None);
        assert_eq!(rule.reason(&at(100, 10)), Some(StopReason::Confident));
        assert_eq!(rule.reason(&at(1000, 9)), Some(StopReason::DrawsExhausted));
        // What is told is what the rule went by, and of two rules the lower.
        let told = |p: &Progress| rule.confidence(p).unwrap_or(f64::NAN);
        assert_eq!(told(&at(100, 0)), 0.0);
        assert!((told(&at(100, 9)) - (1.0 - 0.6_f64.powi(9))).abs() < 1e-15);
        let every = Confidence::new(0.99, 1000);
        assert!(every.confidence(&at(100, 0)) > Some(0.999_999));
        assert_eq!(every.or(rule).confidence(&at(100, 0)), Some(0.0));
        let counted = FixedCount::new(5).or(rule);
        assert_eq!(counted.confidence(&at(100, 0)), Some(0.0));
        assert_eq!(FixedCount::new(5).confidence(&at(100, 0)), None);
    }

    #[test]
    fn the_samples_left_are_those_until_the_end() {
        let rule = Confidence::new(0.99, 1000);
        assert_eq!(rule.draws_left(&progress(3, 4, 6, 2)), 7);
        assert_eq!(rule.min_draws(50).draws_left(&progress(3, 4, 6, 2)), 47);
        assert_eq!(rule.draws_left(&progress(3, 0, 6, 2)), 997);
        assert_eq!(rule.draws_left(&progress(3, 6, 6, 2)), 0);
        let endless = Confidence::new(1.0, 1000);
        assert_eq!(endless.draws_left(&progress(3, 4, 6, 2)), 997);
    }
}
