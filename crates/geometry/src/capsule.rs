use crate::{Cylinder, Line, Segment};
use nalgebra::Point3;

/// A straight rod with round ends: the points within `radius` of a segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Capsule {
    /// Axis; where its ends coincide the capsule is a ball.
    pub segment: Segment,
    /// Radius, positive.
    pub radius: f64,
}

impl Capsule {
    /// A capsule, or `None` unless the radius is finite and positive.
    pub fn new(segment: Segment, radius: f64) -> Option<Self> {
        (radius.is_finite() && radius > 0.0).then_some(Self { segment, radius })
    }

    /// The piece of `cylinder` between two parameters of its axis, in either order, with round ends
    /// beyond them; `None` where one is not finite.
    pub fn cut(cylinder: &Cylinder, from: f64, to: f64) -> Option<Self> {
        // The smaller of a number and NaN would be the number.
        if from.is_nan() || to.is_nan() {
            return None;
        }
        let segment = Segment::new(
            cylinder.axis.at(from.min(to)),
            cylinder.axis.at(from.max(to)),
        )?;
        Self::new(segment, cylinder.radius)
    }

    /// The infinite cylinder it is a piece of, or `None` where the segment has no length.
    pub fn cylinder(&self) -> Option<Cylinder> {
        Cylinder::new(
            Line::through(self.segment.start, self.segment.end)?,
            self.radius,
        )
    }

    /// Distance from the surface, negative inside.
    pub fn signed_distance(&self, point: &Point3<f64>) -> f64 {
        self.segment.distance(point) - self.radius
    }

    /// The surface point nearest to `point`, or `None` on the axis, where a whole circle or
    /// sphere of them is.
    pub fn project(&self, point: &Point3<f64>) -> Option<Point3<f64>> {
        let nearest = self.segment.closest_point(point);
        let offset = point - nearest;
        let norm = offset.norm();
        (norm > 0.0).then(|| nearest + offset * (self.radius / norm))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;

    #[test]
    fn ends_are_round() {
        let axis = Line::new(Point3::new(1.0, 0.0, 0.0), Vector3::x()).unwrap();
        let cylinder = Cylinder::new(axis, 2.0).unwrap();
        let capsule = Capsule::cut(&cylinder, 3.0, 0.0).unwrap();
        assert_eq!(capsule.segment.start, Point3::new(1.0, 0.0, 0.0));
        assert_eq!(capsule.signed_distance(&Point3::new(2.0, 3.0, 0.0)), 1.0);
        assert_eq!(capsule.signed_distance(&Point3::new(7.0, 4.0, 0.0)), 3.0);
        assert_eq!(capsule.signed_distance(&Point3::new(1.0, 0.0, 0.0)), -2.0);
        let on_end = capsule.project(&Point3::new(7.0, 4.0, 0.0)).unwrap();
        assert!((on_end - Point3::new(5.2, 1.6, 0.0)).norm() < 1e-15);
        assert!(capsule.project(&Point3::new(2.0, 0.0, 0.0)).is_none());
        assert_eq!(capsule.cylinder().unwrap().radius, 2.0);
    }

    #[test]
    fn what_is_no_capsule() {
        let point = Segment::new(Point3::origin(), Point3::origin()).unwrap();
        assert!(Capsule::new(point, 0.0).is_none());
        assert!(Capsule::new(point, f64::NAN).is_none());
        let ball = Capsule::new(point, 1.0).unwrap();
        assert_eq!(ball.signed_distance(&Point3::new(0.0, 3.0, 0.0)), 2.0);
        assert!(ball.cylinder().is_none());
        let axis = Line::new(Point3::origin(), Vector3::x()).unwrap();
        let cylinder = Cylinder::new(axis, 1.0).unwrap();
        assert!(Capsule::cut(&cylinder, 0.0, f64::NAN).is_none());
    }
}
