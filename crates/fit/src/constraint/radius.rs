use super::window::{Window, WindowError};
use crate::{HeldRefit, Round};
use pomona_ransac::Constraint;

/// Spheres, cylinders, capsules and circles must have a radius between two bounds, which belong to the window.
///
/// A refit that leaves the window becomes the best fit with the radius of the bound it crossed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RadiusWindow(Window);

impl RadiusWindow {
    /// Radii from `min` to `max`.
    ///
    /// # Errors
    ///
    /// Unless 0 ≤ `min` < `max` and both are finite.
    pub fn new(min: f64, max: f64) -> Result<Self, WindowError> {
        Window::new(min, max).map(Self)
    }
}

impl<E: HeldRefit<Model: Round>> Constraint<E> for RadiusWindow {
    fn name(&self) -> &'static str {
        "radius window"
    }

    fn allows_model(&self, _: &E, model: &E::Model) -> bool {
        self.0.contains(model.radius())
    }

    fn restore(
        &self,
        estimator: &E,
        inliers: &[usize],
        weights: Option<&[f64]>,
        refit: &E::Model,
    ) -> Option<E::Model> {
        self.0
            .restore(estimator, inliers, weights, refit, Round::radius)
    }
}
