//! Properties of the tool's orientation over all directions.

use nalgebra::{Isometry3, Point3, UnitQuaternion, Vector3};
use pomona_transforms::{
    Direction, EulerZyx, Position, RobotFrame, ToolModel, ToolOrientation, Transform,
    paper_as_printed_euler,
};
use proptest::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI};

/// Uniform on the sphere: Archimedes' projection of its cylinder.
fn direction() -> impl Strategy<Value = Direction<RobotFrame>> {
    (-1.0..=1.0f64, -PI..=PI).prop_map(|(z, azimuth)| {
        let horizontal = (1.0 - z * z).sqrt();
        let (sin, cos) = azimuth.sin_cos();
        Direction::new(Vector3::new(horizontal * cos, horizontal * sin, z))
            .expect("a vector of length 1")
    })
}

/// Directions whose components are exact zeros, tiny or of one size: axes, planes, and what
/// lies close to them.
fn awkward_direction() -> impl Strategy<Value = Direction<RobotFrame>> {
    let component = prop_oneof![
        Just(0.0),
        Just(-0.0),
        Just(1.0),
        Just(-1.0),
        (-20.0..0.0f64, any::<bool>()).prop_map(|(e, negative)| {
            let size = 10.0_f64.powf(e);
            if negative { -size } else { size }
        }),
    ];
    prop::array::uniform3(component).prop_filter_map("no direction", |c| Direction::new(c.into()))
}

fn holds(direction: &Direction<RobotFrame>) -> Result<(), TestCaseError> {
    let tool = ToolOrientation::along(direction);
    let d = direction.vector();

    let tolerance = if tool.singular { 1.1e-6 } else { 1e-12 };
    prop_assert!((tool.quaternion * Vector3::x() - d).norm() < tolerance);
    let by_angles = tool.euler.rotation();
    prop_assert!((by_angles * Vector3::x() - d).norm() < tolerance);
    prop_assert!(by_angles.angle_to(&tool.quaternion) < 1e-12);

    let EulerZyx { rx, ry, rz } = tool.euler;
    prop_assert!(rx == 0.0 && ry.abs() <= FRAC_PI_2 && rz.abs() <= PI);
    // Eq. 11 leaves the tool's y axis horizontal.
    prop_assert!((tool.quaternion * Vector3::y()).z.abs() < 1e-12);
    prop_assert_eq!(tool.singular, d.x.hypot(d.y) <= 1e-6);

    let xyzw = tool.quaternion_xyzw();
    let [x, y, z, w] = xyzw;
    prop_assert!((xyzw.iter().map(|c| c * c).sum::<f64>() - 1.0).abs() < 1e-14);
    prop_assert!(w >= 0.0);
    if w == 0.0 {
        let first = [x, y, z].into_iter().find(|c| c.abs() > 1e-15);
        prop_assert!(first.is_some_and(|c| c > 0.0), "{xyzw:?}");
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100_000))]

    #[test]
    fn the_approach_axis_is_the_direction(direction in direction()) {
        holds(&direction)?;
    }

    #[test]
    fn on_and_near_the_axes_too(direction in awkward_direction()) {
        holds(&direction)?;
    }

    #[test]
    fn the_printed_angles_differ_in_the_sign_of_ry_alone(direction in direction()) {
        let tool = ToolOrientation::along(&direction);
        prop_assume!(!tool.singular);
        let printed = paper_as_printed_euler(&direction);
        prop_assert_eq!(printed, EulerZyx { ry: -tool.euler.ry, ..tool.euler });
    }

    #[test]
    fn both_ways_to_the_flange_agree(direction in direction(), axis in direction(), mount in prop::array::uniform3(-1.0..1.0f64)) {
        let axis = Direction::from_unit(nalgebra::Unit::new_unchecked(axis.vector()));
        let turned = UnitQuaternion::from_scaled_axis(Vector3::from(mount));
        let tcp_from_flange = Transform::from_isometry(&Isometry3::from_parts(Vector3::from(mount).into(), turned)).unwrap();
        let tool = ToolModel::new(tcp_from_flange, axis);
        let orientation = ToolOrientation::along(&direction);
        let tcp = Position::new(Point3::from(mount));
        let approach = Isometry3::from_parts(tcp.point().coords.into(), orientation.quaternion);
        let one = tool.flange_pose(&tcp, &orientation).unwrap().isometry();
        let other = tool.flange_at(&approach);
        prop_assert!((one.to_homogeneous() - other.to_homogeneous()).amax() < 1e-12);
        // The tool's axis, carried by the flange, points along the direction.
        let carried = other * tcp_from_flange.isometry().inverse() * axis.vector();
        prop_assert!((carried - direction.vector()).norm() < 2e-6);
    }
}
