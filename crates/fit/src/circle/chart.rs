use crate::chart::Chart;
use nalgebra::{Point3, SVector, Vector3};
use pomona_geometry::{Circle, across};

/// Two tangents of the normal, three shifts of the centre, the radius's change.
///
/// With (u, v) = [`across`] of the normal n: n' ∝ n + τ₁ u + τ₂ v, c' = c + a u + b v + s n,
/// in the order τ₁, τ₂, a, b, s, ρ. The residuals are the distance within the plane and the height over it.
pub(crate) struct CircleChart {
    circle: Circle,
    u: Vector3<f64>,
    v: Vector3<f64>,
}

impl Chart<6, 2> for CircleChart {
    type Shape = Circle;
    const RADIUS: Option<usize> = Some(5);

    fn at(circle: &Circle) -> Self {
        let [u, v] = across(&circle.normal);
        Self {
            circle: *circle,
            u,
            v,
        }
    }

    fn rows(&self, point: &Point3<f64>) -> ([f64; 2], [SVector<f64, 6>; 2]) {
        let w = point - self.circle.center;
        let (a, b) = (w.dot(&self.u), w.dot(&self.v));
        let height = w.dot(&self.circle.normal);
        let rho = a.hypot(b);
        let (ca, cb) = if rho > 0.0 {
            (a / rho, b / rho)
        } else {
            (0.0, 0.0)
        };
        (
            [rho - self.circle.radius, height],
            [
                SVector::from([-height * ca, -height * cb, -ca, -cb, 0.0, -1.0]),
                SVector::from([a, b, 0.0, 0.0, -1.0, 0.0]),
            ],
        )
    }

    fn stepped(&self, step: &SVector<f64, 6>) -> Option<Circle> {
        let normal = self.circle.normal.into_inner();
        Circle::new(
            self.circle.center + self.u * step[2] + self.v * step[3] + normal * step[4],
            normal + self.u * step[0] + self.v * step[1],
            self.circle.radius + step[5],
        )
    }

    fn squared_distance(circle: &Circle, point: &Point3<f64>) -> f64 {
        circle.distance(point).powi(2)
    }

    fn radius(circle: &Circle) -> f64 {
        circle.radius
    }
}
