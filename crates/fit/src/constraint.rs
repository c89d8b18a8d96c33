use nalgebra::Point3;
use pomona_geometry::{Line, Sphere};
use pomona_ransac::{Constraint, Estimator};
use thiserror::Error;

/// A window whose bounds are inverted, negative or not finite.
#[derive(Clone, Debug, Error, PartialEq)]
#[error("a window from {min} to {max}: give 0 ≤ min < max, both finite")]
pub struct WindowError {
    /// Lower bound given.
    pub min: f64,
    /// Upper bound given.
    pub max: f64,
}

fn check(min: f64, max: f64) -> Result<(), WindowError> {
    let valid = 0.0 <= min && min < max && max.is_finite();
    if valid {
        Ok(())
    } else {
        Err(WindowError { min, max })
    }
}

/// Spheres must have a radius between two bounds, which belong to the window.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RadiusWindow {
    min: f64,
    max: f64,
}

impl RadiusWindow {
    /// Radii from `min` to `max`.
    ///
    /// # Errors
    ///
    /// Unless 0 ≤ `min` < `max` and both are finite.
    pub fn new(min: f64, max: f64) -> Result<Self, WindowError> {
        check(min, max).map(|()| Self { min, max })
    }
}

impl<E: Estimator<Model = Sphere>> Constraint<E> for RadiusWindow {
    fn name(&self) -> &'static str {
        "radius window"
    }

    fn allows_model(&self, _: &E, sphere: &Sphere) -> bool {
        (self.min..=self.max).contains(&sphere.radius)
    }
}

/// Lines must pass a point at a distance between two bounds, which belong to the window.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DistanceWindow {
    point: Point3<f64>,
    min: f64,
    max: f64,
}

impl DistanceWindow {
    /// Lines that pass `point` at a distance from `min` to `max`.
    ///
    /// # Errors
    ///
    /// Unless 0 ≤ `min` < `max` and both are finite.
    pub fn new(point: Point3<f64>, min: f64, max: f64) -> Result<Self, WindowError> {
        check(min, max).map(|()| Self { point, min, max })
    }
}

impl<E: Estimator<Model = Line>> Constraint<E> for DistanceWindow {
    fn name(&self) -> &'static str {
        "distance window"
    }

    fn allows_model(&self, _: &E, line: &Line) -> bool {
        let square = (self.point - line.point)
            .cross(&line.direction)
            .norm_squared();
        (self.min * self.min..=self.max * self.max).contains(&square)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn windows_are_checked_when_made() {
        assert!(RadiusWindow::new(0.02, 0.05).is_ok());
        for (min, max) in [
            (0.05, 0.02),
            (-0.1, 0.2),
            (f64::NAN, 1.0),
            (0.0, f64::INFINITY),
            (1.0, 1.0),
        ] {
            assert!(RadiusWindow::new(min, max).is_err());
            assert!(DistanceWindow::new(Point3::origin(), min, max).is_err());
        }
    }
}
