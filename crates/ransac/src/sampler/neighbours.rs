use super::sampling::Sampler;
use crate::{Draws, Estimator};

/// What lies near a datum, as the caller knows it: a grid, a tree, rows of an image.
///
/// Implemented for functions that append to a list.
pub trait Neighbourhood: Sync {
    /// Appends the data near `datum` to `out`, in an order that does not depend on chance.
    ///
    /// The datum itself may be among them; it is left out of its own sample.
    fn neighbours(&self, datum: usize, out: &mut Vec<usize>);
}

impl<F: Fn(usize, &mut Vec<usize>) + Sync> Neighbourhood for F {
    fn neighbours(&self, datum: usize, out: &mut Vec<usize>) {
        self(datum, out);
    }
}

/// A datum and others from its neighbourhood: NAPSAC (Myatt et al. 2002, BMVC, doi 10.5244/C.16.44).
///
/// Inliers of one small structure lie together, so a local sample is far more often free of
/// outliers than a uniform one. It is also short, and noise turns a short base into a large error: the
/// original's known weakness. [`spread`](Self::spread) refuses samples whose data lie too near to each other.
///
/// The search allocates for each list of neighbours that does not fit the thread's last one.
#[derive(Clone, Copy, Debug)]
pub struct Local<N, D = Anywhere> {
    neighbourhood: N,
    far_apart: D,
}

/// Every two data are far enough apart.
#[derive(Clone, Copy, Debug, Default)]
pub struct Anywhere;

/// Whether two data are far enough apart for the same sample.
///
/// Implemented for functions of two data.
pub trait Spread: Sync {
    /// Whether a sample may hold both.
    fn far_apart(&self, one: usize, other: usize) -> bool;
}

impl Spread for Anywhere {
    fn far_apart(&self, _: usize, _: usize) -> bool {
        true
    }
}

impl<F: Fn(usize, usize) -> bool + Sync> Spread for F {
    fn far_apart(&self, one: usize, other: usize) -> bool {
        self(one, other)
    }
}

impl<N: Neighbourhood> Local<N> {
    /// Samples of a uniform datum and its neighbours, each equally likely.
    pub fn new(neighbourhood: N) -> Self {
        Self {
            neighbourhood,
            far_apart: Anywhere,
        }
    }
}

impl<N, D> Local<N, D> {
    /// Takes only data that are pairwise `far_apart`.
    #[must_use]
    pub fn spread<G: Spread>(self, far_apart: G) -> Local<N, G> {
        Local {
            neighbourhood: self.neighbourhood,
            far_apart,
        }
    }
}

thread_local! {
    /// Neighbours of one datum; what it holds between calls is of no consequence.
    static NEAR: std::cell::RefCell<Vec<usize>> = const { std::cell::RefCell::new(Vec::new()) };
}

impl<E: Estimator, N: Neighbourhood, D: Spread> Sampler<E> for Local<N, D> {
    fn sample(&self, estimator: &E, _: u64, draws: &mut Draws, sample: &mut [usize]) -> bool {
        let len = estimator.len();
        let Some((first, others)) = sample.split_first_mut() else {
            return false;
        };
        if len == 0 {
            return false;
        }
        *first = draws.below(len);
        // The list leaves its place while the caller's function runs, which may sample in turn.
        let mut near = NEAR.take();
        near.clear();
        self.neighbourhood.neighbours(*first, &mut near);
        let found = self.pick(draws, *first, others, len, &mut near);
        NEAR.set(near);
        found
    }
}

impl<N, D: Spread> Local<N, D> {
    /// Takes the others of a sample out of `near` one by one, each equally likely among those left.
    fn pick(
        &self,
        draws: &mut Draws,
        first: usize,
        others: &mut [usize],
        len: usize,
        near: &mut Vec<usize>,
    ) -> bool {
        for taken in 0..others.len() {
            let pick = loop {
                if near.is_empty() {
                    return false;
                }
                let pick = near.swap_remove(draws.below(near.len()));
                let fits = |other: usize| pick != other && self.far_apart.far_apart(pick, other);
                if pick < len && fits(first) && others[..taken].iter().all(|&o| fits(o)) {
                    break pick;
                }
            };
            others[taken] = pick;
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::super::sampling::tests::Numbers;
    use super::*;

    fn within_two(datum: usize, out: &mut Vec<usize>) {
        out.extend(datum.saturating_sub(2)..=datum + 2);
    }

    #[test]
    fn samples_are_distinct_neighbours() {
        let sampler = Local::new(within_two);
        let mut seen = [0; 50];
        for i in 0..1000 {
            let mut s = [0; 3];
            assert!(sampler.sample(&Numbers(50), i, &mut Draws::new(1, i), &mut s));
            assert!(s[1].abs_diff(s[0]) <= 2 && s[2].abs_diff(s[0]) <= 2);
            assert!(s[0] != s[1] && s[1] != s[2] && s[0] != s[2]);
            assert!(s.iter().all(|&d| d < 50));
            seen[s[0]] += 1;
        }
        assert!(seen.iter().all(|&n| n > 0));
    }

    #[test]
    fn a_spread_is_kept_or_no_sample_given() {
        let apart = |least: usize| {
            Local::new(within_two).spread(move |a: usize, b: usize| a.abs_diff(b) >= least)
        };
        let mut found = 0;
        for i in 0..500 {
            let mut s = [0; 3];
            if apart(2).sample(&Numbers(50), i, &mut Draws::new(1, i), &mut s) {
                found += 1;
                s.sort_unstable();
                assert!(s[0] + 2 <= s[1] && s[1] + 2 <= s[2]);
            }
            assert!(!apart(3).sample(&Numbers(50), i, &mut Draws::new(1, i), &mut s));
        }
        assert!(found > 200);
    }

    #[test]
    fn nothing_near_gives_no_sample() {
        let alone = Local::new(|_: usize, _: &mut Vec<usize>| ());
        assert!(!alone.sample(&Numbers(9), 0, &mut Draws::new(0, 0), &mut [0; 3]));
        assert!(!alone.sample(&Numbers(0), 0, &mut Draws::new(0, 0), &mut [0; 3]));
    }
}
