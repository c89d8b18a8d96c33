//! What constraints ask of a shape.

use nalgebra::{Point3, Unit, Vector3};
use pomona_geometry::{Capsule, Circle, Cylinder, Line, Plane, Sphere};

/// A shape with a radius.
pub trait Round {
    /// The radius.
    fn radius(&self) -> f64;
}

/// A shape with a centre.
pub trait Centered {
    /// The centre.
    fn center(&self) -> Point3<f64>;
}

/// A shape with a direction whose sign does not matter: an axis or a normal.
pub trait Directed {
    /// The direction; `None` where the shape has degenerated and has none.
    fn direction(&self) -> Option<Unit<Vector3<f64>>>;
}

/// A shape with a straight axis.
pub trait Straight {
    /// The axis's point nearest to `point`.
    fn nearest(&self, point: &Point3<f64>) -> Point3<f64>;
}

impl Round for Sphere {
    fn radius(&self) -> f64 {
        self.radius
    }
}

impl Round for Cylinder {
    fn radius(&self) -> f64 {
        self.radius
    }
}

impl Round for Capsule {
    fn radius(&self) -> f64 {
        self.radius
    }
}

impl Round for Circle {
    fn radius(&self) -> f64 {
        self.radius
    }
}

impl Centered for Sphere {
    fn center(&self) -> Point3<f64> {
        self.center
    }
}

impl Centered for Circle {
    fn center(&self) -> Point3<f64> {
        self.center
    }
}

impl Directed for Line {
    fn direction(&self) -> Option<Unit<Vector3<f64>>> {
        Some(self.direction)
    }
}

impl Directed for Plane {
    fn direction(&self) -> Option<Unit<Vector3<f64>>> {
        Some(self.normal)
    }
}

impl Directed for Circle {
    fn direction(&self) -> Option<Unit<Vector3<f64>>> {
        Some(self.normal)
    }
}

impl Directed for Cylinder {
    fn direction(&self) -> Option<Unit<Vector3<f64>>> {
        Some(self.axis.direction)
    }
}

impl Directed for Capsule {
    fn direction(&self) -> Option<Unit<Vector3<f64>>> {
        Some(self.cylinder()?.axis.direction)
    }
}

impl Straight for Line {
    #[inline]
    fn nearest(&self, point: &Point3<f64>) -> Point3<f64> {
        self.foot(point)
    }
}

impl Straight for Cylinder {
    #[inline]
    fn nearest(&self, point: &Point3<f64>) -> Point3<f64> {
        self.axis.foot(point)
    }
}

impl Straight for Capsule {
    #[inline]
    fn nearest(&self, point: &Point3<f64>) -> Point3<f64> {
        self.segment.closest_point(point)
    }
}
