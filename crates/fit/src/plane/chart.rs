use crate::chart::Chart;
use nalgebra::{Point3, SVector, Vector3};
use pomona_geometry::{Plane, across};

/// Two tangents of the normal, and a shift along it.
///
/// With (u, v) = [`across`] of the normal n and f the plane's point nearest to the origin: n' ∝ n + τ₁ u + τ₂ v,
/// through f' = f + s n, in the order τ₁, τ₂, s.
pub(crate) struct PlaneChart {
    plane: Plane,
    foot: Point3<f64>,
    u: Vector3<f64>,
    v: Vector3<f64>,
}

impl Chart<3, 1> for PlaneChart {
    type Shape = Plane;

    fn at(plane: &Plane) -> Self {
        let [u, v] = across(&plane.normal);
        Self {
            plane: *plane,
            foot: Point3::from(plane.normal.into_inner() * plane.offset),
            u,
            v,
        }
    }

    fn rows(&self, point: &Point3<f64>) -> ([f64; 1], [SVector<f64, 3>; 1]) {
        let w = point - self.foot;
        (
            [w.dot(&self.plane.normal)],
            [SVector::from([w.dot(&self.u), w.dot(&self.v), -1.0])],
        )
    }

    fn stepped(&self, step: &SVector<f64, 3>) -> Option<Plane> {
        let normal = self.plane.normal.into_inner();
        Plane::new(
            self.foot + normal * step[2],
            normal + self.u * step[0] + self.v * step[1],
        )
    }

    fn squared_distance(plane: &Plane, point: &Point3<f64>) -> f64 {
        plane.signed_distance(point).powi(2)
    }
}
