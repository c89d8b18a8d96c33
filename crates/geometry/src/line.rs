use nalgebra::{Point3, Unit, Vector3};

/// An infinite straight line, by a point on it and a unit direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// Some point on the line.
    pub point: Point3<f64>,
    /// Unit direction; the opposite one describes the same line.
    pub direction: Unit<Vector3<f64>>,
}

impl Line {
    /// The line through `point` along `direction`, or `None` where the
    /// direction has no length or anything is not finite.
    #[inline]
    pub fn new(point: Point3<f64>, direction: Vector3<f64>) -> Option<Self> {
        if !(point.x.is_finite() && point.y.is_finite() && point.z.is_finite()) {
            return None;
        }
        let square = direction.norm_squared();
        let direction = if (1e-200..1e200).contains(&square) {
            Unit::new_unchecked(direction / square.sqrt())
        } else {
            normalized(direction)?
        };
        Some(Self { point, direction })
    }

    /// The line through two points, or `None` where they coincide or are not finite.
    #[inline]
    pub fn through(a: Point3<f64>, b: Point3<f64>) -> Option<Self> {
        Self::new(a, b - a)
    }

    /// Position of the foot of `point` along the direction, measured from `self.point`.
    #[inline]
    pub fn parameter(&self, point: &Point3<f64>) -> f64 {
        (point - self.point).dot(&self.direction)
    }

    /// The point at `parameter` along the direction from `self.point`.
    #[inline]
    pub fn at(&self, parameter: f64) -> Point3<f64> {
        self.point + self.direction.into_inner() * parameter
    }

    /// Foot of the perpendicular from `point` on the line: the line's point nearest to it.
    ///
    /// With O the point, A the line's point and e its unit direction, the foot
    /// is C = A + ((O − A)·e) e, so that OC · e = 0 (Gao et al. 2022, Eq. 10,
    /// doi 10.3390/agriculture12081170).
    #[inline]
    pub fn foot(&self, point: &Point3<f64>) -> Point3<f64> {
        self.at(self.parameter(point))
    }

    /// Distance of `point` from the line.
    #[inline]
    pub fn distance(&self, point: &Point3<f64>) -> f64 {
        (point - self.point).cross(&self.direction).norm()
    }

    /// The points of `self` and of `other` that are nearest to each other.
    ///
    /// `None` for parallel lines (angle under 1e-9 rad), which have no such pair of their own.
    #[inline]
    pub fn closest_points(&self, other: &Self) -> Option<(Point3<f64>, Point3<f64>)> {
        let u = self.direction.into_inner();
        let v = other.direction.into_inner();
        let normal = u.cross(&v);
        let squared_sine = normal.norm_squared();
        if squared_sine < 1e-18 {
            return None;
        }
        let offset = other.point - self.point;
        let s = offset.cross(&v).dot(&normal) / squared_sine;
        let t = offset.cross(&u).dot(&normal) / squared_sine;
        Some((self.at(s), other.at(t)))
    }
}

/// A direction whose squares may leave the range of f64; `None` where it has no length or is not finite.
#[cold]
fn normalized(direction: Vector3<f64>) -> Option<Unit<Vector3<f64>>> {
    let scale = direction.amax();
    let valid = direction.iter().all(|c| c.is_finite()) && scale > 0.0;
    valid.then(|| Unit::new_normalize(direction / scale))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn vector() -> impl Strategy<Value = Vector3<f64>> {
        prop::array::uniform3(-10.0..10.0f64).prop_map(Vector3::from)
    }

    #[test]
    fn refuses_what_is_no_line() {
        let o = Point3::origin();
        assert!(Line::new(o, Vector3::zeros()).is_none());
        assert!(Line::new(o, Vector3::new(f64::NAN, 0.0, 1.0)).is_none());
        assert!(Line::through(o, o).is_none());
        let tiny = Line::new(o, Vector3::new(0.0, 1e-300, 0.0)).unwrap();
        assert!((tiny.direction.norm() - 1.0).abs() < 1e-15);
    }

    #[test]
    fn parallel_lines_have_no_closest_pair() {
        let a = Line::new(Point3::origin(), Vector3::x()).unwrap();
        let b = Line::new(Point3::new(0.0, 1.0, 0.0), -Vector3::x()).unwrap();
        assert!(a.closest_points(&b).is_none());
    }

    proptest! {
        #[test]
        fn foot_is_perpendicular_and_nearest(p in vector(), d in vector(), q in vector(), t in -5.0..5.0f64) {
            prop_assume!(d.norm() > 1e-3);
            let line = Line::new(p.into(), d).unwrap();
            let q = Point3::from(q);
            let foot = line.foot(&q);
            prop_assert!((foot - q).dot(&line.direction).abs() < 1e-9);
            prop_assert!((line.distance(&q) - (foot - q).norm()).abs() < 1e-9);
            prop_assert!((line.at(t) - q).norm() >= line.distance(&q) - 1e-9);
        }

        #[test]
        fn closest_points_span_the_common_perpendicular(
            p in vector(), d in vector(), q in vector(), e in vector(),
        ) {
            prop_assume!(d.norm() > 1e-2 && e.norm() > 1e-2);
            let a = Line::new(p.into(), d).unwrap();
            let b = Line::new(q.into(), e).unwrap();
            prop_assume!(a.direction.cross(&b.direction).norm() > 1e-2);
            let (on_a, on_b) = a.closest_points(&b).unwrap();
            let gap = on_b - on_a;
            prop_assert!(gap.dot(&a.direction).abs() < 1e-7);
            prop_assert!(gap.dot(&b.direction).abs() < 1e-7);
        }
    }
}
