//! Geometric primitives in space: distances, feet of perpendiculars, angles.
//!
//! ```
//! use nalgebra::{Point3, Vector3};
//! use pomona_geometry::{Line, Sphere};
//!
//! let apple = Sphere::new(Point3::new(0.0, 0.0, 0.8), 0.04).unwrap();
//! let branch = Line::new(Point3::new(-1.0, -0.05, 0.8), Vector3::x()).unwrap();
//!
//! // The picking direction: from the centre to the nearest point of the branch.
//! let foot = branch.foot(&apple.center);
//! let direction = (foot - apple.center).normalize();
//! assert!((direction - Vector3::new(0.0, -1.0, 0.0)).norm() < 1e-12);
//! ```
//!
//! # Concepts
//!
//! Every shape is a plain value of `f64`s whose constructor returns `None` for invalid input (a radius that is not
//! positive, a direction of length zero, anything not finite). Lengths are in one unit throughout (metres in this
//! project), angles in radians. The primitives carry no coordinate frame: the caller keeps the points of one frame
//! together.
//!
//! # Not here
//!
//! Data sets, noise and fitting are in `pomona-fit`, rigid transforms between named frames in `pomona-transforms`.

mod aabb;
mod angle;
mod basis;
mod capsule;
mod circle;
mod cylinder;
mod line;
mod plane;
mod segment;
mod sphere;

pub use aabb::Aabb;
pub use angle::{angle_between, angle_between_axes};
pub use basis::across;
pub use capsule::Capsule;
pub use circle::Circle;
pub use cylinder::Cylinder;
pub use line::Line;
pub use plane::Plane;
pub use segment::Segment;
pub use sphere::Sphere;
