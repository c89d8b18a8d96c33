use crate::chart::Chart;
use nalgebra::{Point3, SVector, Vector3};
use pomona_geometry::{Line, across};

/// Two tangents of the direction and two offsets of the line's point.
///
/// With (u, v) = [`across`] of the direction e: e' ∝ e + τ₁ u + τ₂ v, a' = a + o₁ u + o₂ v, in the
/// order τ₁, τ₂, o₁, o₂. The residuals are the components of the distance along u and v.
pub(crate) struct LineChart {
    line: Line,
    u: Vector3<f64>,
    v: Vector3<f64>,
}

impl Chart<4, 2> for LineChart {
    type Shape = Line;

    fn at(line: &Line) -> Self {
        let [u, v] = across(&line.direction);
        Self { line: *line, u, v }
    }

    fn rows(&self, point: &Point3<f64>) -> ([f64; 2], [SVector<f64, 4>; 2]) {
        let w = point - self.line.point;
        let along = w.dot(&self.line.direction);
        (
            [w.dot(&self.u), w.dot(&self.v)],
            [
                SVector::from([-along, 0.0, -1.0, 0.0]),
                SVector::from([0.0, -along, 0.0, -1.0]),
            ],
        )
    }

    fn stepped(&self, step: &SVector<f64, 4>) -> Option<Line> {
        Line::new(
            self.line.point + self.u * step[2] + self.v * step[3],
            self.line.direction.into_inner() + self.u * step[0] + self.v * step[1],
        )
    }

    fn squared_distance(line: &Line, point: &Point3<f64>) -> f64 {
        line.distance(point).powi(2)
    }
}
