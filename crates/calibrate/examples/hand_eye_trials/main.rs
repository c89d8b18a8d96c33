//! Seeded trials of eye-to-hand calibration, for comparison with other programs.
//!
//! `hand_eye_trials export FILE TRIALS` writes the trials as JSON, and `hand_eye_trials solve FILE`
//! calibrates each and prints a line of JSON for each answer: the error where there is one, the
//! reason where it is refused. `cargo xtask bench calibration` runs it beside OpenCV.

mod trials;

use nalgebra::Point3;
use pomona_calibrate::{
    CalibrateError, Options, PoseSolver, calibrate_eye_to_hand, calibrate_robot_world,
    solve_without_robustness,
};
use pomona_transforms::{CameraFrame, Position, RobotFrame, Transform};
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use serde::Serialize;
use std::error::Error;
use std::time::Instant;
use trials::{CASES, Trial, transform, trial};

/// Where the error at the fruit is taken, straight ahead of the camera.
const FRUIT_M: f64 = 0.8;

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

type RobotFromCamera = Transform<RobotFrame, CameraFrame>;

fn answers(trial: &Trial) -> Result<Vec<Answer<'_>>, Box<dyn Error>> {
    let truth: RobotFromCamera = transform(&trial.robot_from_camera)?;
    let samples = trial.samples()?;
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
