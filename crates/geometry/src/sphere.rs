use nalgebra::Point3;

/// A sphere: the points at `radius` from `center`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// Centre.
    pub center: Point3<f64>,
    /// Radius, positive.
    pub radius: f64,
}

impl Sphere {
    /// A sphere, or `None` unless all numbers are finite and the radius is positive.
    #[inline]
    pub fn new(center: Point3<f64>, radius: f64) -> Option<Self> {
        let valid = center.iter().all(|c| c.is_finite()) && radius.is_finite() && radius > 0.0;
        valid.then_some(Self { center, radius })
    }

    /// Distance from the surface, negative inside.
    #[inline]
    pub fn signed_distance(&self, point: &Point3<f64>) -> f64 {
        (point - self.center).norm() - self.radius
    }

    /// The surface point nearest to `point`, or `None` at the centre, where every one is.
    #[inline]
    pub fn project(&self, point: &Point3<f64>) -> Option<Point3<f64>> {
        let offset = point - self.center;
        let norm = offset.norm();
        (norm > 0.0).then(|| self.center + offset * (self.radius / norm))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn refuses_what_is_no_sphere() {
        let o = Point3::origin();
        assert!(Sphere::new(o, 0.0).is_none());
        assert!(Sphere::new(o, -1.0).is_none());
        assert!(Sphere::new(o, f64::NAN).is_none());
        assert!(Sphere::new(Point3::new(f64::INFINITY, 0.0, 0.0), 1.0).is_none());
        assert!(Sphere::new(o, 1.0).unwrap().project(&o).is_none());
    }

    proptest! {
        #[test]
        fn projection_lies_on_the_surface_at_the_signed_distance(
            p in prop::array::uniform3(-10.0..10.0f64), r in 0.01..5.0f64,
        ) {
            let sphere = Sphere::new(Point3::new(0.3, -0.2, 0.9), r).unwrap();
            let p = Point3::from(p);
            prop_assume!((p - sphere.center).norm() > 1e-6);
            let q = sphere.project(&p).unwrap();
            prop_assert!(sphere.signed_distance(&q).abs() < 1e-12);
            prop_assert!(((p - q).norm() - sphere.signed_distance(&p).abs()).abs() < 1e-12);
        }
    }
}
