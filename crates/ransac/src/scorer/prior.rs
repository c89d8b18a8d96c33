use super::scoring::Scorer;
use crate::Estimator;
use std::ops::Range;

/// A score and what is known of the model itself: a penalty for what is improbable, a bonus for what is likely.
///
/// The prior is in units of a datum's largest gain. A model that its prior keeps below the best, whatever the
/// data gain, is abandoned before any of them is measured.
///
/// A [`Constraint`](crate::Constraint) is for what cannot be, a prior for what is improbable. Refits do not heed the prior,
/// but a refit is scored with it. A [`Competition`](crate::Competition) compares gains alone.
///
/// ```
/// use pomona_ransac::{Msac, Ransac, WithPrior};
///
/// struct Circle { radius: f64 }
///
/// // Radii of 40 ± 6 mm: each standard deviation costs as much as a few inliers bring.
/// let typical = |circle: &Circle| -3.0 * ((circle.radius - 0.040) / 0.006).powi(2);
/// let search = Ransac::new(WithPrior::new(Msac::within(0.003), typical));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct WithPrior<S, F> {
    scorer: S,
    prior: F,
}

impl<S, F> WithPrior<S, F> {
    /// Adds `prior` of a model to its score by `scorer`. A model whose prior is not finite is never taken.
    pub fn new(scorer: S, prior: F) -> Self {
        Self { scorer, prior }
    }
}

impl<E: Estimator, S: Scorer<E>, F: Fn(&E::Model) -> f64 + Sync> Scorer<E> for WithPrior<S, F> {
    fn prior(&self, estimator: &E, model: &E::Model) -> f64 {
        self.scorer.prior(estimator, model) + (self.prior)(model)
    }

    fn block_gain(&self, estimator: &E, model: &E::Model, block: Range<usize>) -> f64 {
        self.scorer.block_gain(estimator, model, block)
    }

    fn threshold(&self, model: &E::Model) -> f64 {
        self.scorer.threshold(model)
    }

    fn threshold_of(&self, model: &E::Model, datum: usize) -> f64 {
        self.scorer.threshold_of(model, datum)
    }

    fn weight_of(&self, datum: usize) -> f64 {
        self.scorer.weight_of(datum)
    }

    fn gain_at(&self, fraction: f64) -> f64 {
        self.scorer.gain_at(fraction)
    }

    fn most_gain(&self, estimator: &E, range: Range<usize>) -> f64 {
        self.scorer.most_gain(estimator, range)
    }

    fn fraction_of(&self, model: &E::Model, datum: usize, residual: f64) -> f64 {
        self.scorer.fraction_of(model, datum, residual)
    }

    fn count(&self, estimator: &E, model: &E::Model) -> usize {
        self.scorer.count(estimator, model)
    }

    fn select(&self, estimator: &E, model: &E::Model, out: &mut Vec<usize>) {
        self.scorer.select(estimator, model, out);
    }
}
