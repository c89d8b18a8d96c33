use crate::{Coordinate, Points, plane_least_squares};
use pomona_geometry::Plane;
use pomona_ransac::{Candidates, Estimator};
use std::ops::Range;

/// Planes through points, for `pomona-ransac`. A residual is the distance from the plane.
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

    fn len(&self) -> usize {
        self.points.len()
    }

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

    fn residuals(&self, plane: &Plane, block: Range<usize>, out: &mut [f64]) {
        for (r, i) in out.iter_mut().zip(block) {
            *r = plane.signed_distance(&self.points.get(i)).abs();
        }
    }
}
