use super::sampling::Sampler;
use crate::{Draws, Estimator};

/// Which data may stand in a sample beside a first one, as the caller knows it.
///
/// A constraint on the model is often one on pairs of data: a line that passes a point at a
/// given distance leaves, of all second points, those in two wedges. Where the caller can list them
/// (or a little more), a sample is drawn from the pairs that can meet the constraint, and no
/// work goes into those that cannot.
pub trait Partners: Sync {
    /// How many partners a datum has.
    fn count(&self, datum: usize) -> usize;

    /// The partner of number `k`, less than [`count`](Self::count).
    fn get(&self, datum: usize, k: usize) -> usize;
}

/// Samples of two from the pairs that are admissible, each ordered pair equally likely.
///
/// A uniform search draws an admissible pair with a probability equal to their share of all pairs;
/// this one always does. So it is the uniform search with the samples left out that a
/// constraint would refuse, and the stopping rule, which takes the samples as uniform
/// among all, errs on the safe side.
#[derive(Clone, Debug)]
pub struct Pairs<A> {
    partners: A,
    /// For each datum, how many pairs begin with it or one before it.
    ends: Vec<u64>,
}

impl<A: Partners> Pairs<A> {
    /// Counts the pairs of the data `0..data`; `partners` is asked once for each datum.
    pub fn new(data: usize, partners: A) -> Self {
        let ends = (0..data)
            .scan(0_u64, |pairs, datum| {
                *pairs = pairs.saturating_add(partners.count(datum) as u64);
                Some(*pairs)
            })
            .collect();
        Self { partners, ends }
    }

    /// How many ordered pairs are admissible.
    pub fn len(&self) -> u64 {
        self.ends.last().copied().unwrap_or(0)
    }

    /// Whether no pair is admissible.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

impl<E: Estimator, A: Partners> Sampler<E> for Pairs<A> {
    /// Without a sample where no pair is admissible, or where a sample is not of two data.
    fn sample(&self, estimator: &E, _: u64, draws: &mut Draws, sample: &mut [usize]) -> bool {
        let [first, second] = sample else {
            return false;
        };
        if self.is_empty() || self.ends.len() != estimator.len() {
            return false;
        }
        let pair = draws.below(self.len() as usize) as u64;
        *first = self.ends.partition_point(|&end| end <= pair);
        let before = first.checked_sub(1).map_or(0, |datum| self.ends[datum]);
        *second = self.partners.get(*first, (pair - before) as usize);
        *second != *first && *second < estimator.len()
    }
}

#[cfg(test)]
mod tests {
    use super::super::sampling::tests::Numbers;
    use super::*;

    /// Every datum's partners are its multiples up to 12.
    struct Multiples;

    impl Partners for Multiples {
        fn count(&self, datum: usize) -> usize {
            12_usize
                .checked_div(datum)
                .map_or(0, |last| last.saturating_sub(1))
        }
        fn get(&self, datum: usize, k: usize) -> usize {
            datum * (k + 2)
        }
    }

    #[test]
    fn every_admissible_pair_is_equally_likely_and_no_other_drawn() {
        let pairs = Pairs::new(13, Multiples);
        let mut counts = std::collections::BTreeMap::new();
        for i in 0..23_000 {
            let mut s = [0; 2];
            assert!(pairs.sample(&Numbers(13), i, &mut Draws::new(2, i), &mut s));
            assert!(s[0] < s[1] && s[1].is_multiple_of(s[0]) && s[1] <= 12);
            *counts.entry(s).or_insert(0_i32) += 1;
        }
        assert_eq!((counts.len() as u64, pairs.len()), (23, 23));
        // 1000 ± 31 each (one sigma): five sigma fail once in 1e5 for all of them together.
        assert!(
            counts.values().all(|c| (c - 1000).abs() < 155),
            "{counts:?}"
        );
    }

    #[test]
    fn without_pairs_there_is_no_sample() {
        let draw = |pairs: &Pairs<Multiples>, data, sample: &mut [usize]| {
            pairs.sample(&Numbers(data), 0, &mut Draws::new(0, 0), sample)
        };
        assert!(!draw(&Pairs::new(0, Multiples), 0, &mut [0; 2]));
        assert!(!draw(&Pairs::new(1, Multiples), 1, &mut [0; 2]));
        assert!(!draw(&Pairs::new(13, Multiples), 13, &mut [0; 3]));
        assert!(!draw(&Pairs::new(13, Multiples), 12, &mut [0; 2]));
    }
}
