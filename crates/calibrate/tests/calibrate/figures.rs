//! The figures of docs/calibration.md, on fewer of the same trials: limits that a change must not break.

#[path = "../../examples/hand_eye_trials/trials.rs"]
mod trials;

use pomona_calibrate::{
    CalibrateError, Options, PoseSolver, calibrate_eye_to_hand, solve_without_robustness,
};
use pomona_transforms::{CameraFrame, RobotFrame, Transform};
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use trials::{CASES, Trial, transform, trial};

const TRIALS: u64 = 40;

type RobotFromCamera = Transform<RobotFrame, CameraFrame>;

fn ours(trial: &Trial) -> Result<RobotFromCamera, CalibrateError> {
    let rng = &mut ChaCha8Rng::seed_from_u64(trial.seed);
    let samples = trial.samples().unwrap();
    let found = calibrate_eye_to_hand(&samples, &Options::default(), rng)?;
    Ok(found.camera.transform)
}

/// Medians of the errors in degrees and millimetres.
fn medians(case: &str, solve: impl Fn(&Trial) -> RobotFromCamera) -> (f64, f64) {
    assert!(CASES.contains(&case));
    let errors = (0..TRIALS).map(|seed| {
        let trial = trial(case, seed);
        assert_eq!((trial.case.as_str(), trial.seed), (case, seed));
        let truth: RobotFromCamera = transform(&trial.robot_from_camera).unwrap();
        let found = solve(&trial);
        let turn = found.rotation().angle_to(&truth.rotation()).to_degrees();
        let shift = (found.translation_m() - truth.translation_m()).norm();
        (turn, shift * 1e3)
    });
    let (mut turns, mut shifts): (Vec<f64>, Vec<f64>) = errors.unzip();
    turns.sort_by(f64::total_cmp);
    shifts.sort_by(f64::total_cmp);
    let middle = TRIALS as usize / 2;
    (turns[middle], shifts[middle])
}

#[test]
fn clean_samples_are_solved_better_than_by_any_solver_alone() {
    let (turn, shift) = medians("clean", |t| ours(t).unwrap());
    for solver in [PoseSolver::Park, PoseSolver::Daniilidis, PoseSolver::Shah] {
        let alone = medians("clean", |t| {
            solve_without_robustness(&t.samples().unwrap(), solver).unwrap()
        });
        assert!(turn < alone.0 && shift < alone.1, "{solver:?}: {alone:?}");
    }
}

#[test]
fn one_flipped_marker_changes_little() {
    let (turn, shift) = medians("flipped", |t| ours(t).unwrap());
    assert!(turn <= 0.15 && shift <= 1.5, "{turn} {shift}");
    let (turn, _) = medians("flipped, per axis", |t| ours(t).unwrap());
    assert!(turn <= 0.15, "{turn}");
}

#[test]
fn motions_under_three_degrees_are_refused() {
    for seed in 0..TRIALS {
        let error = ours(&trial("small", seed)).unwrap_err();
        assert!(
            matches!(error, CalibrateError::MotionsTooSmall { .. }),
            "{error}"
        );
    }
}
