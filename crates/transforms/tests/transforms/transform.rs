//! Properties of rigid transforms: they compose, invert and keep distances and angles.

use nalgebra::{Point3, UnitQuaternion, Vector3};
use pomona_transforms::{CameraFrame, Direction, FrameTag, Position, RobotFrame, Transform};
use proptest::prelude::*;

enum PlatformFrame {}

impl FrameTag for PlatformFrame {
    const NAME: &'static str = "platform";
}

fn vector() -> impl Strategy<Value = Vector3<f64>> {
    prop::array::uniform3(-5.0..5.0f64).prop_map(Vector3::from)
}

fn position() -> impl Strategy<Value = Position<CameraFrame>> {
    vector().prop_map(|v| Position::new(v.into()))
}

fn direction() -> impl Strategy<Value = Direction<CameraFrame>> {
    vector().prop_filter_map("no direction", Direction::new)
}

fn transform<To: FrameTag, From: FrameTag>() -> impl Strategy<Value = Transform<To, From>> {
    (vector(), vector()).prop_map(|(t, axis_angle)| {
        let [x, y, z, w]: [f64; 4] = UnitQuaternion::from_scaled_axis(axis_angle).coords.into();
        Transform::from_quaternion(t.into(), [x, y, z, w]).expect("finite, and a rotation")
    })
}

proptest! {
    #[test]
    fn a_product_is_one_after_the_other(
        platform_from_robot in transform::<PlatformFrame, RobotFrame>(),
        robot_from_camera in transform::<RobotFrame, CameraFrame>(),
        p in position(),
        d in direction(),
    ) {
        let platform_from_camera = platform_from_robot * robot_from_camera;
        let stepwise = platform_from_robot.position(&robot_from_camera.position(&p));
        prop_assert!(platform_from_camera.position(&p).distance(&stepwise) < 1e-12);
        let stepwise = platform_from_robot.direction(&robot_from_camera.direction(&d));
        prop_assert!(platform_from_camera.direction(&d).angle_to(&stepwise) < 1e-12);
    }

    #[test]
    fn the_inverse_leads_back(
        robot_from_camera in transform::<RobotFrame, CameraFrame>(),
        p in position(),
        d in direction(),
    ) {
        let camera_from_robot = robot_from_camera.inverse();
        prop_assert!(camera_from_robot.position(&robot_from_camera.position(&p)).distance(&p) < 1e-12);
        prop_assert!(camera_from_robot.direction(&robot_from_camera.direction(&d)).angle_to(&d) < 1e-12);
        let nothing = robot_from_camera * camera_from_robot;
        let identity = Transform::<RobotFrame, RobotFrame>::identity();
        prop_assert!((nothing.matrix() - identity.matrix()).amax() < 1e-12);
    }

    #[test]
    fn distances_angles_and_handedness_stay(
        robot_from_camera in transform::<RobotFrame, CameraFrame>(),
        p in position(),
        q in position(),
        d in direction(),
        e in direction(),
    ) {
        let (p2, q2) = (robot_from_camera.position(&p), robot_from_camera.position(&q));
        prop_assert!((p2.distance(&q2) - p.distance(&q)).abs() < 1e-12);
        let (d2, e2) = (robot_from_camera.direction(&d), robot_from_camera.direction(&e));
        prop_assert!((d2.angle_to(&e2) - d.angle_to(&e)).abs() < 1e-12);
        prop_assert!((d2.vector().norm() - 1.0).abs() < 1e-14);
        let rotated = robot_from_camera.rotation() * d.vector().cross(&e.vector());
        prop_assert!((d2.vector().cross(&e2.vector()) - rotated).norm() < 1e-12);
    }

    #[test]
    fn a_direction_is_where_the_other_position_lies(
        robot_from_camera in transform::<RobotFrame, CameraFrame>(),
        p in position(),
        q in position(),
    ) {
        prop_assume!(p.distance(&q) > 1e-2);
        let before = robot_from_camera.direction(&p.direction_to(&q).unwrap());
        let (p, q) = (robot_from_camera.position(&p), robot_from_camera.position(&q));
        prop_assert!(before.angle_to(&p.direction_to(&q).unwrap()) < 1e-11);
    }

    #[test]
    fn its_matrix_is_the_same_transform(
        robot_from_camera in transform::<RobotFrame, CameraFrame>(),
        p in position(),
    ) {
        let again = Transform::<RobotFrame, CameraFrame>::from_matrix(&robot_from_camera.matrix());
        let again = again.unwrap();
        prop_assert!(again.position(&p).distance(&robot_from_camera.position(&p)) < 1e-12);
        let homogeneous = robot_from_camera.matrix() * p.point().to_homogeneous();
        let expected = Point3::from_homogeneous(homogeneous).unwrap();
        prop_assert!((robot_from_camera.position(&p).point() - expected).norm() < 1e-12);
    }
}
