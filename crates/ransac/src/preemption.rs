mod tail;

use crate::estimator::FIRST_BLOCK;
use tail::log_tail;

/// What is known of a model part of the way through the data.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// How many data have been seen, from the first on.
    pub seen: usize,
    /// How many data there are.
    pub data: usize,
    /// What the data seen have gained.
    pub gain: f64,
    /// The most that the others can gain.
    pub most_left: f64,
    /// Whether each datum gains 0 or 1, so that a gain is a number of inliers.
    pub counts: bool,
}

/// How often a [`Preemption`] that is not lossless looks at one model at most.
pub const MAX_LOOKS: usize = 32;

/// Decides when a model is abandoned before all data have been scored.
///
/// A hypothesis is first scored against the best score at the start of its round, and the
/// gains at its looks are kept; when the round is merged, the rule is asked again with the
/// best score that a search of one iteration after another would have had. So the outcome depends
/// neither on the size of a round nor on the number of threads.
pub trait Preemption: Sync {
    /// Whether no model is ever abandoned whose score would have exceeded the bound.
    ///
    /// Such a rule need not be asked again, and may look more than [`MAX_LOOKS`] times.
    const LOSSLESS: bool = false;

    /// After how many data to look next, when `seen` of `data` have been seen; the look is taken at
    /// the end of the block that holds this datum, and none is taken at the end of the data.
    fn next_look(&self, seen: usize, data: usize) -> usize;

    /// Whether to give up, where nothing but a score above `bound` is of use.
    ///
    /// A rule that gives up for one bound must give up for every larger one, and one that gives up
    /// at one gain at every smaller one: it is not asked about what follows from an earlier answer.
    fn gives_up(&self, look: &Look, bound: f64) -> bool;
}

/// Gives up a model once the data left cannot lift it above the best score.
///
/// The outcome is that of scoring everything, to the last bit. Where inliers are few this saves
/// little: a model is dropped only when about as many data are left as the best model has inliers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lossless {
    interval: usize,
}

impl Default for Lossless {
    /// Looks after every block.
    fn default() -> Self {
        Self::every(1)
    }
}

impl Lossless {
    /// Looks no more often than every `interval` data.
    pub fn every(interval: usize) -> Self {
        Self { interval }
    }
}

impl Preemption for Lossless {
    const LOSSLESS: bool = true;

    fn next_look(&self, seen: usize, _: usize) -> usize {
        seen.saturating_add(self.interval)
    }

    fn gives_up(&self, look: &Look, bound: f64) -> bool {
        // Sums of the remaining blocks round differently from the sum of their ceilings, by
        // half a unit in the last place for each block; a billionth covers four million blocks.
        let ceiling = look.gain + look.most_left;
        ceiling + ceiling.abs() * 1e-9 <= bound
    }
}

/// Scores every model on all data.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Exhaustive;

impl Preemption for Exhaustive {
    const LOSSLESS: bool = true;

    fn next_look(&self, _: usize, data: usize) -> usize {
        data
    }

    fn gives_up(&self, _: &Look, _: f64) -> bool {
        false
    }
}

/// Gives up a model once the data seen make it improbable that it exceeds the best score.
///
/// It looks after 128, 256, 512, ... data. **The data must stand in random order**
/// ([`Shuffle`](crate::Shuffle) makes one), so that those seen are a fair sample of all; on a cloud in
/// scan order, the first rows of the image would decide alone.
///
/// # Guarantee
///
/// Over the random order, a model that would exceed the bound is abandoned with a
/// probability of at most `error`, counted over all looks together. What a search
/// loses is the best of its hypotheses, and that is one model: so without local optimisation, the
/// whole search ends below the score of the lossless one with a probability of at most `error`,
/// however many hypotheses it draws.
///
/// # The bound
///
/// Gains between 0 and 1 with mean p over N data have a mean of at most q < p over n data drawn
/// without replacement with a probability of at most exp(−n kl(q, p)), where
/// kl(q, p) = q ln(q/p) + (1−q) ln((1−q)/(1−p)) (Hoeffding 1963, theorem 1 and section 6,
/// doi 10.1080/01621459.1963.10500830). The same holds for the N − n data unseen, which must then
/// have a mean of at least r = (Np − nq)/(N − n): exp(−(N−n) kl(r, p)). A model is abandoned where
/// the smaller of the two, at p = bound/N, is at most `error` divided by the number of looks. Both
/// fall with growing p, so that the bound itself is the worst case.
///
/// Where a score counts inliers ([`Scorer::COUNTS`](crate::Scorer::COUNTS)) the probability is known: of the K inliers
/// that the least score above the bound has, at most g are among the first n data with the probability of the hypergeometric
/// distribution, a fraction of what Hoeffding's bound says. A model is abandoned where that is
/// at most `error` divided by the number of looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Statistical {
    log_error: f64,
}

