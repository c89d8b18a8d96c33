use nalgebra::{Point3, Unit, Vector3};

/// A circle in space: the points at `radius` from `center` in the plane across `normal`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Circle {
    /// Centre.
    pub center: Point3<f64>,
    /// Unit normal of its plane; the opposite one describes the same circle.
    pub normal: Unit<Vector3<f64>>,
    /// Radius, positive.
    pub radius: f64,
}

impl Circle {
    /// A circle, or `None` unless all numbers are finite, the normal has a length and the radius
    /// is positive.
    pub fn new(center: Point3<f64>, normal: Vector3<f64>, radius: f64) -> Option<Self> {
        let finite = center.iter().chain(normal.iter()).all(|c| c.is_finite());
        if !finite || normal.amax() == 0.0 || !radius.is_finite() || radius <= 0.0 {
            return None;
        }
        Some(Self {
            center,
            normal: Unit::new_normalize(normal / normal.amax()),
            radius,
        })
    }

    /// Distance of `point` from the circle's curve (not from the disc within).
    pub fn distance(&self, point: &Point3<f64>) -> f64 {
        let offset = point - self.center;
        let height = offset.dot(&self.normal);
        let radial = offset - self.normal.into_inner() * height;
        (radial.norm() - self.radius).hypot(height)
    }

    /// The circle's point nearest to `point`, or `None` on the line through
    /// the centre across the plane, from which every one is as near.
    pub fn project(&self, point: &Point3<f64>) -> Option<Point3<f64>> {
        let offset = point - self.center;
        let radial = offset - self.normal.into_inner() * offset.dot(&self.normal);
        let norm = radial.norm();
        (norm > 0.0).then(|| self.center + radial * (self.radius / norm))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn refuses_what_is_no_circle() {
        let o = Point3::origin();
        assert!(Circle::new(o, Vector3::zeros(), 1.0).is_none());
        assert!(Circle::new(o, Vector3::z(), 0.0).is_none());
        assert!(Circle::new(o, Vector3::z(), f64::NAN).is_none());
        assert!(Circle::new(o, Vector3::new(0.0, f64::INFINITY, 0.0), 1.0).is_none());
        let circle = Circle::new(o, Vector3::z() * 1e-200, 2.0).unwrap();
        assert_eq!(circle.distance(&Point3::new(0.0, 5.0, 4.0)), 5.0);
        assert!(circle.project(&Point3::new(0.0, 0.0, 3.0)).is_none());
    }

    proptest! {
        #[test]
        fn projection_lies_at_the_distance(
            p in prop::array::uniform3(-10.0..10.0f64), n in prop::array::uniform3(-1.0..1.0f64), r in 0.01..5.0f64,
        ) {
            prop_assume!(Vector3::from(n).norm() > 0.1);
            let circle = Circle::new(Point3::new(0.3, -0.2, 0.9), n.into(), r).unwrap();
            let p = Point3::from(p);
            prop_assume!((p - circle.center).cross(&circle.normal).norm() > 1e-6);
            let q = circle.project(&p).unwrap();
            prop_assert!(circle.distance(&q) < 1e-12);
            prop_assert!(((p - q).norm() - circle.distance(&p)).abs() < 1e-12);
        }
    }
}
