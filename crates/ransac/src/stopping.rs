/// How far a search has come: what a [`Stopping`] rule decides by.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Progress {
    /// Samples drawn, whatever became of them.
    pub draws: u64,
    /// Of these, how many gave at least one model that passed all constraints.
    pub accepted: u64,
    /// Models that passed all constraints and were scored.
    pub hypotheses: u64,
    /// Inliers of the best model so far; 0 while there is none.
    pub best_inliers: usize,
    /// Score of the best model so far.
    pub best_score: Option<f64>,
    /// How many data there are.
    pub data: usize,
    /// How many data a minimal sample has.
    pub sample_size: usize,
}

/// Why a search ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum StopReason {
    /// The wanted number of hypotheses was scored.
    HypothesesReached,
    /// The largest allowed number of samples was drawn.
    DrawsExhausted,
    /// A better model is as unlikely as was asked for.
    Confident,
    /// The time was spent.
    TimeSpent,
    /// The caller's predicate held.
    PredicateHeld,
}

/// Decides when a search ends; asked after each iteration, in order.
pub trait Stopping: Sync {
    /// The reason to stop now, if there is one.
    ///
    /// It must give one sooner or later for growing `draws`, or the search never ends.
    fn reason(&self, progress: &Progress) -> Option<StopReason>;

    /// How many more samples the rule expects to let pass, as far as it can tell.
    ///
    /// The engine sizes its rounds by it, to compute little in vain; the outcome does not depend on it.
    fn draws_left(&self, _progress: &Progress) -> u64 {
        u64::MAX
    }

    /// Probability that a sample of inliers alone was among those that this rule counts; none for a
    /// rule that does not reckon with it.
    ///
    /// [`Report::confidence`](crate::Report::confidence) is this, for the final model.
    fn confidence(&self, _progress: &Progress) -> Option<f64> {
        None
    }

    /// Ends when this rule or the `other` does, for the reason of the one that does; this
    /// rule's where both do.
    fn or<R: Stopping>(self, other: R) -> Either<Self, R>
    where
        Self: Sized,
    {
        Either {
            first: self,
            second: other,
        }
    }
}

/// The first of two rules to end the search, made by [`Stopping::or`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Either<A, B> {
    first: A,
    second: B,
}

impl<A: Stopping, B: Stopping> Stopping for Either<A, B> {
    fn reason(&self, progress: &Progress) -> Option<StopReason> {
        let first = self.first.reason(progress);
        first.or_else(|| self.second.reason(progress))
    }

    fn draws_left(&self, progress: &Progress) -> u64 {
        let first = self.first.draws_left(progress);
        first.min(self.second.draws_left(progress))
    }

    /// The lower of the two where both have one.
    fn confidence(&self, progress: &Progress) -> Option<f64> {
        let of_rules = [
            self.first.confidence(progress),
            self.second.confidence(progress),
        ];
        of_rules.into_iter().flatten().reduce(f64::min)
    }
}

/// Ends once the caller's predicate holds: enough inliers, say, or a flag set by another thread.
///
/// A predicate that may never hold belongs with a rule that will: `.or(FixedCount::new(10_000))`.
///
/// ```
/// use pomona_ransac::{FixedCount, InlierCount, Progress, Ransac, Stopping, Until};
///
/// let enough = Until::new(|progress: &Progress| progress.best_inliers >= 200);
/// let search = Ransac::new(InlierCount::within(0.1)).stopping(enough.or(FixedCount::new(10_000)));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Until<F> {
    predicate: F,
}

impl<F: Fn(&Progress) -> bool + Sync> Until<F> {
    /// Ends once `predicate` is true.
    pub fn new(predicate: F) -> Self {
        Self { predicate }
    }
}

impl<F: Fn(&Progress) -> bool + Sync> Stopping for Until<F> {
    fn reason(&self, progress: &Progress) -> Option<StopReason> {
        (self.predicate)(progress).then_some(StopReason::PredicateHeld)
    }
}

/// Ends after a fixed number of scored hypotheses.
///
/// Samples that are degenerate or that a constraint refuses do not count, but
/// at most `max_draws` samples are drawn in all.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FixedCount {
    hypotheses: u64,
    max_draws: u64,
}

impl FixedCount {
    /// Scores `hypotheses` models, and draws at most a hundred times as many samples.
    pub fn new(hypotheses: u64) -> Self {
        Self {
            hypotheses,
            max_draws: hypotheses.saturating_mul(100),
        }
    }

    /// The same, with another limit of samples to draw.
    #[must_use]
    pub fn max_draws(self, max_draws: u64) -> Self {
        Self { max_draws, ..self }
    }
}

impl Stopping for FixedCount {
    fn reason(&self, progress: &Progress) -> Option<StopReason> {
        if progress.hypotheses >= self.hypotheses {
            Some(StopReason::HypothesesReached)
        } else if progress.draws >= self.max_draws {
            Some(StopReason::DrawsExhausted)
        } else {
            None
        }
    }

    fn draws_left(&self, progress: &Progress) -> u64 {
        let hypotheses = self.hypotheses.saturating_sub(progress.hypotheses);
        hypotheses.min(self.max_draws.saturating_sub(progress.draws))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_hypotheses_and_limits_draws() {
        let rule = FixedCount::new(10).max_draws(50);
        let at = |hypotheses, draws| Progress {
            draws,
            hypotheses,
            ..Progress::default()
        };
        assert_eq!(rule.reason(&at(9, 49)), None);
        assert_eq!(
            rule.reason(&at(10, 10)),
            Some(StopReason::HypothesesReached)
        );
        assert_eq!(rule.reason(&at(0, 50)), Some(StopReason::DrawsExhausted));
    }
    #[test]
    fn the_first_of_two_rules_ends_the_search() {
        let enough = Until::new(|progress: &Progress| progress.best_inliers >= 20);
        let rule = enough.or(FixedCount::new(10));
        let at = |best_inliers, hypotheses| Progress {
            hypotheses,
            best_inliers,
            ..Progress::default()
        };
        assert_eq!(rule.reason(&at(19, 9)), None);
        assert_eq!(rule.reason(&at(20, 9)), Some(StopReason::PredicateHeld));
        assert_eq!(rule.reason(&at(20, 10)), Some(StopReason::PredicateHeld));
        let counted = Some(StopReason::HypothesesReached);
        assert_eq!(rule.reason(&at(19, 10)), counted);
        assert_eq!(rule.draws_left(&at(19, 8)), 2);
    }
}