impl Statistical {
    /// Loses the best hypothesis with a probability of at most `error`.
    ///
    /// An error probability that is not above 0 (NaN included) leaves the lossless bound alone; one
    /// above 1 counts as 1.
    pub fn with_error(error: f64) -> Self {
        let log_error = if error > 0.0 {
            error.min(1.0).ln()
        } else {
            f64::NEG_INFINITY
        };
        Self { log_error }
    }

    /// How often it looks at most: the blocks' ends at [`FIRST_BLOCK`] times a power of two before `data`.
    fn looks(data: usize) -> u32 {
        let blocks = data.div_ceil(FIRST_BLOCK).max(2);
        (blocks - 1).ilog2() + 1
    }
}

/// The divergence of a coin that shows heads with probability q from one with probability p.
fn divergence(q: f64, p: f64) -> f64 {
    let term = |a: f64, b: f64| if a > 0.0 { a * (a / b).ln() } else { 0.0 };
    term(q, p) + term(1.0 - q, 1.0 - p)
}

/// Whether n kl(q, p) is at least e + ln(looks).
///
/// Two bounds settle most cases without a logarithm: (q−p)²/(2 max(q, p)) ≤ kl(q, p) ≤ (q−p)²/(p(1−p)).
fn reaches(n: f64, q: f64, p: f64, e: f64, looks: u32) -> bool {
    // No more than the logarithm of the most looks.
    const MOST: f64 = 3.5;
    let square = n * (q - p) * (q - p);
    if square < e * p * (1.0 - p) {
        return false;
    }
    if square >= (e + MOST) * 2.0 * q.max(p) {
        return true;
    }
    n * divergence(q, p) >= e + f64::from(looks).ln()
}

impl Preemption for Statistical {
    fn next_look(&self, seen: usize, _: usize) -> usize {
        seen.saturating_mul(2).max(FIRST_BLOCK)
    }

