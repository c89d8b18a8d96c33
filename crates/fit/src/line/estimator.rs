use crate::chart::linearize;
use crate::held::HeldRefit;
use crate::levenberg::Objective;
use crate::line::{LineChart, Tube};
use crate::moments::Moments;
use crate::points::weighted;
use crate::shared_methods::{held_refit, residuals_by_distance, scores_by_kernel};
use crate::{Coordinate, Points, line_least_squares, simd};
use pomona_geometry::Line;
use pomona_ransac::{Candidates, Estimator, Linearization};
use std::ops::Range;

/// Lines through points, for `pomona-ransac`. A residual is the distance from the line.
///
/// The covariance in a report is by (τ₁, τ₂, o₁, o₂): with (u, v) = [`across`](pomona_geometry::across) of the
/// direction e, e' ∝ e + τ₁ u + τ₂ v and a' = a + o₁ u + o₂ v, a being the line's point. A point has
/// two residuals, along u and v.
#[derive(Clone, Copy, Debug)]
pub struct LineEstimator<'a, T> {
    points: Points<'a, T>,
}

impl<'a, T: Coordinate> LineEstimator<'a, T> {
    /// An estimator over a view of points.
    pub fn new(points: Points<'a, T>) -> Self {
        Self { points }
    }
}

impl<T: Coordinate> Estimator for LineEstimator<'_, T> {
    type Model = Line;
    const SAMPLE_SIZE: usize = 2;
    const PARAMETERS: usize = 4;

    residuals_by_distance!(Line, distance);

    fn fit(&self, sample: &[usize], candidates: &mut Candidates<Line>) {
        let &[i, j] = sample else { return };
        if let Some(line) = Line::through(self.points.get(i), self.points.get(j)) {
            candidates.push(line);
        }
    }

    fn refit(&self, inliers: &[usize], _: &Line) -> Option<Line> {
        line_least_squares(self.points.select(inliers))
    }

    fn refit_weighted(&self, inliers: &[usize], weights: &[f64], current: &Line) -> Option<Line> {
        self.iterated(inliers, Some(weights), current, None)
    }

    fn linearize(&self, line: &Line, datum: usize, rows: &mut Linearization) {
        linearize::<LineChart, 4, 2>(line, &self.points.get(datum), rows);
    }

    scores_by_kernel!(Line, Tube::<T>::new);
}

impl<T: Coordinate> LineEstimator<'_, T> {
    fn iterated(
        &self,
        inliers: &[usize],
        weights: Option<&[f64]>,
        start: &Line,
        condition: Option<&dyn Fn(&Line) -> f64>,
    ) -> Option<Line> {
        let moments = Moments::new(weighted(&self.points, inliers, weights, None))?;
        if moments.points < 2 {
            return None;
        }
        let start = Line {
            point: start.foot(&moments.centroid),
            ..*start
        };
        // The sum of squared distances from a line is one of moments.
        let objective = Objective {
            points: moments.stand_ins().into_iter(),
            prior: None,
        };
        objective.minimize::<LineChart, 4, 2>(&start, condition)
    }
}

impl<T: Coordinate> HeldRefit for LineEstimator<'_, T> {
    held_refit!(Line, iterated);
}
