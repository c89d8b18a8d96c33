use super::kernel::{Kernel as _, Marginal, Quadratic};
use crate::{Estimator, Look, Lossless, Preemption, estimator::blocks};
use std::ops::Range;

/// How far from a model a datum may lie and still support it.
///
/// A plain number is the same distance for every model; a closure
/// computes it from the model, `|sphere: &Sphere| sphere.radius / 5.0` say.
pub trait Threshold<M>: Sync {
    /// The distance for `model`.
    fn for_model(&self, model: &M) -> f64;
}

impl<M> Threshold<M> for f64 {
    fn for_model(&self, _: &M) -> f64 {
        *self
    }
}

impl<M, F: Fn(&M) -> f64 + Sync> Threshold<M> for F {
    fn for_model(&self, model: &M) -> f64 {
        self(model)
    }
}

/// Says how well a model explains the data: the sum of a gain of at most 1 for each datum, and of the model's
/// [`prior`](Self::prior).
///
/// More is better. That no datum gains more than 1 is what bounds a score from
/// above while part of the data is still unseen. A datum that contradicts a model may gain less than 0, but not
/// under [`Statistical`](crate::Statistical) preemption, whose guarantee is for gains between 0 and 1.
pub trait Scorer<E: Estimator>: Sync {
    /// Whether each datum gains 0 or 1, so that a score is a number of inliers; `false` by default.
    ///
    /// [`Statistical`](crate::Statistical) gives a hopeless model up earlier where it is `true`.
    const COUNTS: bool = false;

    /// Sum of the gains of the data of `block`, at most [`BLOCK`](crate::BLOCK) of them.
    fn block_gain(&self, estimator: &E, model: &E::Model, block: Range<usize>) -> f64;

    /// What the score of `model` is before any datum is seen, in units of a datum's largest gain; 0 by default.
    ///
    /// A model whose prior is not finite is never taken. See [`WithPrior`](crate::WithPrior).
    fn prior(&self, _estimator: &E, _model: &E::Model) -> f64 {
        0.0
    }

    /// The largest residual of an inlier of `model`.
    fn threshold(&self, model: &E::Model) -> f64;

    /// The largest residual with which `datum` is an inlier of `model`.
    fn threshold_of(&self, model: &E::Model, _datum: usize) -> f64 {
        self.threshold(model)
    }

    /// How much a datum counts, between 0 and 1.
    fn weight_of(&self, _datum: usize) -> f64 {
        1.0
    }

    /// Gain of a datum of weight 1 whose residual is `fraction` of its threshold, between 0 and 1; 1, that of
    /// an inlier that counts as one, by default.
    ///
    /// A [`Competition`](crate::Competition) shares out the data by it. Times
    /// [`weight_of`](Self::weight_of) and summed over the inliers it must be the score, less the prior.
    fn gain_at(&self, _fraction: f64) -> f64 {
        1.0
    }

    /// The most that the data of `range`, of any length, can gain: one each unless the scorer knows better.
    fn most_gain(&self, _estimator: &E, range: Range<usize>) -> f64 {
        range.len() as f64
    }

    /// The fraction of its threshold, from 0 to 1, that the residual of an inlier is.
    fn fraction_of(&self, model: &E::Model, datum: usize, residual: f64) -> f64 {
        fraction(residual, self.threshold_of(model, datum))
    }

    /// The score of `model` where it exceeds `bound`.
    ///
    /// Gives up as soon as it is certain that it does not.
    fn score(&self, estimator: &E, model: &E::Model, bound: f64) -> Option<f64> {
        let data = estimator.len();
        let prior = self.prior(estimator, model);
        if !prior.is_finite() {
            return None;
        }
        let mut gain = 0.0;
        for block in blocks(data) {
            let seen = block.end;
            gain += self.block_gain(estimator, model, block);
            let most_left = self.most_gain(estimator, seen..data);
            let look = Look {
                seen,
                data,
                gain,
                most_left,
                counts: Self::COUNTS,
            };
            if Lossless::default().gives_up(&look, bound - prior) {
                return None;
            }
        }
        let score = prior + gain;
        (score > bound).then_some(score)
    }

