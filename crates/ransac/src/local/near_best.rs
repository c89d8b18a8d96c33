use super::optimization::{LocalOptimization, Refiner, Scored};
use crate::{Constraints, Estimator, Scorer};

/// Improves not only each new best model, as `L` does, but at the end also the best hypotheses that
/// were near it, and takes the best of what comes out.
///
/// A hypothesis of noisy data is a poor copy of the model behind it, and chance decides
/// which copy scores best (Chum, Matas and Kittler 2003, doi 10.1007/978-3-540-45243-0_31; Lebeda, Matas and Chum 2012,
/// doi 10.5244/C.26.95). Where two structures are close in size, or a wrong model gathers part of two, the best
/// hypothesis may belong to the worse one, and no refit of it alone leads to the other.
///
/// The search keeps the highest scores, of hypotheses that differ: of two whose inliers
/// share four fifths of their union, the better is kept. Each is then refitted to convergence under the
/// constraints by `L`'s [`finish`](LocalOptimization::finish). With a lossless bound the score is never below that of `L` alone.
/// Models can be abandoned only below the share of the best score that is still near, or below all runners-up once
/// there are as many as wanted, and so later.
///
/// ```
/// use pomona_ransac::{LeastSquares, Msac, NearBest, Ransac};
///
/// let search = Ransac::new(Msac::within(0.1))
///     .local_optimization(NearBest::new(LeastSquares::default()).models(4));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct NearBest<L> {
    inner: L,
    models: usize,
    share: f64,
}

impl<L> NearBest<L> {
    /// Refits by `inner`; the 8 best hypotheses with at least half the best score.
    pub fn new(inner: L) -> Self {
        Self {
            inner,
            models: 8,
            share: 0.5,
        }
    }

    /// Refits at most `models` hypotheses beside the best; more than 1000 are taken as 1000.
    #[must_use]
    pub fn models(self, models: usize) -> Self {
        Self { models, ..self }
    }

    /// Refits those whose score is more than `share` of the best; taken as 0 below 0, and as 1, which
    /// none exceeds, above 1 or for NaN.
    #[must_use]
    pub fn share(self, share: f64) -> Self {
        let share = if share < 1.0 { share.max(0.0) } else { 1.0 };
        Self { share, ..self }
    }
}

impl<E: Estimator, L: LocalOptimization<E>> LocalOptimization<E> for NearBest<L> {
    fn improve<S: Scorer<E>, C: Constraints<E>>(
        &self,
        refiner: &mut Refiner<'_, E, S, C>,
        best: Scored<E::Model>,
    ) -> Scored<E::Model> {
        self.inner.improve(refiner, best)
    }

    fn finish<S: Scorer<E>, C: Constraints<E>>(
        &self,
        refiner: &mut Refiner<'_, E, S, C>,
        best: Scored<E::Model>,
    ) -> Scored<E::Model> {
        self.inner.finish(refiner, best)
    }

    fn runners_up(&self) -> usize {
        self.models
    }

    fn near(&self) -> f64 {
        self.share
    }
}
