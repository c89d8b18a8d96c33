//! Messages of `builtin_interfaces`, `std_msgs` and `geometry_msgs`, each with all the fields of its definition.

use nalgebra::Isometry3;
use serde::Serialize;

/// `builtin_interfaces/Time`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Time {
    /// Seconds.
    pub sec: i32,
    /// Nanoseconds.
    pub nanosec: u32,
}

/// `builtin_interfaces/Duration`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Duration {
    /// Seconds.
    pub sec: i32,
    /// Nanoseconds.
    pub nanosec: u32,
}

/// `std_msgs/Header`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Header {
    /// Time.
    pub stamp: Time,
    /// Frame of the data.
    pub frame_id: String,
}

/// `geometry_msgs/Point`, metres.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Point {
    /// x.
    pub x: f64,
    /// y.
    pub y: f64,
    /// z.
    pub z: f64,
}

/// `geometry_msgs/Vector3`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Vector3 {
    /// x.
    pub x: f64,
    /// y.
    pub y: f64,
    /// z.
    pub z: f64,
}

impl From<[f64; 3]> for Vector3 {
    fn from([x, y, z]: [f64; 3]) -> Self {
        Self { x, y, z }
    }
}

/// `geometry_msgs/Quaternion`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Quaternion {
    /// x.
    pub x: f64,
    /// y.
    pub y: f64,
    /// z.
    pub z: f64,
    /// w.
    pub w: f64,
}

/// `geometry_msgs/Pose`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Pose {
    /// Position.
    pub position: Point,
    /// Orientation.
    pub orientation: Quaternion,
}

impl From<&Isometry3<f64>> for Pose {
    fn from(pose: &Isometry3<f64>) -> Self {
        let (t, q) = (pose.translation.vector, pose.rotation.coords);
        Self {
            position: Point {
                x: t.x,
                y: t.y,
                z: t.z,
            },
            orientation: Quaternion {
                x: q.x,
                y: q.y,
                z: q.z,
                w: q.w,
            },
        }
    }
}

/// `geometry_msgs/PoseStamped`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PoseStamped {
    /// Frame and time.
    pub header: Header,
    /// The pose.
    pub pose: Pose,
}

/// `geometry_msgs/PoseArray`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PoseArray {
    /// Frame and time.
    pub header: Header,
    /// The poses.
    pub poses: Vec<Pose>,
}

/// `geometry_msgs/Vector3Stamped`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Vector3Stamped {
    /// Frame and time.
    pub header: Header,
    /// The vector.
    pub vector: Vector3,
}

/// `geometry_msgs/Polygon`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Polygon {
    /// None here.
    pub points: Vec<Point>,
}
