use nalgebra::Point3;

/// A straight piece from `start` to `end`; both may coincide, and then it is a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// One end.
    pub start: Point3<f64>,
    /// The other end.
    pub end: Point3<f64>,
}

impl Segment {
    /// A segment, or `None` where an end is not finite.
    #[inline]
    pub fn new(start: Point3<f64>, end: Point3<f64>) -> Option<Self> {
        let valid = start.iter().chain(end.iter()).all(|c| c.is_finite());
        valid.then_some(Self { start, end })
    }

    /// Length.
    #[inline]
    pub fn length(&self) -> f64 {
        (self.end - self.start).norm()
    }

    /// The fraction in `0..=1` of the way from start to end at which `point` is nearest.
    #[inline]
    pub fn fraction(&self, point: &Point3<f64>) -> f64 {
        let along = self.end - self.start;
        let squared_length = along.norm_squared();
        if squared_length == 0.0 {
            return 0.0;
        }
        ((point - self.start).dot(&along) / squared_length).clamp(0.0, 1.0)
    }

    /// The segment's point nearest to `point`.
    #[inline]
    pub fn closest_point(&self, point: &Point3<f64>) -> Point3<f64> {
        self.start + (self.end - self.start) * self.fraction(point)
    }

    /// Distance of `point` from the segment.
    #[inline]
    pub fn distance(&self, point: &Point3<f64>) -> f64 {
        (point - self.closest_point(point)).norm()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distance_beyond_an_end_is_to_that_end() {
        let s = Segment::new(Point3::origin(), Point3::new(1.0, 0.0, 0.0)).unwrap();
        assert_eq!(s.distance(&Point3::new(4.0, 4.0, 0.0)), 5.0);
        assert_eq!(s.distance(&Point3::new(0.5, 2.0, 0.0)), 2.0);
        assert_eq!(s.distance(&Point3::new(-3.0, 0.0, 4.0)), 5.0);
    }

    #[test]
    fn a_point_is_a_segment_too() {
        let p = Point3::new(1.0, 2.0, 3.0);
        let s = Segment::new(p, p).unwrap();
        assert_eq!(s.length(), 0.0);
        assert_eq!(s.distance(&Point3::new(1.0, 2.0, 5.0)), 2.0);
        assert!(Segment::new(p, Point3::new(f64::NAN, 0.0, 0.0)).is_none());
    }
}
