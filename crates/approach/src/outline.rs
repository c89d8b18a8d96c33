//! The gripper in its own frame, where its distance from a point is cheap.

use crate::swept_volume::SweptVolume;
use nalgebra::{Isometry3, Matrix3, Point3, Vector3};

/// A part: the points within `radius` of a rectangle in the plane z = 0, and of its mirror image in y.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Part {
    x: [f64; 2],
    /// The sides of the rectangle on y ≥ 0; one that reaches across has a negative first side.
    y: [f64; 2],
    radius: f64,
}

/// The parts of a gripper, open or swept, in the tool frame.
///
/// All of them lie in the plane of the fingers with their sides along x and y, and the second finger is the first
/// one's mirror image. So three rectangles represent four volumes, and the nearest point of each is found by
/// comparing coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Outline([Part; 3]);

impl Outline {
    /// That of finger, its mirror image, palm and wrist.
    pub(crate) fn of([finger, _, palm, wrist]: &[SweptVolume; 4]) -> Self {
        Self([finger, palm, wrist].map(|body| {
            let range = |axis: usize| {
                let corners = body.corners().map(|corner| corner[axis]);
                let low = corners.into_iter().fold(f64::INFINITY, f64::min);
                [low, corners.into_iter().fold(f64::NEG_INFINITY, f64::max)]
            };
            Part {
                x: range(0),
                y: range(1),
                radius: body.radius,
            }
        }))
    }
}

/// An outline at a pose.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PlacedOutline {
    outline: Outline,
    /// Rows: the tool's axes in the base.
    rotation: Matrix3<f64>,
    origin: Point3<f64>,
}

impl PlacedOutline {
    pub(crate) fn new(outline: &Outline, pose: &Isometry3<f64>) -> Self {
        Self {
            outline: *outline,
            rotation: pose.rotation.to_rotation_matrix().into_inner().transpose(),
            origin: pose.translation.vector.into(),
        }
    }

    /// Distance of the gripper's surface from a point of the base's frame, negative inside.
    #[inline(always)]
    pub(crate) fn distance(&self, point: &Point3<f64>) -> f64 {
        let p: Vector3<f64> = self.rotation * (point - self.origin);
        let (y, zz) = (p.y.abs(), p.z * p.z);
        let beyond = |[low, high]: [f64; 2], at: f64| (low - at).max(at - high).max(0.0);
        let mut least = f64::INFINITY;
        for part in &self.outline.0 {
            let (dx, dy) = (beyond(part.x, p.x), beyond(part.y, y));
            least = least.min((dx * dx + dy * dy + zz).sqrt() - part.radius);
        }
        least
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Gripper;
    use nalgebra::UnitQuaternion;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn it_is_as_far_as_the_nearest_body(
            place in prop::array::uniform3(-1.0..1.0f64),
            turn in prop::array::uniform3(-2.0..2.0f64),
            point in prop::array::uniform3(-0.4..0.4f64),
            length in 0.0..0.3f64,
            radius in 0.01..0.08f64,
        ) {
            let gripper = Gripper::default();
            let pose = Isometry3::from_parts(place.into(), UnitQuaternion::from_scaled_axis(turn.into()));
            let point = Point3::from(Vector3::from(place) + Vector3::from(point));
            for bodies in [gripper.open(), gripper.swept(length, radius)] {
                let moved = bodies.map(|body| body.moved(&pose));
                let least = moved.iter().map(|b| b.distance_to_point(&point)).fold(f64::INFINITY, f64::min);
                let found = PlacedOutline::new(&Outline::of(&bodies), &pose).distance(&point);
                prop_assert!((found - least).abs() < 1e-12, "{found} {least}");
            }
        }
    }
}
