use crate::HeldRefit;
use thiserror::Error;

/// A window whose bounds are inverted, negative or not finite.
#[derive(Clone, Debug, Error, PartialEq)]
#[error("a window from {min} to {max}: give 0 ≤ min < max, both finite")]
#[non_exhaustive]
pub struct WindowError {
    /// Lower bound given.
    pub min: f64,
    /// Upper bound given.
    pub max: f64,
}

/// How far within its window a refit is held, as a fraction of the window's width: more than the
/// rounding with which it is held, so that the refit is allowed.
const INSET: f64 = 1e-9;

/// Values from `min` to `max`, both included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Window {
    min: f64,
    max: f64,
}

impl Window {
    pub(crate) fn new(min: f64, max: f64) -> Result<Self, WindowError> {
        if 0.0 <= min && min < max && max.is_finite() {
            Ok(Self { min, max })
        } else {
            Err(WindowError { min, max })
        }
    }

    /// Never for NaN.
    #[inline]
    pub(crate) fn contains(&self, value: f64) -> bool {
        (self.min..=self.max).contains(&value)
    }

    /// Whether the root of `square` is contained, without taking it.
    #[inline]
    pub(crate) fn contains_root_of(&self, square: f64) -> bool {
        (self.min * self.min..=self.max * self.max).contains(&square)
    }

    /// The best fit for which `quantity` has the bound that the refit `left` has crossed.
    pub(crate) fn restore<E: HeldRefit>(
        &self,
        estimator: &E,
        inliers: &[usize],
        weights: Option<&[f64]>,
        left: &E::Model,
        quantity: impl Fn(&E::Model) -> f64,
    ) -> Option<E::Model> {
        let value = quantity(left);
        let width = self.max - self.min;
        let bound = if value < self.min {
            self.min + INSET * width
        } else if value > self.max {
            self.max - INSET * width
        } else {
            return None;
        };
        let condition = |model: &E::Model| (quantity(model) - bound) / width;
        estimator.refit_held(inliers, weights, left, &condition)
    }
}
