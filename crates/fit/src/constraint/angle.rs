use super::window::{Window, WindowError};
use crate::{Directed, HeldRefit};
use nalgebra::{Unit, Vector3};
use pomona_geometry::angle_between_axes;
use pomona_ransac::Constraint;

/// Lines, normals of planes and circles, and the axes of cylinders and capsules must make an angle with a
/// direction between two bounds, which belong to the window. Neither has a sign: angles are in `0..=π/2` rad.
///
/// A refit that leaves the window becomes the best fit at the angle of the bound it crossed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AngleWindow {
    direction: Unit<Vector3<f64>>,
    window: Window,
}

impl AngleWindow {
    /// Directions at an angle from `min` to `max` radians to `direction`.
    ///
    /// # Errors
    ///
    /// Unless 0 ≤ `min` < `max` and both are finite.
    pub fn new(direction: Unit<Vector3<f64>>, min: f64, max: f64) -> Result<Self, WindowError> {
        Window::new(min, max).map(|window| Self { direction, window })
    }

    /// Directions at an angle of at most `max` radians to `direction`.
    ///
    /// # Errors
    ///
    /// Unless `max` is positive and finite.
    pub fn at_most(direction: Unit<Vector3<f64>>, max: f64) -> Result<Self, WindowError> {
        Self::new(direction, 0.0, max)
    }

    /// NaN where the model has no direction.
    fn angle(&self, model: &impl Directed) -> f64 {
        let direction = model.direction();
        let angle = direction.and_then(|d| angle_between_axes(&self.direction, &d));
        angle.unwrap_or(f64::NAN)
    }
}

impl<E: HeldRefit<Model: Directed>> Constraint<E> for AngleWindow {
    fn name(&self) -> &'static str {
        "angle window"
    }

    fn allows_model(&self, _: &E, model: &E::Model) -> bool {
        self.window.contains(self.angle(model))
    }

    fn restore(
        &self,
        estimator: &E,
        inliers: &[usize],
        weights: Option<&[f64]>,
        refit: &E::Model,
    ) -> Option<E::Model> {
        self.window
            .restore(estimator, inliers, weights, refit, |m| self.angle(m))
    }
}
