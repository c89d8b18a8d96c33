use crate::{Progress, StopReason, Stopping};
use std::time::Duration;

/// Ends once a span of time has passed; the report holds the best model so far.
///
/// The clock is the caller's, so that the engine itself reads none and a test can bring its own. This is
/// the one rule whose outcome is not reproducible, and the time of the last refit and of the
/// round under way (see [`Ransac::round`](crate::Ransac::round)) comes on top of the budget.
///
/// ```
/// use pomona_ransac::{Confidence, InlierCount, Ransac, Stopping, TimeBudget};
/// use std::time::{Duration, Instant};
///
/// let start = Instant::now();
/// let in_time = TimeBudget::new(Duration::from_millis(5), move || start.elapsed());
/// let search = Ransac::new(InlierCount::within(0.1))
///     .stopping(Confidence::new(0.99, u64::MAX).or(in_time));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct TimeBudget<F> {
    budget: Duration,
    elapsed: F,
}

impl<F: Fn() -> Duration + Sync> TimeBudget<F> {
    /// Ends once `elapsed`, asked after every sample, gives `budget` or more.
    pub fn new(budget: Duration, elapsed: F) -> Self {
        Self { budget, elapsed }
    }
}

impl<F: Fn() -> Duration + Sync> Stopping for TimeBudget<F> {
    fn reason(&self, _: &Progress) -> Option<StopReason> {
        ((self.elapsed)() >= self.budget).then_some(StopReason::TimeSpent)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicU64, Ordering};

    #[test]
    fn ends_when_the_callers_clock_says_so() {
        let clock = AtomicU64::new(4);
        let rule = TimeBudget::new(Duration::from_secs(5), || {
            Duration::from_secs(clock.load(Ordering::Relaxed))
        });
        assert_eq!(rule.reason(&Progress::default()), None);
        clock.store(5, Ordering::Relaxed);
        let reason = rule.reason(&Progress::default());
        assert_eq!(reason, Some(StopReason::TimeSpent));
    }
}
