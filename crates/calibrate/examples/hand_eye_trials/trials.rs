//! Seeded trials: what the robot told and the camera saw, with the truth beside it.

use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};
use pomona_calibrate::PoseSample;
use pomona_transforms::{FrameTag, Transform, TransformError};
use rand::RngExt;
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

const POSES: usize = 15;
/// Noise of the target's seen pose: root mean square of the rotation's angle and of the shift's length; where the
/// case says `per axis`, the standard deviation of each of their components, √3 times as much.
const NOISE_RAD: f64 = 0.2 * PI / 180.0;
const NOISE_M: f64 = 1e-3;
pub(crate) const CASES: [&str; 5] = [
    "clean",
    "flipped",
    "clean, per axis",
    "flipped, per axis",
    "small",
];
/// A pose as translation x y z in metres and quaternion x y z w.
pub(crate) type Numbers = [f64; 7];

#[derive(Serialize, Deserialize)]
pub(crate) struct Trial {
    /// One of `CASES`: `flipped`, one target is seen with its tilt reversed; `small`, no rotation
    /// between two poses reaches 3°.
    pub(crate) case: String,
    pub(crate) seed: u64,
    pub(crate) robot_from_camera: Numbers,
    robot_from_flange: Vec<Numbers>,
    camera_from_target: Vec<Numbers>,
}

pub(crate) fn trial(case: &str, seed: u64) -> Trial {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    // The camera looks at the workspace from 0.8 m; the target is mounted away from the flange.
    let look = UnitQuaternion::from_euler_angles(-PI / 2.0, 0.0, PI / 2.0);
    let robot_from_camera = Isometry3::from_parts(
        Translation3::new(1.4, 0.1, 0.5),
        UnitQuaternion::from_scaled_axis(vector(&mut rng, 0.3)) * look,
    );
    let flange_from_target = Isometry3::from_parts(
        Translation3::new(0.03, -0.02, 0.08),
        UnitQuaternion::from_scaled_axis(vector(&mut rng, 0.5)),
    );
    let (turn, reach) = if case == "small" {
        (1.4_f64.to_radians(), 0.02)
    } else {
        (60.0_f64.to_radians(), 0.25)
    };
    let share = if case.ends_with("per axis") {
        1.0
    } else {
        3.0_f64.sqrt().recip()
    };
    let facing = UnitQuaternion::from_euler_angles(0.0, PI / 2.0, 0.0);
    let mut robot_from_flange = Vec::new();
    let mut camera_from_target = Vec::new();
    for _ in 0..POSES {
        let axis = normal(&mut rng, 1.0).normalize();
        let angle = rng.random_range(0.0..turn);
        let place = Vector3::new(0.6, 0.0, 0.5) + vector(&mut rng, reach);
        let flange = Isometry3::from_parts(
            Translation3::from(place),
            UnitQuaternion::from_scaled_axis(axis * angle) * facing,
        );
        let seen = robot_from_camera.inv_mul(&(flange * flange_from_target));
        let noisy = Isometry3::from_parts(
            Translation3::from(seen.translation.vector + normal(&mut rng, share * NOISE_M)),
            UnitQuaternion::from_scaled_axis(normal(&mut rng, share * NOISE_RAD)) * seen.rotation,
        );
        robot_from_flange.push(numbers(&flange));
        camera_from_target.push(noisy);
    }
    if case.starts_with("flipped") {
        // The one that is tilted most: nearly head-on both answers are the same.
        let turned = |i: &usize| {
            let (a, b) = (&camera_from_target[*i], flipped(&camera_from_target[*i]));
            a.rotation.angle_to(&b.rotation)
        };
        let at = (0..POSES).max_by(|i, j| turned(i).total_cmp(&turned(j)));
        if let Some(at) = at {
            camera_from_target[at] = flipped(&camera_from_target[at]);
        }
    }
    Trial {
        case: case.to_owned(),
        seed,
        robot_from_camera: numbers(&robot_from_camera),
        robot_from_flange,
        camera_from_target: camera_from_target.iter().map(numbers).collect(),
    }
}

/// The other answer for a flat marker, which detectors give when corners are noisy: its tilt against the line
/// of sight is reversed (Schweighofer and Pinz 2006, doi 10.1109/TPAMI.2006.252).
fn flipped(seen: &Isometry3<f64>) -> Isometry3<f64> {
    let (normal, sight) = (seen.rotation * Vector3::z(), -seen.translation.vector);
    let normal = normal * normal.dot(&sight).signum();
    let axis = normal.cross(&sight);
    let tilt = axis.norm().atan2(normal.dot(&sight));
    let turn = UnitQuaternion::from_scaled_axis(axis.normalize() * (2.0 * tilt));
    Isometry3::from_parts(seen.translation, turn * seen.rotation)
}

fn vector(rng: &mut ChaCha8Rng, size: f64) -> Vector3<f64> {
    Vector3::from_fn(|_, _| rng.random_range(-size..size))
}

/// Three normal numbers (Box and Muller 1958, doi 10.1214/aoms/1177706645).
fn normal(rng: &mut ChaCha8Rng, sigma: f64) -> Vector3<f64> {
    Vector3::from_fn(|_, _| {
        let (u, v): (f64, f64) = (rng.random(), rng.random());
        sigma * (-2.0 * (1.0 - u).ln()).sqrt() * (2.0 * PI * v).cos()
    })
}

fn numbers(t: &Isometry3<f64>) -> Numbers {
    let ([x, y, z], [a, b, c, d]): ([f64; 3], [f64; 4]) =
        (t.translation.vector.into(), t.rotation.coords.into());
    [x, y, z, a, b, c, d]
}

pub(crate) fn transform<To: FrameTag, From: FrameTag>(
    n: &Numbers,
) -> Result<Transform<To, From>, TransformError> {
    Transform::from_quaternion([n[0], n[1], n[2]], [n[3], n[4], n[5], n[6]])
}

impl Trial {
    /// The trial as samples of the library.
    pub(crate) fn samples(&self) -> Result<Vec<PoseSample>, TransformError> {
        let poses = self.robot_from_flange.iter().zip(&self.camera_from_target);
        let sample = |(i, (flange, target)): (usize, (&Numbers, &Numbers))| {
            Ok(PoseSample::new(
                format!("pose-{i}"),
                transform(flange)?,
                transform(target)?,
            ))
        };
        poses.enumerate().map(sample).collect()
    }
}
