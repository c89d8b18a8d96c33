use crate::held::HeldRefit;
use crate::levenberg::Objective;
use crate::line::LineChart;
use crate::points::{centroid_and_extent, weighted};
use crate::{Coordinate, Points, line_least_squares, simd};
use nalgebra::Vector3;
use pomona_geometry::Line;
use pomona_ransac::{Candidates, Estimator};
use std::ops::Range;

/// Lines through points, for `pomona-ransac`. A residual is the distance from the line.
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

/// A line made ready for one threshold: two unit vectors across it, and the squared threshold.
///
/// The squared distance is the sum of two squares, which unlike |w|² − (w·e)²
/// loses no digits far along the line.
struct Tube<T> {
    origin: [T; 3],
    u: [T; 3],
    v: [T; 3],
    squared_threshold: T,
}

impl<T: Coordinate> Tube<T> {
    /// A threshold that is negative or NaN holds nothing.
    fn new(line: &Line, threshold: f64) -> Self {
        let [u, v] = across(&line.direction);
        let coordinates = |w: Vector3<f64>| [w.x, w.y, w.z].map(T::from_f64);
        let square = if threshold >= 0.0 {
            threshold * threshold
        } else {
            -1.0
        };
        Self {
            origin: coordinates(line.point.coords),
            u: coordinates(u),
            v: coordinates(v),
            squared_threshold: T::from_f64(square),
        }
    }

    #[inline(always)]
    fn holds(&self, x: T, y: T, z: T) -> bool {
        let (wx, wy, wz) = (x - self.origin[0], y - self.origin[1], z - self.origin[2]);
        let a = wx * self.u[0] + wy * self.u[1] + wz * self.u[2];
        let b = wx * self.v[0] + wy * self.v[1] + wz * self.v[2];
        a * a + b * b <= self.squared_threshold
    }
}

/// Two unit vectors across a third and each other, without a square root (Duff et al. 2017,
/// "Building an orthonormal basis, revisited", JCGT 6(1)).
#[inline]
fn across(e: &Vector3<f64>) -> [Vector3<f64>; 2] {
    let sign = 1.0_f64.copysign(e.z);
    let a = -1.0 / (sign + e.z);
    let b = e.x * e.y * a;
    [
        Vector3::new(1.0 + sign * e.x * e.x * a, sign * b, -sign * e.x),
        Vector3::new(b, sign + e.y * e.y * a, -e.y),
    ]
}

impl<T: Coordinate> Estimator for LineEstimator<'_, T> {
    type Model = Line;
    const SAMPLE_SIZE: usize = 2;

    fn len(&self) -> usize {
        self.points.len()
    }

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

    fn residuals(&self, line: &Line, block: Range<usize>, out: &mut [f64]) {
        for (r, i) in out.iter_mut().zip(block) {
            *r = line.distance(&self.points.get(i));
        }
    }

    fn count_within(&self, line: &Line, block: Range<usize>, threshold: f64) -> usize {
        let tube = Tube::<T>::new(line, threshold);
        simd::count(self.points.block(block), |x, y, z| tube.holds(x, y, z))
    }

    fn select_within(
        &self,
        line: &Line,
        block: Range<usize>,
        threshold: f64,
        out: &mut Vec<usize>,
    ) {
        let tube = Tube::<T>::new(line, threshold);
        let (x, y, z) = self.points.block(block.clone());
        let points = x.iter().zip(y).zip(z).zip(block);
        out.extend(
            points
                .filter(|(((x, y), z), _)| tube.holds(**x, **y, **z))
                .map(|(_, i)| i),
        );
    }
}

impl<T: Coordinate> LineEstimator<'_, T> {
    fn iterated(
        &self,
        inliers: &[usize],
        weights: Option<&[f64]>,
        start: &Line,
        condition: Option<&dyn Fn(&Line) -> f64>,
    ) -> Option<Line> {
        let points = weighted(&self.points, inliers, weights, None).filter(|&(_, w)| w != 0.0);
        if points.clone().count() < 2 {
            return None;
        }
        let (centroid, _) = centroid_and_extent(points.clone().map(|(p, _)| p))?;
        let start = Line {
            point: start.foot(&centroid),
            ..*start
        };
        let objective = Objective {
            points,
            prior: None,
        };
        objective.minimize::<LineChart, 4, 2>(&start, condition)
    }
}

impl<T: Coordinate> HeldRefit for LineEstimator<'_, T> {
    fn refit_held(
        &self,
        inliers: &[usize],
        weights: Option<&[f64]>,
        start: &Line,
        condition: &dyn Fn(&Line) -> f64,
    ) -> Option<Line> {
        self.iterated(inliers, weights, start, Some(condition))
    }
}
