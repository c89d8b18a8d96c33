use crate::chart::Chart;
use nalgebra::{Point3, SVector};
use pomona_geometry::Sphere;

/// The centre's shift along x, y, z, and the radius's change.
pub(crate) struct SphereChart(Sphere);

impl Chart<4, 1> for SphereChart {
    type Shape = Sphere;
    const RADIUS: Option<usize> = Some(3);

    fn at(sphere: &Sphere) -> Self {
        Self(*sphere)
    }

    fn rows(&self, point: &Point3<f64>) -> ([f64; 1], [SVector<f64, 4>; 1]) {
        let offset = point - self.0.center;
        let norm = offset.norm();
        let u = if norm > 0.0 {
            offset / norm
        } else {
            nalgebra::Vector3::zeros()
        };
        (
            [norm - self.0.radius],
            [SVector::from([-u.x, -u.y, -u.z, -1.0])],
        )
    }

    fn stepped(&self, step: &SVector<f64, 4>) -> Option<Sphere> {
        Sphere::new(
            self.0.center + step.fixed_rows::<3>(0),
            self.0.radius + step[3],
        )
    }

    fn squared_distance(sphere: &Sphere, point: &Point3<f64>) -> f64 {
        sphere.signed_distance(point).powi(2)
    }

    fn radius(sphere: &Sphere) -> f64 {
        sphere.radius
    }
}