    fn gives_up(&self, look: &Look, bound: f64) -> bool {
        if Lossless::default().gives_up(look, bound) {
            return true;
        }
        let (seen, data) = (look.seen as f64, look.data as f64);
        if look.counts {
            let marked = (bound.floor() + 1.0).clamp(0.0, data);
            let log_looks = f64::from(Self::looks(look.data)).ln();
            return log_tail(seen, look.gain, marked, data) <= self.log_error - log_looks;
        }
        let unseen = data - seen;
        let q = look.gain / seen;
        let p = (bound / data).min(1.0);
        let r = ((bound - look.gain) / unseen).min(1.0);
        if !(0.0 <= q && q < p) {
            return false;
        }
        let (e, looks) = (-self.log_error, Self::looks(look.data));
        reaches(seen, q, p, e, looks) || reaches(unseen, r, p, e, looks)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn look(seen: usize, gain: f64) -> Look {
        Look {
            seen,
            data: 10_000,
            gain,
            most_left: (10_000 - seen) as f64,
            counts: false,
        }
    }

    fn count(seen: usize, gain: f64) -> Look {
        Look {
            counts: true,
            ..look(seen, gain)
        }
    }

    #[test]
    fn the_lossless_bound_is_reached_and_not_passed() {
        let rule = Lossless::default();
        assert!(rule.gives_up(&look(9000, 10.0), 1011.0));
        assert!(!rule.gives_up(&look(9000, 10.0), 1009.9));
        assert!(!rule.gives_up(&look(9000, 10.0), f64::NEG_INFINITY));
        assert!(!rule.gives_up(&look(9000, f64::NAN), 1e9));
    }

    #[test]
    fn the_divergence_is_the_textbook_one() {
        assert_eq!(divergence(0.3, 0.3), 0.0);
        assert!((divergence(0.0, 0.5) - 2.0_f64.ln()).abs() < 1e-15);
        assert!((divergence(1.0, 0.25) - 4.0_f64.ln()).abs() < 1e-15);
    }

    #[test]
    fn what_settles_a_case_quickly_agrees_with_the_divergence() {
        for (q, p) in (0..=100).flat_map(|q| (1..100).map(move |p| (f64::from(q), f64::from(p)))) {
            let (q, p) = (q / 100.0, p / 100.0);
            for (e, looks) in [(0.1, 1), (1.0, 3), (3.0, 8), (10.0, 32)] {
                let (exact, needed) = (300.0 * divergence(q, p), e + f64::from(looks).ln());
                if (exact - needed).abs() > 1e-9 {
                    assert_eq!(
                        reaches(300.0, q, p, e, looks),
                        exact >= needed,
                        "{q} {p} {e}"
                    );
                }
            }
        }
        assert!((MAX_LOOKS as f64).ln() < 3.5);
    }

    #[test]
    fn a_poor_model_is_given_up_after_few_data_and_a_good_one_is_not() {
        let rule = Statistical::with_error(0.001);
        // The best model has 10 % inliers. 2 % on 256 data is improbable for it, 9 % is not.
        assert!(rule.gives_up(&look(256, 5.0), 1000.0));
        assert!(!rule.gives_up(&look(256, 23.0), 1000.0));
        assert!(!rule.gives_up(&look(256, 5.0), f64::NEG_INFINITY));
        assert!(!rule.gives_up(&look(256, f64::NAN), 1000.0));
        // What is known of a count is more: 3.5 % is improbable as well, and 5.5 % is not.
        assert!(rule.gives_up(&count(256, 9.0), 1000.0));
        assert!(!rule.gives_up(&look(256, 9.0), 1000.0));
        assert!(!rule.gives_up(&count(256, 14.0), 1000.0));
        assert!(!rule.gives_up(&count(256, 5.0), f64::NEG_INFINITY));
        assert!(!rule.gives_up(&count(256, f64::NAN), 1000.0));
        // Without an error to spend, the lossless bound is left.
        let strict = Statistical::with_error(0.0);
        assert!(!strict.gives_up(&count(256, 0.0), 1000.0));
        assert!(strict.gives_up(&count(9500, 0.0), 1000.0));
        assert!(!strict.gives_up(&look(256, 0.0), 1000.0));
        assert!(strict.gives_up(&look(9500, 0.0), 1000.0));
    }

    #[test]
    fn giving_up_is_monotone_in_the_bound() {
        for error in [0.3, 0.01, 1e-9] {
            let rule = Statistical::with_error(error);
            for seen in [128, 1024, 4096, 8192] {
                for gain in [0.0, 1.0, 0.02 * seen as f64, 0.3 * seen as f64, seen as f64] {
                    for look in [look(seen, gain), count(seen, gain.floor())] {
                        let verdicts =
                            (0..10_100).map(|bound| rule.gives_up(&look, f64::from(bound)));
                        assert!(verdicts.is_sorted(), "{error} {look:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn giving_up_is_monotone_in_the_gain() {
        for error in [0.3, 0.01, 1e-9] {
            let rule = Statistical::with_error(error);
            for seen in [128, 1024, 4096, 8192] {
                for bound in [0.0, 10.0, 300.0, 2000.0, 9000.0] {
                    for look in [look, count] {
                        let keeps =
                            (0..=seen).map(|gain| !rule.gives_up(&look(seen, gain as f64), bound));
                        assert!(keeps.is_sorted(), "{error} {seen} {bound}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_count_is_lost_as_seldom_as_promised() {
        // 3000 orders of 2000 data with 200 inliers against a bound of 199: 300 losses are allowed.
        let rule = Statistical::with_error(0.1);
        let mut lost = 0;
        for trial in 0..3000 {
            let mut draws = crate::Draws::new(11, trial);
            let order = crate::Shuffle::new(2000, &mut draws);
            let given_up = [128, 256, 512, 1024].into_iter().any(|seen| {
                let found = order.order()[..seen].iter().filter(|&&i| i < 200).count();
                let look = Look {
                    seen,
                    data: 2000,
                    gain: found as f64,
                    most_left: (2000 - seen) as f64,
                    counts: true,
                };
                rule.gives_up(&look, 199.0)
            });
            lost += i32::from(given_up);
        }
        assert!((60..300).contains(&lost), "{lost}");
    }

    #[test]
    fn looks_are_counted() {
        for data in [1, 128, 129, 256, 257, 1024, 1025, 5000, 1_000_000] {
            let rule = Statistical::with_error(0.1);
            let ends = std::iter::successors(Some(rule.next_look(0, data)), |&seen| {
                Some(rule.next_look(seen, data))
            });
            let looks = ends.take_while(|&seen| seen < data).count();
            assert!(
                looks <= Statistical::looks(data) as usize,
                "{data}: {looks}"
            );
            assert!(
                looks + 1 >= Statistical::looks(data) as usize,
                "{data}: {looks}"
            );
            assert!(looks < MAX_LOOKS);
        }
    }
}
