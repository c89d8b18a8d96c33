use crate::chart::linearize;
use crate::circle::{CircleChart, circle_held};
use crate::held::HeldRefit;
use crate::points::weighted;
use crate::prior::Knowledge;
use crate::shared_methods::{geometric_refits, held_refit, radius_prior, residuals_by_distance};
use crate::{Coordinate, Points, PriorError, RadiusPrior, circle_through};
use pomona_geometry::Circle;
use pomona_ransac::{Candidates, Estimator, Linearization};
use std::ops::Range;

/// Circles in space through points, for `pomona-ransac`. A residual is the distance from the
/// circle's curve.
///
/// A sample is three points; a refit is [`circle_weighted`](crate::circle_weighted), started from the model so far.
///
/// The covariance in a report is by (τ₁, τ₂, a, b, s, ρ): with (u, v) = [`across`](pomona_geometry::across) of the
/// normal n, n' ∝ n + τ₁ u + τ₂ v, c' = c + a u + b v + s n and r' = r + ρ. A point has two residuals, within the
/// circle's plane and across it. A prior is not part of it: it says what the points alone tell.
#[derive(Clone, Copy, Debug)]
pub struct CircleEstimator<'a, T> {
    points: Points<'a, T>,
    knowledge: Option<Knowledge>,
}

impl<'a, T: Coordinate> CircleEstimator<'a, T> {
    /// An estimator over a view of points.
    pub fn new(points: Points<'a, T>) -> Self {
        Self {
            points,
            knowledge: None,
        }
    }

    radius_prior!();

    fn geometric(
        &self,
        inliers: &[usize],
        weights: Option<&[f64]>,
        current: &Circle,
        condition: Option<&dyn Fn(&Circle) -> f64>,
    ) -> Option<Circle> {
        let points = weighted(&self.points, inliers, weights, self.knowledge);
        circle_held(points, current, self.knowledge.map(|k| k.prior), condition)
    }
}

impl<T: Coordinate> Estimator for CircleEstimator<'_, T> {
    type Model = Circle;
    const SAMPLE_SIZE: usize = 3;
    const PARAMETERS: usize = 6;

    residuals_by_distance!(Circle, distance);

    fn fit(&self, sample: &[usize], candidates: &mut Candidates<Circle>) {
        let &[i, j, k] = sample else { return };
        if let Some(circle) = circle_through([i, j, k].map(|i| self.points.get(i))) {
            candidates.push(circle);
        }
    }

    fn linearize(&self, circle: &Circle, datum: usize, rows: &mut Linearization) {
        linearize::<CircleChart, 6, 2>(circle, &self.points.get(datum), rows);
    }

    geometric_refits!(Circle);
}

impl<T: Coordinate> HeldRefit for CircleEstimator<'_, T> {
    held_refit!(Circle, geometric);
}
