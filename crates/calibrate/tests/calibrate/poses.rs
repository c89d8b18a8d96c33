//! Calibration from pose pairs.

use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3, Vector6};
use pomona_calibrate::{
    CalibrateError, Options, PoseSample, PoseSolver, RejectionCause, calibrate_eye_in_hand,
    calibrate_eye_to_hand, calibrate_robot_world, solve_without_robustness,
};
use pomona_transforms::{CameraFrame, FlangeFrame, RobotFrame, TargetFrame, Transform, twist};
use proptest::prelude::*;
use rand::RngExt;
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};

fn normal(rng: &mut ChaCha8Rng, sigma: f64) -> Vector3<f64> {
    Vector3::from_fn(|_, _| {
        let (u, v): (f64, f64) = (rng.random(), rng.random());
        sigma * (-2.0 * (1.0 - u).ln()).sqrt() * (std::f64::consts::TAU * v).cos()
    })
}

fn isometry(rng: &mut ChaCha8Rng, reach: f64, turn: f64) -> Isometry3<f64> {
    let t = Vector3::from_fn(|_, _| rng.random_range(-reach..reach));
    let w = Vector3::from_fn(|_, _| rng.random_range(-turn..turn));
    Isometry3::from_parts(Translation3::from(t), UnitQuaternion::from_scaled_axis(w))
}

struct SyntheticRig {
    /// Camera on its carrier: the base, or the flange.
    camera: Isometry3<f64>,
    /// Target on the other part.
    target: Isometry3<f64>,
    samples: Vec<PoseSample>,
}

/// `in_hand`: the camera is on the flange. Noise is per component, rad and m.
fn scene(n: usize, in_hand: bool, noise: (f64, f64), turn: f64, seed: u64) -> SyntheticRig {
    let rng = &mut ChaCha8Rng::seed_from_u64(seed);
    let (camera, target) = (isometry(rng, 1.0, 1.0), isometry(rng, 0.3, 1.0));
    let samples = (0..n)
        .map(|i| {
            let flange = isometry(rng, 0.3, turn);
            let carrier = if in_hand { flange.inverse() } else { flange };
            let seen = camera.inv_mul(&(carrier * target));
            let turned = UnitQuaternion::from_scaled_axis(normal(rng, noise.0)) * seen.rotation;
            let moved = seen.translation.vector + normal(rng, noise.1);
            PoseSample::new(
                format!("s{i}"),
                Transform::<RobotFrame, FlangeFrame>::from_isometry(&flange).unwrap(),
                Transform::<CameraFrame, TargetFrame>::from_isometry(&Isometry3::from_parts(
                    Translation3::from(moved),
                    turned,
                ))
                .unwrap(),
            )
        })
        .collect();
    SyntheticRig {
        camera,
        target,
        samples,
    }
}

fn flip(sample: &mut PoseSample) {
    let flipped =
        sample.camera_from_target.isometry() * UnitQuaternion::from_scaled_axis(Vector3::x() * 0.9);
    sample.camera_from_target = Transform::from_isometry(&flipped).unwrap();
}

fn rng() -> ChaCha8Rng {
    ChaCha8Rng::seed_from_u64(1)
}

