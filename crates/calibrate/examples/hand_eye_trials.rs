//! Seeded trials of eye-to-hand calibration, for comparison with other programs.
//!
//! `hand_eye_trials export FILE TRIALS` writes the trials as JSON, and `hand_eye_trials solve FILE`
//! calibrates each and prints a line of JSON for each answer: the error where there is one, the
//! reason where it is refused. `cargo xtask bench calibration` runs it beside OpenCV.

use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3};
use pomona_calibrate::{
    CalibrateError, Options, PoseSample, PoseSolver, calibrate_eye_to_hand, calibrate_robot_world,
    solve_without_robustness,
};
use pomona_transforms::{CameraFrame, FrameTag, Position, RobotFrame, Transform};
use rand::RngExt;
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use serde::{Deserialize, Serialize};
use std::error::Error;
use std::f64::consts::PI;
use std::time::Instant;

const POSES: usize = 15;
/// Noise of the target's seen pose: root mean square of the rotation's angle and of the shift's length; where the
/// case says `per axis`, the standard deviation of each of their components, √3 times as much.
const NOISE_RAD: f64 = 0.2 * PI / 180.0;
const NOISE_M: f64 = 1e-3;
const CASES: [&str; 5] = [
    "clean",
    "flipped",
    "clean, per axis",
    "flipped, per axis",
    "small",
];
/// Where the error at the fruit is taken, straight ahead of the camera.
const FRUIT_M: f64 = 0.8;

/// A pose as translation x y z in metres and quaternion x y z w.
type Numbers = [f64; 7];

#[derive(Serialize, Deserialize)]
struct Trial {
    /// One of `CASES`: `flipped`, one target is seen with its tilt reversed; `small`, no rotation
    /// between two poses reaches 3°.
    case: String,
    seed: u64,
    robot_from_camera: Numbers,
    robot_from_flange: Vec<Numbers>,
    camera_from_target: Vec<Numbers>,
}

/// One method's answer to one trial; the rest is absent where it is refused.
#[derive(Serialize)]
struct Answer<'a> {
    case: &'a str,
    seed: u64,
    method: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    rotation_deg: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    translation_mm: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    fruit_mm: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    refused: Option<String>,
    milliseconds: f64,
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["export", path, trials] => {
            let trials = trials.parse()?;
            let all: Vec<Trial> = CASES
                .into_iter()
                .flat_map(|case| (0..trials).map(move |seed| trial(case, seed)))
                .collect();
            Ok(std::fs::write(path, serde_json::to_string(&all)?)?)
        }
        ["solve", path] => {
            let all: Vec<Trial> = serde_json::from_str(&std::fs::read_to_string(path)?)?;
            for trial in &all {
                for answer in answers(trial)? {
                    println!("{}", serde_json::to_string(&answer)?);
                }
            }
            Ok(())
        }
        _ => Err("usage: hand_eye_trials export FILE TRIALS | solve FILE".into()),
    }
}

fn trial(case: &str, seed: u64) -> Trial {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    // The camera looks at the workspace from 0.8 m; the target stands off the flange.
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

fn transform<To: FrameTag, From: FrameTag>(
    n: &Numbers,
) -> Result<Transform<To, From>, Box<dyn Error>> {
    Ok(Transform::from_quaternion(
        [n[0], n[1], n[2]],
        [n[3], n[4], n[5], n[6]],
    )?)
}

type RobotFromCamera = Transform<RobotFrame, CameraFrame>;

fn answers(trial: &Trial) -> Result<Vec<Answer<'_>>, Box<dyn Error>> {
    let truth: RobotFromCamera = transform(&trial.robot_from_camera)?;
    let mut samples = Vec::new();
    let poses = trial
        .robot_from_flange
        .iter()
        .zip(&trial.camera_from_target);
    for (i, (flange, target)) in poses.enumerate() {
        samples.push(PoseSample {
            id: format!("pose-{i}"),
            robot_from_flange: transform(flange)?,
            camera_from_target: transform(target)?,
        });
    }
    let options = Options::default();
    let mut rng = ChaCha8Rng::seed_from_u64(trial.seed);
    let mut answers = Vec::new();
    let mut add = |method, solve: &mut dyn FnMut() -> Result<RobotFromCamera, CalibrateError>| {
        let start = Instant::now();
        let found: Result<RobotFromCamera, _> = solve();
        let milliseconds = start.elapsed().as_secs_f64() * 1e3;
        let error = found.as_ref().ok().map(|found| {
            let turn = (found.rotation() * truth.rotation().inverse()).angle();
            let shift = (found.translation_m() - truth.translation_m()).norm();
            let fruit = Position::new(Point3::new(0.0, 0.0, FRUIT_M));
            let at_fruit = found.position(&fruit).distance(&truth.position(&fruit));
            (turn.to_degrees(), shift * 1e3, at_fruit * 1e3)
        });
        answers.push(Answer {
            case: &trial.case,
            seed: trial.seed,
            method,
            rotation_deg: error.map(|e| e.0),
            translation_mm: error.map(|e| e.1),
            fruit_mm: error.map(|e| e.2),
            refused: found.err().map(|e| e.to_string()),
            milliseconds,
        });
    };
    add("pomona eye-to-hand", &mut || {
        calibrate_eye_to_hand(&samples, &options, &mut rng).map(|c| c.camera.transform)
    });
    add("pomona robot-world", &mut || {
        calibrate_robot_world(&samples, &options, &mut rng).map(|c| c.camera.transform)
    });
    for (method, solver) in [
        ("pomona, Park alone", PoseSolver::Park),
        ("pomona, Daniilidis alone", PoseSolver::Daniilidis),
        ("pomona, Shah alone", PoseSolver::Shah),
    ] {
        add(method, &mut || {
            solve_without_robustness(&samples, solver).ok_or(CalibrateError::Undetermined)
        });
    }
    Ok(answers)
}
