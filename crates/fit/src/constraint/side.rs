use crate::{Centered, HeldRefit, Straight};
use nalgebra::Point3;
use pomona_geometry::Plane;
use pomona_ransac::{Constraint, Estimator};

/// How far on the positive side a refit is held, in the points' unit of length.
const INSET: f64 = 1e-9;

/// The best fit that has `height` just over zero.
fn restore<E: HeldRefit>(
    estimator: &E,
    inliers: &[usize],
    weights: Option<&[f64]>,
    left: &E::Model,
    height: impl Fn(&E::Model) -> f64,
) -> Option<E::Model> {
    let condition = |model: &E::Model| height(model) - INSET;
    estimator.refit_held(inliers, weights, left, &condition)
}

/// Spheres and circles must have their centre on the positive side of a plane, or on it.
///
/// A refit that crosses the plane becomes the best fit with its centre on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CenterSide {
    plane: Plane,
}

impl CenterSide {
    /// Centres on the side of `plane` to which its normal points.
    pub fn positive(plane: Plane) -> Self {
        Self { plane }
    }

    fn height(&self, model: &impl Centered) -> f64 {
        self.plane.signed_distance(&model.center())
    }
}

impl<E: HeldRefit<Model: Centered>> Constraint<E> for CenterSide {
    fn name(&self) -> &'static str {
        "side of the centre"
    }

    fn allows_model(&self, _: &E, model: &E::Model) -> bool {
        self.height(model) >= 0.0
    }

    fn restore(
        &self,
        estimator: &E,
        inliers: &[usize],
        weights: Option<&[f64]>,
        refit: &E::Model,
    ) -> Option<E::Model> {
        restore(estimator, inliers, weights, refit, |m| self.height(m))
    }
}

/// Lines, and the axes of cylinders and capsules, must pass a point on the positive side of a
/// plane, or touch it: the axis's point nearest to that point is on that side.
///
/// A refit that passes on the other side becomes the best fit with that nearest point on the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FootSide {
    plane: Plane,
    point: Point3<f64>,
}

impl FootSide {
    /// Axes whose nearest point to `point` is on the side of `plane` to which its normal points.
    pub fn positive(plane: Plane, point: Point3<f64>) -> Self {
        Self { plane, point }
    }

    fn height(&self, model: &impl Straight) -> f64 {
        self.plane.signed_distance(&model.nearest(&self.point))
    }
}

impl<E: HeldRefit<Model: Straight>> Constraint<E> for FootSide {
    fn name(&self) -> &'static str {
        "side of the foot"
    }

    fn allows_model(&self, _: &E, model: &E::Model) -> bool {
        self.height(model) >= 0.0
    }

    fn restore(
        &self,
        estimator: &E,
        inliers: &[usize],
        weights: Option<&[f64]>,
        refit: &<E as Estimator>::Model,
    ) -> Option<E::Model> {
        restore(estimator, inliers, weights, refit, |m| self.height(m))
    }
}