    /// How many inliers `model` has.
    fn count(&self, estimator: &E, model: &E::Model) -> usize {
        let threshold = self.threshold(model);
        blocks(estimator.len())
            .map(|block| estimator.count_within(model, block, threshold))
            .sum()
    }

    /// Replaces `out` by the inliers of `model`, in ascending order.
    fn select(&self, estimator: &E, model: &E::Model, out: &mut Vec<usize>) {
        out.clear();
        let threshold = self.threshold(model);
        for block in blocks(estimator.len()) {
            estimator.select_within(model, block, threshold, out);
        }
    }
}

/// An inlier's residual as a fraction of its threshold: 0 for no residual, whatever the threshold, and 1 for
/// an infinite one of an infinite threshold, or where a comparison of squares let one through that is
/// a rounding too large.
pub(super) fn fraction(residual: f64, threshold: f64) -> f64 {
    if residual > 0.0 {
        (residual / threshold).min(1.0)
    } else {
        0.0
    }
}

/// Each inlier gains 1: the score of the original RANSAC (Fischler and Bolles 1981).
#[derive(Clone, Copy, Debug)]
pub struct InlierCount<T> {
    threshold: T,
}

impl<T> InlierCount<T> {
    /// Inliers are the data with a residual of at most `threshold`.
    pub fn within(threshold: T) -> Self {
        Self { threshold }
    }
}

impl<E: Estimator, T: Threshold<E::Model>> Scorer<E> for InlierCount<T> {
    const COUNTS: bool = true;

    fn block_gain(&self, estimator: &E, model: &E::Model, block: Range<usize>) -> f64 {
        estimator.count_within(model, block, self.threshold.for_model(model)) as f64
    }

    fn threshold(&self, model: &E::Model) -> f64 {
        self.threshold.for_model(model)
    }
}

/// An inlier gains 1 − (residual/threshold)²: the truncated quadratic of
/// MSAC (Torr and Zisserman 2000, section 5, doi 10.1006/cviu.1999.0832), turned so that more is better.
#[derive(Clone, Copy, Debug)]
pub struct Msac<T> {
    threshold: T,
}

impl<T> Msac<T> {
    /// Data gain up to a residual of `threshold`.
    pub fn within(threshold: T) -> Self {
        Self { threshold }
    }
}

impl<E: Estimator, T: Threshold<E::Model>> Scorer<E> for Msac<T> {
    fn block_gain(&self, estimator: &E, model: &E::Model, block: Range<usize>) -> f64 {
        estimator.truncated_gain(model, block, self.threshold.for_model(model))
    }

    fn gain_at(&self, fraction: f64) -> f64 {
        Quadratic.gain(fraction)
    }

    fn threshold(&self, model: &E::Model) -> f64 {
        self.threshold.for_model(model)
    }
}

/// An inlier gains what [`Marginal`] gives it: a score that cares little how large the threshold is.
#[derive(Clone, Copy, Debug)]
pub struct MarginalScore<T> {
    threshold: T,
}

impl<T> MarginalScore<T> {
    /// Data gain up to a residual of `threshold`, which belongs to the largest noise thought of.
    pub fn within(threshold: T) -> Self {
        Self { threshold }
    }
}

impl<E: Estimator, T: Threshold<E::Model>> Scorer<E> for MarginalScore<T> {
    fn block_gain(&self, estimator: &E, model: &E::Model, block: Range<usize>) -> f64 {
        let threshold = self.threshold.for_model(model);
        estimator.fold_residuals(model, block, 0.0, |gain, _, residual| {
            if residual <= threshold {
                gain + Marginal.gain(fraction(residual, threshold))
            } else {
                gain
            }
        })
    }

    fn gain_at(&self, fraction: f64) -> f64 {
        Marginal.gain(fraction)
    }

    fn threshold(&self, model: &E::Model) -> f64 {
        self.threshold.for_model(model)
    }
}
