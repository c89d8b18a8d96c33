use crate::chart::linearize;
use crate::held::HeldRefit;
use crate::levenberg::Objective;
use crate::plane::{PlaneChart, Slab};
use crate::points::{centroid_and_extent, weighted};
use crate::shared_methods::{held_refit, residuals_by_distance, scores_by_kernel};
use crate::{Coordinate, Points, plane_least_squares, simd};
use pomona_geometry::Plane;
use pomona_ransac::{Candidates, Estimator, Linearization};
use std::ops::Range;

/// Planes through points, for `pomona-ransac`. A residual is the distance from the plane.
///
/// The covariance in a report is by (τ₁, τ₂, s): with (u, v) = [`across`](pomona_geometry::across) of the normal n and f
/// the plane's point nearest to the origin, n' ∝ n + τ₁ u + τ₂ v through f' = f + s n.
#[derive(Clone, Copy, Debug)]
pub struct PlaneEstimator<'a, T> {
    points: Points<'a, T>,
}

impl<'a, T: Coordinate> PlaneEstimator<'a, T> {
    /// An estimator over a view of points.
    pub fn new(points: Points<'a, T>) -> Self {
        Self { points }
    }
}

impl<T: Coordinate> Estimator for PlaneEstimator<'_, T> {
    type Model = Plane;
    const SAMPLE_SIZE: usize = 3;
    const PARAMETERS: usize = 3;

    residuals_by_distance!(Plane, signed_distance, abs);

    fn fit(&self, sample: &[usize], candidates: &mut Candidates<Plane>) {
        let &[i, j, k] = sample else { return };
        let [a, b, c] = [i, j, k].map(|i| self.points.get(i));
        if let Some(plane) = Plane::through(a, b, c) {
            candidates.push(plane);
        }
    }

    fn refit(&self, inliers: &[usize], _: &Plane) -> Option<Plane> {
        plane_least_squares(self.points.select(inliers))
    }

    fn refit_weighted(&self, inliers: &[usize], weights: &[f64], current: &Plane) -> Option<Plane> {
        self.iterated(inliers, Some(weights), current, None)
    }

    fn linearize(&self, plane: &Plane, datum: usize, rows: &mut Linearization) {
        linearize::<PlaneChart, 3, 1>(plane, &self.points.get(datum), rows);
    }

    scores_by_kernel!(Plane, Slab::<T>::new);
}

impl<T: Coordinate> PlaneEstimator<'_, T> {
    fn iterated(
        &self,
        inliers: &[usize],
        weights: Option<&[f64]>,
        start: &Plane,
        condition: Option<&dyn Fn(&Plane) -> f64>,
    ) -> Option<Plane> {
        let points = weighted(&self.points, inliers, weights, None).filter(|&(_, w)| w != 0.0);
        if points.clone().count() < 3 {
            return None;
        }
        centroid_and_extent(points.clone().map(|(p, _)| p))?;
        let objective = Objective {
            points,
            prior: None,
        };
        objective.minimize::<PlaneChart, 3, 1>(start, condition)
    }
}

impl<T: Coordinate> HeldRefit for PlaneEstimator<'_, T> {
    held_refit!(Plane, iterated);
}
