use nalgebra::{Point3, Unit, Vector3};

/// A plane: the points p with `normal · p = offset`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// Unit normal; it names the positive side.
    pub normal: Unit<Vector3<f64>>,
    /// Signed distance of the plane from the origin along the normal.
    pub offset: f64,
}

impl Plane {
    /// The plane through `point` across `normal`, or `None` where the normal
    /// has no length or anything is not finite.
    #[inline]
    pub fn new(point: Point3<f64>, normal: Vector3<f64>) -> Option<Self> {
        if !point.iter().chain(normal.iter()).all(|c| c.is_finite()) || normal.amax() == 0.0 {
            return None;
        }
        let normal = Unit::new_normalize(normal / normal.amax());
        Some(Self {
            normal,
            offset: normal.dot(&point.coords),
        })
    }

    /// The plane through three points, or `None` where they lie on one line
    /// (the sine of the angle at `a` under 1e-9) or are not finite.
    #[inline]
    pub fn through(a: Point3<f64>, b: Point3<f64>, c: Point3<f64>) -> Option<Self> {
        let (u, v) = (b - a, c - a);
        let normal = u.cross(&v);
        // Written so that NaN refuses as well.
        if !(normal.norm() > 1e-9 * u.norm() * v.norm()) {
            return None;
        }
        Self::new(a, normal)
    }

    /// Distance from the plane, positive on the normal's side.
    #[inline]
    pub fn signed_distance(&self, point: &Point3<f64>) -> f64 {
        self.normal.dot(&point.coords) - self.offset
    }

    /// The plane's point nearest to `point`.
    #[inline]
    pub fn project(&self, point: &Point3<f64>) -> Point3<f64> {
        point - self.normal.into_inner() * self.signed_distance(point)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn three_points_on_a_line_span_no_plane() {
        let p = |x: f64| Point3::new(x, 2.0 * x, -x);
        assert!(Plane::through(p(0.0), p(1.0), p(2.0)).is_none());
        assert!(Plane::through(p(1.0), p(1.0), p(2.0)).is_none());
        assert!(Plane::through(p(f64::NAN), p(1.0), p(2.0)).is_none());
        assert!(Plane::new(p(0.0), Vector3::zeros()).is_none());
    }

    proptest! {
        #[test]
        fn holds_its_three_points(p in prop::array::uniform9(-3.0..3.0f64)) {
            let [a, b, c] = [0, 3, 6].map(|i| Point3::new(p[i], p[i + 1], p[i + 2]));
            prop_assume!((b - a).cross(&(c - a)).norm() > 1e-2);
            let plane = Plane::through(a, b, c).unwrap();
            for q in [a, b, c] {
                prop_assert!(plane.signed_distance(&q).abs() < 1e-9);
                prop_assert!((plane.project(&q) - q).norm() < 1e-9);
            }
        }
    }
}