fn off(a: &Isometry3<f64>, b: &Isometry3<f64>) -> f64 {
    (a.to_homogeneous() - b.to_homogeneous()).amax()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    #[test]
    fn exact_poses_give_the_exact_answer_with_one_flipped(seed in any::<u64>(), n in 8..16usize) {
        let options = Options::default();
        let mut fixed = scene(n, false, (0.0, 0.0), 1.0, seed);
        flip(&mut fixed.samples[2]);
        let found = calibrate_eye_to_hand(&fixed.samples, &options, &mut rng()).unwrap();
        prop_assert!(off(&found.camera.transform.isometry(), &fixed.camera) < 1e-8);
        prop_assert!(off(&found.target.transform.isometry(), &fixed.target) < 1e-8);
        let rejected = found.quality.samples[2].rejected.as_ref().unwrap();
        prop_assert_eq!(rejected.cause, RejectionCause::TargetFlipped);
        prop_assert_eq!(found.quality.samples.iter().filter(|s| s.rejected.is_some()).count(), 1);
        let found = calibrate_robot_world(&fixed.samples, &options, &mut rng()).unwrap();
        prop_assert!(off(&found.camera.transform.isometry(), &fixed.camera) < 1e-8);
        prop_assert_eq!(found.solver, PoseSolver::Shah);

        let mut carried = scene(n, true, (0.0, 0.0), 1.0, seed);
        flip(&mut carried.samples[0]);
        let found = calibrate_eye_in_hand(&carried.samples, &options, &mut rng()).unwrap();
        prop_assert!(off(&found.camera.transform.isometry(), &carried.camera) < 1e-8);
        prop_assert!(off(&found.target.transform.isometry(), &carried.target) < 1e-8);
    }

    #[test]
    fn every_solver_alone_is_exact_on_exact_poses(seed in any::<u64>(), n in 3..9usize) {
        let scene = scene(n, false, (0.0, 0.0), 1.0, seed);
        for solver in [PoseSolver::Park, PoseSolver::Daniilidis, PoseSolver::Shah] {
            let Some(found) = solve_without_robustness(&scene.samples, solver) else { continue; };
            prop_assert!(off(&found.isometry(), &scene.camera) < 1e-5, "{:?}", solver);
        }
    }

    #[test]
    fn the_answer_moves_with_the_robot(seed in any::<u64>()) {
        // Another base frame: the same answer in it.
        let scene = scene(10, false, (3e-3, 1e-3), 1.0, seed);
        let moved_base = isometry(&mut ChaCha8Rng::seed_from_u64(seed ^ 5), 1.0, 1.0);
        let mut moved = scene.samples.clone();
        for s in &mut moved {
            s.robot_from_flange = Transform::from_isometry(&(moved_base * s.robot_from_flange.isometry())).unwrap();
        }
        let a = calibrate_eye_to_hand(&scene.samples, &Options::default(), &mut rng()).unwrap();
        let b = calibrate_eye_to_hand(&moved, &Options::default(), &mut rng()).unwrap();
        prop_assert!(off(&(moved_base * a.camera.transform.isometry()), &b.camera.transform.isometry()) < 1e-6);
    }

    #[test]
    fn nothing_panics(
        poses in prop::collection::vec((prop::array::uniform6(prop_oneof![Just(0.0), Just(3.0), -1.0..1.0f64]),
            prop::array::uniform6(prop_oneof![Just(0.0), Just(3.0), -1.0..1.0f64])), 0..8),
    ) {
        let samples: Vec<PoseSample> = poses.iter().enumerate().map(|(i, (a, b))| PoseSample::new(
            i.to_string(),
            Transform::from_isometry(&twist::exp(&Vector6::from(*a))).unwrap(),
            Transform::from_isometry(&twist::exp(&Vector6::from(*b))).unwrap(),
        )).collect();
        let mut options = Options::default();
        options.hypotheses = 20;
        let _ = calibrate_eye_to_hand(&samples, &options, &mut rng());
        let _ = calibrate_robot_world(&samples, &options, &mut rng());
    }
}

#[test]
fn the_covariance_is_that_of_the_errors() {
    for in_hand in [false, true] {
        let (trials, mut sum, mut variance, mut stated) = (150, 0.0, 0.0, 0.0);
        for seed in 0..trials {
            let scene = scene(15, in_hand, (3.5e-3, 1e-3), 0.8, seed);
            let options = Options::default();
            let camera = if in_hand {
                let found = calibrate_eye_in_hand(&scene.samples, &options, &mut rng()).unwrap();
                (found.camera.transform.isometry(), found.camera.covariance)
            } else {
                let found = calibrate_eye_to_hand(&scene.samples, &options, &mut rng()).unwrap();
                (found.camera.transform.isometry(), found.camera.covariance)
            };
            let xi = twist::log(&(scene.camera * camera.0.inverse()));
            sum += xi.dot(&camera.1.cholesky().unwrap().solve(&xi));
            variance += xi.fixed_rows::<3>(0).norm_squared();
            stated += camera.1.fixed_view::<3, 3>(0, 0).trace();
        }
        let mean = sum / trials as f64;
        assert!((5.3..8.2).contains(&mean), "{mean}");
        assert!(
            (0.75..1.3).contains(&(stated / variance)),
            "{}",
            stated / variance
        );
    }
}

