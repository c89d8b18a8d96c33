use crate::constraint::allowed;
use crate::{Constraints, Counts, Estimator, Scorer, report::for_each_residual};

/// A model with its score.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scored<M> {
    /// The model.
    pub model: M,
    /// Its score.
    pub score: f64,
}

/// What a [`LocalOptimization`] may do: select inliers, refit under the constraints, score.
pub struct Refiner<'a, E: Estimator, S, C> {
    pub(crate) estimator: &'a E,
    pub(crate) scorer: &'a S,
    pub(crate) constraints: &'a C,
    pub(crate) inliers: &'a mut Vec<usize>,
    pub(crate) weights: &'a mut Vec<f64>,
    pub(crate) counts: &'a mut Counts,
    pub(crate) latest: &'a mut Option<Refitted<E::Model>>,
}

/// A model and what became of it when it was refitted to its inliers.
pub(crate) struct Refitted<M> {
    of: M,
    to: Option<M>,
}

impl<E: Estimator, S: Scorer<E>, C: Constraints<E>> Refiner<'_, E, S, C> {
    /// The model refitted to its own inliers; `None` where they do not
    /// determine one or a constraint refuses it.
    ///
    /// A model that was the last to be refitted is not refitted again, where the estimator knows it for
    /// [the same](Estimator::same_model): what came of it comes again.
    pub fn refit(&mut self, model: &E::Model) -> Option<E::Model> {
        if let Some(latest) = &*self.latest
            && self.estimator.same_model(&latest.of, model)
        {
            return latest.to.clone();
        }
        self.scorer.select(self.estimator, model, self.inliers);
        let refitted = self.estimator.refit(self.inliers, model);
        let to = self.allow(refitted, false);
        *self.latest = Some(Refitted {
            of: model.clone(),
            to: to.clone(),
        });
        to
    }

    /// The model refitted to its own inliers, each with the weight `weigh(residual/threshold)`
    /// times its weight in the score; `None` as for [`refit`](Self::refit).
    pub fn refit_weighted(
        &mut self,
        model: &E::Model,
        weigh: impl Fn(f64) -> f64,
    ) -> Option<E::Model> {
        let Self {
            estimator,
            scorer,
            inliers,
            weights,
            ..
        } = self;
        scorer.select(estimator, model, inliers);
        weights.clear();
        for_each_residual(*estimator, model, inliers, |datum, residual| {
            let fraction = scorer.fraction_of(model, datum, residual);
            weights.push(scorer.weight_of(datum) * weigh(fraction));
        });
        let refitted = estimator.refit_weighted(inliers, weights, model);
        self.allow(refitted, true)
    }

    /// Counts a refit, and asks the constraints again; one that refuses it may restore it.
    fn allow(&mut self, refitted: Option<E::Model>, weighted: bool) -> Option<E::Model> {
        self.counts.refits += 1;
        let refitted = refitted?;
        let weights = weighted.then_some(self.weights.as_slice());
        allowed(
            self.constraints,
            self.estimator,
            self.inliers,
            weights,
            refitted,
        )
        .inspect_err(|&rule| self.counts.rejection(rule).refits += 1)
        .ok()
    }

    /// The score of a model where it exceeds `bound`.
    pub fn score(&self, model: &E::Model, bound: f64) -> Option<f64> {
        self.scorer.score(self.estimator, model, bound)
    }
}

/// Improves a model by refitting it to its inliers.
pub trait LocalOptimization<E: Estimator> {
    /// Called for each new best model of the search; leaves it as it is by default.
    fn improve<S: Scorer<E>, C: Constraints<E>>(
        &self,
        _refiner: &mut Refiner<'_, E, S, C>,
        best: Scored<E::Model>,
    ) -> Scored<E::Model> {
        best
    }

