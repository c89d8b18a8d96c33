use super::optimization::{LocalOptimization, Refiner, Scored};
use crate::{Constraints, Estimator, Scorer};

/// Refits each new best model with weights that fall with the residual, again and again, as long as
/// the score grows: iteratively reweighted least squares (Holland and Welsch 1977,
/// doi 10.1080/03610927708827533).
///
/// The weight is a function of u = residual/threshold, from 0 to 1. Refits climb the score where the
/// weights belong to it, w(u) ∝ −gain′(u)/u: [`Tukey::weight`] with the kernel [`Tukey`],
/// [`Marginal::weight`] with [`Marginal`](crate::Marginal). With weights that belong to another score the
/// climb ends early, at the first refit that this score likes less. Those of [`Msac`](crate::Msac) are all 1, which
/// is [`LeastSquares`](crate::LeastSquares).
///
/// The estimator must have a [`refit_weighted`](Estimator::refit_weighted) of its own, or the
/// weights are ignored.
///
/// ```
/// use pomona_ransac::{Marginal, MarginalScore, Ransac, Reweighted};
///
/// let search = Ransac::new(MarginalScore::within(0.1))
///     .local_optimization(Reweighted::by(Marginal::weight));
/// ```
///
/// [`Tukey`]: crate::Tukey
/// [`Tukey::weight`]: crate::Tukey::weight
/// [`Marginal::weight`]: crate::Marginal::weight
#[derive(Clone, Copy, Debug)]
pub struct Reweighted<W> {
    weigh: W,
    max_rounds: usize,
}

impl<W: Fn(f64) -> f64 + Sync> Reweighted<W> {
    /// Weights by a function of the caller's, which gives no negative number; at most ten rounds.
    pub fn by(weigh: W) -> Self {
        Self {
            weigh,
            max_rounds: 10,
        }
    }

    /// At most `max_rounds` refits in a row.
    #[must_use]
    pub fn rounds(self, max_rounds: usize) -> Self {
        Self { max_rounds, ..self }
    }

    fn climb<E: Estimator, S: Scorer<E>, C: Constraints<E>>(
        &self,
        refiner: &mut Refiner<'_, E, S, C>,
        mut best: Scored<E::Model>,
    ) -> Scored<E::Model> {
        for _ in 0..self.max_rounds {
            let Some(model) = refiner.refit_weighted(&best.model, &self.weigh) else {
                break;
            };
            let Some(score) = refiner.score(&model, best.score) else {
                break;
            };
            best = Scored { model, score };
        }
        best
    }
}

impl<E: Estimator, W: Fn(f64) -> f64 + Sync> LocalOptimization<E> for Reweighted<W> {
    fn improve<S: Scorer<E>, C: Constraints<E>>(
        &self,
        refiner: &mut Refiner<'_, E, S, C>,
        best: Scored<E::Model>,
    ) -> Scored<E::Model> {
        self.climb(refiner, best)
    }

    fn finish<S: Scorer<E>, C: Constraints<E>>(
        &self,
        refiner: &mut Refiner<'_, E, S, C>,
        best: Scored<E::Model>,
    ) -> Scored<E::Model> {
        self.climb(refiner, best)
    }
}
