use crate::chart::linearize;
use crate::cylinder::{CylinderChart, cylinder_held, pipe};
use crate::held::HeldRefit;
use crate::points::weighted;
use crate::prior::Knowledge;
use crate::shared_methods::{
    geometric_refits, held_refit, radius_prior, residuals_by_distance, scores_by_kernel,
};
use crate::{Coordinate, Points, PriorError, RadiusPrior, cylinder_through, simd};
use pomona_geometry::Cylinder;
use pomona_ransac::{Candidates, Estimator, Linearization};
use std::ops::Range;

/// Cylinders through points with normals, for `pomona-ransac`. A residual is the distance from the
/// surface; the normals (of either sign) make models and are not scored.
///
/// A refit is [`cylinder_weighted`](crate::cylinder_weighted), started from the model so far.
///
/// The covariance in a report is by (τ₁, τ₂, o₁, o₂, ρ): with (u, v) = [`across`](pomona_geometry::across) of the
/// direction e, e' ∝ e + τ₁ u + τ₂ v, a' = a + o₁ u + o₂ v, a being the axis's point, and r' = r + ρ.
/// A prior is not part of it: it says what the points alone tell.
#[derive(Clone, Copy, Debug)]
pub struct CylinderEstimator<'a, T> {
    points: Points<'a, T>,
    normals: Points<'a, T>,
    knowledge: Option<Knowledge>,
}

impl<'a, T: Coordinate> CylinderEstimator<'a, T> {
    /// An estimator over a view of points and a view of as many normals.
    ///
    /// Points beyond the last normal are scored, but a sample with one gives no model.
    pub fn new(points: Points<'a, T>, normals: Points<'a, T>) -> Self {
        Self {
            points,
            normals,
            knowledge: None,
        }
    }

    radius_prior!();

    fn geometric(
        &self,
        inliers: &[usize],
        weights: Option<&[f64]>,
        current: &Cylinder,
        condition: Option<&dyn Fn(&Cylinder) -> f64>,
    ) -> Option<Cylinder> {
        let points = weighted(&self.points, inliers, weights, self.knowledge);
        cylinder_held(points, current, self.knowledge.map(|k| k.prior), condition)
    }
}

impl<T: Coordinate> Estimator for CylinderEstimator<'_, T> {
    type Model = Cylinder;
    const SAMPLE_SIZE: usize = 2;
    const PARAMETERS: usize = 5;

    residuals_by_distance!(Cylinder, signed_distance, abs);

    fn fit(&self, sample: &[usize], candidates: &mut Candidates<Cylinder>) {
        let &[i, j] = sample else { return };
        if i.max(j) >= self.normals.len() {
            return;
        }
        let points = [i, j].map(|i| self.points.get(i));
        let normals = [i, j].map(|i| self.normals.get(i).coords);
        if let Some(cylinder) = cylinder_through(points, normals) {
            candidates.push(cylinder);
        }
    }

    fn linearize(&self, cylinder: &Cylinder, datum: usize, rows: &mut Linearization) {
        linearize::<CylinderChart, 5, 1>(cylinder, &self.points.get(datum), rows);
    }

    geometric_refits!(Cylinder);

    scores_by_kernel!(Cylinder, pipe::<T>);
}

impl<T: Coordinate> HeldRefit for CylinderEstimator<'_, T> {
    held_refit!(Cylinder, geometric);
}
