use super::window::{Window, WindowError};
use crate::{HeldRefit, Straight};
use nalgebra::Point3;
use pomona_ransac::Constraint;

/// Lines, and the axes of cylinders and capsules, must pass a point at a distance between two
/// bounds, which belong to the window.
///
/// A refit that leaves the window becomes the best fit that passes at the distance of the bound it crossed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DistanceWindow {
    point: Point3<f64>,
    window: Window,
}

impl DistanceWindow {
    /// Axes that pass `point` at a distance from `min` to `max`.
    ///
    /// # Errors
    ///
    /// Unless 0 ≤ `min` < `max` and both are finite.
    pub fn new(point: Point3<f64>, min: f64, max: f64) -> Result<Self, WindowError> {
        Window::new(min, max).map(|window| Self { point, window })
    }

    #[inline]
    fn distance(&self, model: &impl Straight) -> f64 {
        (model.nearest(&self.point) - self.point).norm()
    }
}

impl<E: HeldRefit<Model: Straight>> Constraint<E> for DistanceWindow {
    fn name(&self) -> &'static str {
        "distance window"
    }

    fn allows_model(&self, _: &E, model: &E::Model) -> bool {
        let square = (model.nearest(&self.point) - self.point).norm_squared();
        self.window.contains_root_of(square)
    }

    fn restore(
        &self,
        estimator: &E,
        inliers: &[usize],
        weights: Option<&[f64]>,
        refit: &E::Model,
    ) -> Option<E::Model> {
        self.window
            .restore(estimator, inliers, weights, refit, |m| self.distance(m))
    }
}