#[test]
fn motions_that_do_not_determine_the_answer_are_refused() {
    let options = Options::default();
    let small = scene(15, false, (3e-3, 1e-3), 0.015, 1);
    let error = calibrate_eye_to_hand(&small.samples, &options, &mut rng()).unwrap_err();
    assert!(
        matches!(error, CalibrateError::MotionsTooSmall { .. }),
        "{error}"
    );

    let mut one_axis = scene(15, false, (0.0, 0.0), 1.0, 2);
    let axis = Vector3::new(0.3, 0.5, 1.0).normalize();
    for (i, s) in one_axis.samples.iter_mut().enumerate() {
        let turn = UnitQuaternion::from_scaled_axis(axis * (0.1 * i as f64));
        let flange = Isometry3::from_parts(Translation3::new(0.1 * i as f64, 0.2, 0.0), turn);
        let seen = one_axis.camera.inv_mul(&(flange * one_axis.target));
        s.robot_from_flange = Transform::from_isometry(&flange).unwrap();
        s.camera_from_target = Transform::from_isometry(&seen).unwrap();
    }
    for result in [
        calibrate_eye_to_hand(&one_axis.samples, &options, &mut rng()),
        calibrate_robot_world(&one_axis.samples, &options, &mut rng()),
    ] {
        let error = result.unwrap_err();
        assert!(matches!(error, CalibrateError::OneAxis { .. }), "{error}");
    }
    // A second axis that only a wrong sample brings is none.
    let turned = UnitQuaternion::from_scaled_axis(Vector3::x() * 0.8);
    let wrong = one_axis.samples[3].robot_from_flange.isometry() * turned;
    one_axis.samples[3].robot_from_flange = Transform::from_isometry(&wrong).unwrap();
    let error = calibrate_eye_to_hand(&one_axis.samples, &options, &mut rng()).unwrap_err();
    assert!(
        matches!(
            error,
            CalibrateError::OneAxis { .. } | CalibrateError::Undetermined
        ),
        "{error}"
    );
}

#[test]
fn other_refusals() {
    let options = Options::default();
    let good = scene(12, false, (0.0, 0.0), 1.0, 3).samples;
    let error = calibrate_eye_to_hand(&good[..3], &options, &mut rng()).unwrap_err();
    assert_eq!(
        error,
        CalibrateError::TooFew {
            found: 3,
            needed: 4
        }
    );
    let mut far = good.clone();
    let mut flange = far[4].robot_from_flange.isometry();
    flange.translation.vector *= 1e3;
    far[4].robot_from_flange = Transform::from_isometry(&flange).unwrap();
    let error = calibrate_eye_to_hand(&far, &options, &mut rng()).unwrap_err();
    assert!(
        error.to_string().contains("millimetres") && error.to_string().contains("s4"),
        "{error}"
    );
    let mut mixed = good.clone();
    for i in 0..12 {
        mixed[i].camera_from_target = good[(5 * i + 2) % 12].camera_from_target;
    }
    let error = calibrate_eye_to_hand(&mixed, &options, &mut rng()).unwrap_err();
    assert!(
        matches!(
            error,
            CalibrateError::NoConsensus { .. } | CalibrateError::Undetermined
        ),
        "{error}"
    );
}

