use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};
use pomona_transforms::{Direction, RobotFrame, ToolOrientation};
use std::f64::consts::PI;

/// The orientation of a tool that approaches along `direction`, turned by `roll_rad` about it, in
/// the base's frame.
///
/// Without roll it is that of [`ToolOrientation::along`]: RX = 0 in the order Z–Y–X (Gao et al. 2022,
/// Eq. 11, doi 10.3390/agriculture12081170).
pub fn tool_rotation(direction: &Direction<RobotFrame>, roll_rad: f64) -> UnitQuaternion<f64> {
    let base = ToolOrientation::along(direction).quaternion;
    base * UnitQuaternion::from_axis_angle(&Vector3::x_axis(), roll_rad)
}

/// The orientation with the fingers on either side of a branch with direction `branch`: the tool's
/// y, along which it opens, is perpendicular to both. `None` where the branch runs along the
/// approach within 0.1 rad, or is not finite.
pub(crate) fn aligned(
    direction: &Direction<RobotFrame>,
    branch: &Vector3<f64>,
) -> Option<UnitQuaternion<f64>> {
    let x = direction.vector();
    let y = branch.try_normalize(1e-9)?.cross(&x);
    if !(y.norm() > 0.1) {
        return None;
    }
    let y = y.normalize();
    let matrix = Matrix3::from_columns(&[x, y, x.cross(&y)]);
    Some(UnitQuaternion::from_rotation_matrix(
        &Rotation3::from_matrix_unchecked(matrix),
    ))
}

/// Of the orientation and the same turned by half a turn about the approach, which are equivalent for the gripper, the
/// one nearer to `reference`.
pub(crate) fn nearer_half_turn(
    rotation: UnitQuaternion<f64>,
    reference: &UnitQuaternion<f64>,
) -> UnitQuaternion<f64> {
    let other = rotation * UnitQuaternion::from_axis_angle(&Vector3::x_axis(), PI);
    if other.angle_to(reference) < rotation.angle_to(reference) {
        other
    } else {
        rotation
    }
}

/// The turn about the tool's x that leads from the orientation without roll to `rotation`, −π to π.
pub(crate) fn roll_of(direction: &Direction<RobotFrame>, rotation: &UnitQuaternion<f64>) -> f64 {
    let turn = tool_rotation(direction, 0.0).inverse() * rotation;
    let angle = 2.0 * turn.i.atan2(turn.w);
    if angle > PI {
        angle - 2.0 * PI
    } else if angle <= -PI {
        angle + 2.0 * PI
    } else {
        angle
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_tool_points_along_its_direction(
            d in prop::array::uniform3(-1.0..1.0f64), b in prop::array::uniform3(-1.0..1.0f64), roll in -3.1..3.1f64,
        ) {
            let d = Vector3::from(d);
            prop_assume!(d.norm() > 1e-3);
            let direction = Direction::new(d).unwrap();
            let rotation = tool_rotation(&direction, roll);
            prop_assert!((rotation * Vector3::x() - direction.vector()).norm() < 1e-12);
            prop_assert!((roll_of(&direction, &rotation) - roll).abs() < 1e-9);
            if let Some(rotation) = aligned(&direction, &Vector3::from(b)) {
                prop_assert!((rotation * Vector3::x() - direction.vector()).norm() < 1e-12);
                prop_assert!((rotation * Vector3::y()).dot(&Vector3::from(b)).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn a_branch_along_the_approach_aligns_nothing() {
        let direction = Direction::new(Vector3::z()).unwrap();
        assert!(aligned(&direction, &Vector3::new(0.0, 0.05, 1.0)).is_none());
        assert!(aligned(&direction, &Vector3::zeros()).is_none());
        assert!(aligned(&direction, &Vector3::new(f64::NAN, 0.0, 0.0)).is_none());
        let half = aligned(&direction, &Vector3::y()).unwrap();
        let near = nearer_half_turn(half, &tool_rotation(&direction, 0.0));
        assert!(
            near.angle_to(&tool_rotation(&direction, 0.0)) <= std::f64::consts::FRAC_PI_2 + 1e-12
        );
    }
}
