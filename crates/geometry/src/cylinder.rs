use crate::Line;
use nalgebra::Point3;

/// An infinite circular cylinder about an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylinder {
    /// Axis.
    pub axis: Line,
    /// Radius, positive.
    pub radius: f64,
}

impl Cylinder {
    /// A cylinder, or `None` unless the radius is finite and positive.
    #[inline]
    pub fn new(axis: Line, radius: f64) -> Option<Self> {
        (radius.is_finite() && radius > 0.0).then_some(Self { axis, radius })
    }

    /// Distance from the surface, negative inside.
    #[inline]
    pub fn signed_distance(&self, point: &Point3<f64>) -> f64 {
        self.axis.distance(point) - self.radius
    }

    /// The surface point nearest to `point`, or `None` on the axis, where a whole circle is.
    pub fn project(&self, point: &Point3<f64>) -> Option<Point3<f64>> {
        let foot = self.axis.foot(point);
        let offset = point - foot;
        let norm = offset.norm();
        (norm > 0.0).then(|| foot + offset * (self.radius / norm))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;

    #[test]
    fn distance_is_from_the_surface() {
        let axis = Line::new(Point3::new(5.0, 0.0, 0.0), Vector3::x()).unwrap();
        let cylinder = Cylinder::new(axis, 2.0).unwrap();
        assert_eq!(cylinder.signed_distance(&Point3::new(-7.0, 3.0, 4.0)), 3.0);
        assert_eq!(cylinder.signed_distance(&Point3::new(-7.0, 0.0, 0.0)), -2.0);
        let on_surface = cylinder.project(&Point3::new(-7.0, 3.0, 4.0)).unwrap();
        assert!((on_surface - Point3::new(-7.0, 1.2, 1.6)).norm() < 1e-15);
        assert!(cylinder.project(&Point3::new(-7.0, 0.0, 0.0)).is_none());
        assert!(Cylinder::new(axis, 0.0).is_none());
        assert!(Cylinder::new(axis, f64::INFINITY).is_none());
    }
}
