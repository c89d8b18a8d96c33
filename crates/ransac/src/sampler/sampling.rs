use crate::{Draws, Estimator};

/// Picks the data of a minimal sample.
///
/// A sampler sees the iteration's number and the generator keyed by it, and
/// keeps no state of its own, so that iterations can be computed in any order.
pub trait Sampler<E: Estimator>: Sync {
    /// Fills `sample`, [`Estimator::SAMPLE_SIZE`] long, with distinct data;
    /// `false` where it finds none this time.
    fn sample(
        &self,
        estimator: &E,
        iteration: u64,
        draws: &mut Draws,
        sample: &mut [usize],
    ) -> bool;
}

/// Fills `out` with distinct numbers of `0..end`, each set equally likely; `false` where there are too few.
///
/// Floyd's algorithm (Bentley and Floyd 1987, doi 10.1145/30401.315746):
/// one draw for each number, however few there are to choose from.
pub(super) fn distinct(draws: &mut Draws, end: usize, out: &mut [usize]) -> bool {
    if end < out.len() {
        return false;
    }
    for k in 0..out.len() {
        let last = end - out.len() + k;
        let pick = draws.below(last + 1);
        out[k] = if out[..k].contains(&pick) { last } else { pick };
    }
    true
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::Candidates;
    use std::ops::Range;

    /// Data of which nothing is known but how many there are.
    pub(crate) struct Numbers(pub(crate) usize);

    impl Estimator for Numbers {
        type Model = ();
        const SAMPLE_SIZE: usize = 3;
        fn len(&self) -> usize {
            self.0
        }
        fn fit(&self, _: &[usize], _: &mut Candidates<()>) {}
        fn refit(&self, _: &[usize], (): &()) -> Option<()> {
            None
        }
        fn residuals(&self, (): &(), _: Range<usize>, _: &mut [f64]) {}
    }
}
