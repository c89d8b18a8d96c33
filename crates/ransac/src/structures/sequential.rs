use crate::{RansacError, Report};

/// Finds one structure after the other: searches, takes the inliers out, and searches what is left.
///
/// The caller's function searches among the data whose numbers it is given, and numbers them
/// anew from 0: it copies these out of its arrays, so that scoring still reads them in a row, and brings
/// whatever else goes by the number of a datum (weights, neighbours) along. The reports come back in
/// the numbers of all data.
///
/// The order is greedy: the largest structure first takes every datum near it, also those that lie
/// nearer to another. A [`Competition`](crate::Competition) among the models found sets that right.
///
/// ```
/// use pomona_ransac::{Candidates, Estimator, InlierCount, Ransac, Sequential};
/// use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
/// use std::ops::Range;
///
/// /// Numbers that agree.
/// struct Numbers(Vec<f64>);
///
/// impl Estimator for Numbers {
///     type Model = f64;
///     const SAMPLE_SIZE: usize = 1;
///     fn len(&self) -> usize { self.0.len() }
///     fn fit(&self, sample: &[usize], candidates: &mut Candidates<f64>) {
///         candidates.push(self.0[sample[0]]);
///     }
///     fn refit(&self, inliers: &[usize], _: &f64) -> Option<f64> {
///         Some(inliers.iter().map(|&i| self.0[i]).sum::<f64>() / inliers.len() as f64)
///     }
///     fn residuals(&self, model: &f64, block: Range<usize>, out: &mut [f64]) {
///         for (r, i) in out.iter_mut().zip(block) { *r = (self.0[i] - model).abs(); }
///     }
/// }
///
/// let all = [5.0, 1.0, 5.1, 9.9, 1.1, 5.2, 1.0];
/// let search = Ransac::new(InlierCount::within(0.2));
/// let mut rng = ChaCha8Rng::seed_from_u64(1);
/// let found = Sequential::default().min_inliers(2).run(all.len(), |left| {
///     search.run(&Numbers(left.iter().map(|&i| all[i]).collect()), &mut rng)
/// });
/// assert_eq!(found.structures.len(), 2);
/// assert_eq!(found.structures[1].inliers, [1, 4, 6]);
/// assert_eq!(found.rest, [3]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sequential {
    max_structures: usize,
    min_inliers: usize,
    min_share: f64,
}

impl Default for Sequential {
    /// As many structures as the searches find.
    fn default() -> Self {
        Self {
            max_structures: usize::MAX,
            min_inliers: 1,
            min_share: 0.0,
        }
    }
}

/// Why a [`Sequential`] search ended.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Ended {
    /// As many structures were found as were wanted.
    Enough,
    /// The next structure had so few inliers; it is not among those found.
    TooSmall {
        /// Its inliers.
        inliers: usize,
        /// The least number wanted.
        needed: usize,
    },
    /// The caller wanted no more; the structure that made the decision is not among those found.
    Refused,
    /// The next search gave no model: too few data were left, or none agreed. For the first
    /// search this is the error of an ordinary one.
    NoModel(RansacError),
}

/// What a [`Sequential`] search found.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Extraction<M> {
    /// One report for each structure, in the order found; inliers are numbers of all data, and of no
    /// other structure. Scores and confidences are those among the data that were left at the time.
    pub structures: Vec<Report<M>>,
    /// The data of no structure, ascending.
    pub rest: Vec<usize>,
    /// Why there is no further structure.
    pub ended: Ended,
}

impl Sequential {
    /// Finds at most `count` structures.
    #[must_use]
    pub fn max_structures(self, count: usize) -> Self {
        Self {
            max_structures: count,
            ..self
        }
    }

    /// Ends at the first structure with fewer inliers; 0 is taken as 1.
    #[must_use]
    pub fn min_inliers(self, inliers: usize) -> Self {
        Self {
            min_inliers: inliers.max(1),
            ..self
        }
    }

    /// Ends at the first structure with fewer inliers than this share of all data. One that is
    /// negative or NaN is taken as 0.
    #[must_use]
    pub fn min_share(self, share: f64) -> Self {
        Self {
            min_share: share.max(0.0),
            ..self
        }
    }

    /// Searches `data` data by `search`, which is given the numbers of those left, ascending.
    ///
    /// Each round takes out one datum at least, so that it ends whatever `search` gives.
    pub fn run<M>(
        &self,
        data: usize,
        search: impl FnMut(&[usize]) -> Result<Report<M>, RansacError>,
    ) -> Extraction<M> {
        self.run_while(data, search, |_, _| true)
    }

    /// The same for as long as the caller wants: `wanted` is asked with those found and the next one.
    pub fn run_while<M>(
        &self,
        data: usize,
        mut search: impl FnMut(&[usize]) -> Result<Report<M>, RansacError>,
        mut wanted: impl FnMut(&[Report<M>], &Report<M>) -> bool,
    ) -> Extraction<M> {
        // A product that is too large for a number saturates, and then nothing is large enough.
        let share = (self.min_share * data as f64).ceil() as usize;
        let needed = self.min_inliers.max(share);
        let mut structures = Vec::new();
        let mut rest: Vec<usize> = (0..data).collect();
        let ended = loop {
            if structures.len() >= self.max_structures {
                break Ended::Enough;
            }
            let mut report = match search(&rest) {
                Ok(report) => report,
                Err(error) => break Ended::NoModel(error),
            };
            restore(&mut report.inliers, &rest);
            let inliers = report.inliers.len();
            if inliers < needed {
                break Ended::TooSmall { inliers, needed };
            }
            if !wanted(&structures, &report) {
                break Ended::Refused;
            }
            let mut taken = report.inliers.iter().peekable();
            rest.retain(|datum| taken.next_if_eq(&datum).is_none());
            structures.push(report);
        };
        Extraction {
            structures,
            rest,
            ended,
        }
    }
}

/// Turns positions in `left` into the numbers that stand there, ascending; drops those past the end.
fn restore(positions: &mut Vec<usize>, left: &[usize]) {
    positions.sort_unstable();
    positions.dedup();
    positions.retain_mut(|position| {
        let original = left.get(*position);
        *position = original.copied().unwrap_or_default();
        original.is_some()
    });
}
