//! Poses of solids.

use nalgebra::{Isometry3, Point3, UnitQuaternion, Vector3};
use std::f64::consts::PI;

/// Pose and length of a cylinder along its own z axis that reaches from `start` to `end`.
///
/// Where it points straight down the rotation is a half turn about x.
pub(crate) fn along_z(start: &Point3<f64>, end: &Point3<f64>) -> (Isometry3<f64>, f64) {
    let along = end - start;
    let rotation = UnitQuaternion::rotation_between(&Vector3::z(), &along)
        .unwrap_or_else(|| UnitQuaternion::from_axis_angle(&Vector3::x_axis(), PI));
    let middle = nalgebra::center(start, end);
    let pose = Isometry3::from_parts(middle.coords.into(), rotation);
    (pose, along.norm())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_ends_are_on_the_axis() {
        let start = Point3::new(0.1, -0.2, 0.3);
        for end in [Point3::new(0.4, 0.1, 0.0), Point3::new(0.1, -0.2, -0.5)] {
            let (pose, length) = along_z(&start, &end);
            let tip = |z: f64| pose * Point3::new(0.0, 0.0, z * length);
            assert!((tip(-0.5) - start).norm() < 1e-12);
            assert!((tip(0.5) - end).norm() < 1e-12);
        }
    }
}
