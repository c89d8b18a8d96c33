//! Rendered pieces of an orchard, seen from several sides.

#![expect(
    clippy::unwrap_used,
    reason = "a test that cannot go on should fail where it stands"
)]

use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3};
use pomona::{CheckedFrame, Config, FrameAnswer, Method, Picker, RobotFromCamera};
use pomona_scenes::{Make, Orchard, Shot};
use pomona_transforms::Transform;

/// The tree from several cameras, and where its apples truly are in the robot's frame.
pub(crate) struct Views {
    pub(crate) frames: Vec<(FrameAnswer, RobotFromCamera)>,
    pub(crate) centers: Vec<Vector3<f64>>,
    /// The true direction of each apple that a frame boxes.
    pub(crate) directions: Vec<Option<Vector3<f64>>>,
}

/// A camera at `distance` from `target`, turned about it by `angle` from the robot's side and raised by `up`,
/// radians; x of the robot points to the tree, z up.
pub(crate) fn pose_towards(
    target: Vector3<f64>,
    distance: f64,
    angle: f64,
    up: f64,
) -> Isometry3<f64> {
    let forward = Vector3::new(angle.cos() * up.cos(), angle.sin() * up.cos(), -up.sin());
    let right = forward.cross(&Vector3::z()).normalize();
    let down = forward.cross(&right);
    let rotation = nalgebra::Rotation3::from_basis_unchecked(&[right, down, forward]);
    let place = target - forward * distance;
    Isometry3::from_parts(
        Translation3::from(place),
        UnitQuaternion::from_rotation_matrix(&rotation),
    )
}

/// The orchard of `seed` from three sides, 0.35 rad apart, picked by `robust`.
pub(crate) fn views(seed: u64) -> Views {
    let camera = Shot::paper_camera();
    let world = Orchard::default().world(&camera, seed);
    let first = pose_towards(Vector3::new(1.0, 0.0, 0.5), 1.0, 0.0, 0.0);
    let middle = first * world.apples()[0].center;
    let distance = (middle - first * Point3::origin()).norm();
    let picker = Picker::new(Config::default().with(|c| c.method = Method::Robust)).unwrap();
    let mut directions = vec![None; world.apples().len()];
    let frames = [0.0, -0.35, 0.35]
        .into_iter()
        .enumerate()
        .map(|(k, angle)| {
            let pose = if k == 0 {
                first
            } else {
                pose_towards(middle.coords, distance, angle, 0.1)
            };
            let seen = world.transformed(&(pose.inverse() * first));
            let sensor = Make::AzureKinect.sensor();
            let shot = Shot::new(
                format!("s{seed}-{k}"),
                camera.clone(),
                sensor,
                seed * 10 + k as u64,
            );
            let scene = shot.take(&seen);
            let frame = scene.frame;
            for truth in &scene.truth.apples {
                let center = pose * Point3::from(truth.center);
                let at = |a: &pomona_scenes::Apple| (first * a.center - center).norm() < 1e-6;
                if let (Some(i), Some(d)) = (world.apples().iter().position(at), truth.direction) {
                    directions[i] = Some(pose * Vector3::from(d));
                }
            }
            let transform = Transform::from_isometry(&pose).unwrap();
            let named = RobotFromCamera::new(transform, "base_link", camera.frame_id.clone());
            let frame = CheckedFrame::new(&frame).unwrap();
            (picker.pick(&frame, 0, Some(&named)).unwrap(), named)
        })
        .collect();
    let centers = world
        .apples()
        .iter()
        .map(|a| (first * a.center).coords)
        .collect();
    Views {
        frames,
        centers,
        directions,
    }
}
