use crate::chart::Chart;
use nalgebra::{Point3, SVector, Vector3};
use pomona_geometry::{Cylinder, Line, across};

/// Two tangents of the direction, two offsets of the axis's point, the radius.
///
/// With (u, v) = [`across`] of the direction e: e' ∝ e + τ₁ u + τ₂ v, a' = a + o₁ u + o₂ v,
/// r' = r + ρ, in the order τ₁, τ₂, o₁, o₂, ρ.
pub(crate) struct CylinderChart {
    cylinder: Cylinder,
    u: Vector3<f64>,
    v: Vector3<f64>,
}

impl Chart<5, 1> for CylinderChart {
    type Shape = Cylinder;
    const RADIUS: Option<usize> = Some(4);

    fn at(cylinder: &Cylinder) -> Self {
        let [u, v] = across(&cylinder.axis.direction);
        Self {
            cylinder: *cylinder,
            u,
            v,
        }
    }

    fn rows(&self, point: &Point3<f64>) -> ([f64; 1], [SVector<f64, 5>; 1]) {
        let w = point - self.cylinder.axis.point;
        let (a, b) = (w.dot(&self.u), w.dot(&self.v));
        let along = w.dot(&self.cylinder.axis.direction);
        let rho = a.hypot(b);
        let residual = rho - self.cylinder.radius;
        let (ca, cb) = if rho > 0.0 {
            (a / rho, b / rho)
        } else {
            (0.0, 0.0)
        };
        let row = SVector::from([-along * ca, -along * cb, -ca, -cb, -1.0]);
        ([residual], [row])
    }

    fn stepped(&self, step: &SVector<f64, 5>) -> Option<Cylinder> {
        let Cylinder { axis, radius } = self.cylinder;
        let direction = axis.direction.into_inner() + self.u * step[0] + self.v * step[1];
        let point = axis.point + self.u * step[2] + self.v * step[3];
        Cylinder::new(Line::new(point, direction)?, radius + step[4])
    }

    fn squared_distance(cylinder: &Cylinder, point: &Point3<f64>) -> f64 {
        cylinder.signed_distance(point).powi(2)
    }

    fn radius(cylinder: &Cylinder) -> f64 {
        cylinder.radius
    }
}