#[test]
fn poses_the_wrong_way_round_are_named() {
    let options = Options::default();
    let good = scene(12, false, (3e-3, 1e-3), 1.0, 6).samples;
    let invert = |flange: bool, target: bool| {
        let mut wrong = good.clone();
        for s in &mut wrong {
            if flange {
                let inverse = s.robot_from_flange.isometry().inverse();
                s.robot_from_flange = Transform::from_isometry(&inverse).unwrap();
            }
            if target {
                let inverse = s.camera_from_target.isometry().inverse();
                s.camera_from_target = Transform::from_isometry(&inverse).unwrap();
            }
        }
        wrong
    };
    for (flange, target) in [(true, false), (false, true)] {
        let wrong = invert(flange, target);
        let error = calibrate_eye_to_hand(&wrong, &options, &mut rng()).unwrap_err();
        assert_eq!(error, CalibrateError::Inverted);
    }
    let error = calibrate_eye_in_hand(&good, &options, &mut rng()).unwrap_err();
    assert_eq!(error, CalibrateError::Inverted);
    // Both inverted is the same equation with the unknowns exchanged: nothing in the samples tells.
    let exchanged = calibrate_eye_to_hand(&invert(true, true), &options, &mut rng()).unwrap();
    let right = calibrate_eye_to_hand(&good, &options, &mut rng()).unwrap();
    let (a, b) = (exchanged.camera.transform, right.target.transform);
    assert!(off(&a.isometry(), &b.isometry()) < 0.02);
}

#[test]
fn several_wrong_samples_are_left_out() {
    let mut scene = scene(15, false, (3e-3, 1e-3), 1.0, 7);
    for i in [1, 4, 8, 10, 13] {
        flip(&mut scene.samples[i]);
    }
    let moved = scene.samples[5].camera_from_target.isometry();
    let moved = Isometry3::from_parts(
        Translation3::from(moved.translation.vector + Vector3::new(0.03, 0.0, 0.0)),
        moved.rotation,
    );
    scene.samples[5].camera_from_target = Transform::from_isometry(&moved).unwrap();
    let found = calibrate_eye_to_hand(&scene.samples, &Options::default(), &mut rng()).unwrap();
    let quality = &found.quality;
    let rejected = |i: usize| quality.samples[i].rejected.as_ref().map(|r| r.cause);
    assert_eq!(rejected(4), Some(RejectionCause::TargetFlipped));
    assert_eq!(rejected(5), Some(RejectionCause::PlaceFarOff));
    assert_eq!((0..15).filter(|i| rejected(*i).is_some()).count(), 6);
    assert!(
        quality
            .warnings
            .iter()
            .any(|w| w.message.contains("common cause"))
    );
    assert!(off(&found.camera.transform.isometry(), &scene.camera) < 0.01);
}

#[test]
fn the_order_of_the_samples_does_not_matter() {
    let mut scene = scene(15, false, (3.5e-3, 1e-3), 1.0, 8);
    flip(&mut scene.samples[6]);
    let a = calibrate_eye_to_hand(&scene.samples, &Options::default(), &mut rng()).unwrap();
    scene.samples.reverse();
    let b = calibrate_eye_to_hand(&scene.samples, &Options::default(), &mut rng()).unwrap();
    let (a, b) = (a.camera.transform, b.camera.transform);
    assert!(off(&a.isometry(), &b.isometry()) < 1e-6);
}

#[test]
fn a_small_mistake_among_little_noise_is_found_too() {
    let mut scene = scene(15, false, (5e-4, 1e-4), 1.0, 9);
    let moved = scene.samples[5].camera_from_target.isometry();
    let moved = Isometry3::from_parts(
        Translation3::from(moved.translation.vector + Vector3::new(0.003, 0.0, 0.0)),
        moved.rotation,
    );
    scene.samples[5].camera_from_target = Transform::from_isometry(&moved).unwrap();
    let found = calibrate_eye_to_hand(&scene.samples, &Options::default(), &mut rng()).unwrap();
    let rejected = found.quality.samples[5].rejected.as_ref().unwrap();
    assert_eq!(rejected.cause, RejectionCause::BeyondNoise);
}

#[test]
fn the_same_samples_and_seed_give_the_same_bits() {
    let scene = scene(15, false, (3.5e-3, 1e-3), 1.0, 4);
    let a = calibrate_eye_to_hand(&scene.samples, &Options::default(), &mut rng()).unwrap();
    let b = calibrate_eye_to_hand(&scene.samples, &Options::default(), &mut rng()).unwrap();
    assert_eq!(a, b);
}