    /// Called at the end, for the best model of all and then for each of the
    /// [`runners_up`](Self::runners_up); the highest score that comes out is the outcome.
    fn finish<S: Scorer<E>, C: Constraints<E>>(
        &self,
        refiner: &mut Refiner<'_, E, S, C>,
        best: Scored<E::Model>,
    ) -> Scored<E::Model>;

    /// How many of the best other hypotheses the search keeps for the end, 1000 at most; none by default.
    fn runners_up(&self) -> usize {
        0
    }

    /// Share of the best score, from 0 to 1, that a runner-up exceeds; asked where any are kept.
    fn near(&self) -> f64 {
        1.0
    }
}

/// Leaves the best hypothesis as it was drawn.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoRefit;

impl<E: Estimator> LocalOptimization<E> for NoRefit {
    fn finish<S: Scorer<E>, C: Constraints<E>>(
        &self,
        _: &mut Refiner<'_, E, S, C>,
        best: Scored<E::Model>,
    ) -> Scored<E::Model> {
        best
    }
}

/// Refits the best hypothesis once to its inliers, and takes the result even
/// where its score is lower; only a constraint can refuse it.
#[derive(Clone, Copy, Debug, Default)]
pub struct RefitOnce;

impl<E: Estimator> LocalOptimization<E> for RefitOnce {
    fn finish<S: Scorer<E>, C: Constraints<E>>(
        &self,
        refiner: &mut Refiner<'_, E, S, C>,
        best: Scored<E::Model>,
    ) -> Scored<E::Model> {
        let Some(model) = refiner.refit(&best.model) else {
            return best;
        };
        // A score that is not a number is none.
        match refiner.score(&model, f64::NEG_INFINITY) {
            Some(score) => Scored { model, score },
            None => best,
        }
    }
}

/// One local optimisation in the search, and another after it at the end.
///
/// `Then(LeastSquares::default(), RefitOnce)` climbs the score as long as it grows and gives the least-squares fit to
/// the final inliers, even where its score is a little lower. Under [`InlierCount`](crate::InlierCount) that model is the
/// more accurate one: a count says nothing of how far off the inliers lie.
#[derive(Clone, Copy, Debug, Default)]
pub struct Then<First, Last>(pub First, pub Last);

impl<E: Estimator, A: LocalOptimization<E>, B: LocalOptimization<E>> LocalOptimization<E>
    for Then<A, B>
{
    fn improve<S: Scorer<E>, C: Constraints<E>>(
        &self,
        refiner: &mut Refiner<'_, E, S, C>,
        best: Scored<E::Model>,
    ) -> Scored<E::Model> {
        self.0.improve(refiner, best)
    }

    fn finish<S: Scorer<E>, C: Constraints<E>>(
        &self,
        refiner: &mut Refiner<'_, E, S, C>,
        best: Scored<E::Model>,
    ) -> Scored<E::Model> {
        let climbed = self.0.finish(refiner, best);
        self.1.finish(refiner, climbed)
    }

    fn runners_up(&self) -> usize {
        self.0.runners_up()
    }

    fn near(&self) -> f64 {
        self.0.near()
    }
}

/// Refits each new best model to its inliers again and again, as long as the score grows.
#[derive(Clone, Copy, Debug)]
pub struct LeastSquares {
    max_rounds: usize,
}

impl Default for LeastSquares {
    /// At most ten rounds.
    fn default() -> Self {
        Self { max_rounds: 10 }
    }
}

impl LeastSquares {
    /// At most `max_rounds` refits in a row.
    pub fn rounds(max_rounds: usize) -> Self {
        Self { max_rounds }
    }

    fn climb<E: Estimator, S: Scorer<E>, C: Constraints<E>>(
        self,
        refiner: &mut Refiner<'_, E, S, C>,
        mut best: Scored<E::Model>,
    ) -> Scored<E::Model> {
        for _ in 0..self.max_rounds {
            let Some(model) = refiner.refit(&best.model) else {
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

impl<E: Estimator> LocalOptimization<E> for LeastSquares {
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
