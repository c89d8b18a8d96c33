//! Calibration from point pairs.

use nalgebra::{Point3, UnitQuaternion, Vector3, Vector6};
use pomona_calibrate::{
    CalibrateError, Options, PointCalibration, PointSample, RejectionCause, calibrate_points,
};
use pomona_transforms::{CameraFrame, Position, RobotFrame, Transform, twist};
use proptest::prelude::*;
use rand::RngExt;
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};

type RobotFromCamera = Transform<RobotFrame, CameraFrame>;

fn normal(rng: &mut ChaCha8Rng, sigma: f64) -> Vector3<f64> {
    Vector3::from_fn(|_, _| {
        let (u, v): (f64, f64) = (rng.random(), rng.random());
        sigma * (-2.0 * (1.0 - u).ln()).sqrt() * (std::f64::consts::TAU * v).cos()
    })
}

fn truth() -> RobotFromCamera {
    let q = UnitQuaternion::from_euler_angles(-1.4, 0.2, 1.7).coords;
    RobotFromCamera::from_quaternion([1.2, -0.3, 0.6], q.into()).unwrap()
}

fn samples(n: usize, sigma: f64, seed: u64) -> Vec<PointSample> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    (0..n)
        .map(|i| {
            let span = |rng: &mut ChaCha8Rng| rng.random_range(-0.3..0.3);
            let (x, y, z) = (span(&mut rng), span(&mut rng), span(&mut rng));
            let camera = Point3::new(x, y, 0.9 + z);
            let robot = truth().position(&Position::new(camera)).point() + normal(&mut rng, sigma);
            PointSample::new(format!("p{i}"), Position::new(camera), Position::new(robot))
        })
        .collect()
}

fn calibrate(samples: &[PointSample]) -> Result<PointCalibration, CalibrateError> {
    calibrate_points(
        samples,
        &Options::default(),
        &mut ChaCha8Rng::seed_from_u64(1),
    )
}

fn scaled(samples: &mut [PointSample], camera: f64, robot: f64) {
    for s in samples {
        s.camera = Position::new(s.camera.point() * camera);
        s.robot = Position::new(s.robot.point() * robot);
    }
}

proptest! {
    #[test]
    fn exact_pairs_give_the_exact_answer_among_wrong_ones(seed in any::<u64>(), n in 8..20usize) {
        let mut samples = samples(n, 0.0, seed);
        for (k, sample) in samples.iter_mut().take(n / 4).enumerate() {
            let wrong = Vector3::new(0.1, 0.2, -0.1 * (k as f64 + 1.0));
            sample.robot = Position::new(sample.robot.point() + wrong);
        }
        let found = calibrate(&samples).unwrap();
        prop_assert!((found.camera.transform.matrix() - truth().matrix()).amax() < 1e-9);
        prop_assert!((found.scale - 1.0).abs() < 1e-9);
        for (i, sample) in found.quality.samples.iter().enumerate() {
            prop_assert_eq!(sample.rejected.is_some(), i < n / 4);
            prop_assert_eq!(sample.left_out.is_some(), i >= n / 4);
        }
        prop_assert_eq!(found.quality.samples[0].rejected.as_ref().unwrap().cause, RejectionCause::PlaceFarOff);
    }

    #[test]
    fn nothing_panics(
        points in prop::collection::vec(prop::array::uniform6(prop_oneof![Just(0.0), Just(1.0), Just(1e300), -1.0..1.0f64]), 0..9),
    ) {
        let samples: Vec<PointSample> = points.iter().enumerate().map(|(i, p)| PointSample::new(
            i.to_string(),
            Position::new(Point3::new(p[0], p[1], p[2])),
            Position::new(Point3::new(p[3], p[4], p[5])),
        )).collect();
        let mut options = Options::default();
        options.hypotheses = 20;
        let _ = calibrate_points(&samples, &options, &mut ChaCha8Rng::seed_from_u64(0));
    }
}

#[test]
fn the_covariance_is_that_of_the_errors() {
    let (trials, mut sum, mut variance, mut stated) = (300, 0.0, 0.0, 0.0);
    for seed in 0..trials {
        let found = calibrate(&samples(12, 1e-3, seed)).unwrap();
        let error = truth().isometry() * found.camera.transform.isometry().inverse();
        let xi: Vector6<f64> = twist::log(&error);
        sum += xi.dot(&found.camera.covariance.cholesky().unwrap().solve(&xi));
        variance += xi.fixed_rows::<3>(0).norm_squared();
        stated += found.camera.rotation_covariance_rad2().trace();
    }
    // χ² with 6 degrees of freedom, and wider for a variance that is estimated from 12 points: F says 6·30/28.
    let mean = sum / trials as f64;
    assert!((5.5..7.5).contains(&mean), "{mean}");
    assert!(
        (0.8..1.25).contains(&(stated / variance)),
        "{}",
        stated / variance
    );
}

#[test]
fn leaving_one_out_foretells_the_error_at_the_fruit() {
    let (mut foretold, mut true_error) = (0.0, 0.0);
    let fruit = Position::new(Point3::new(0.0, 0.0, 0.8));
    for seed in 0..200 {
        let found = calibrate(&samples(12, 1e-3, seed)).unwrap();
        foretold += found.quality.leave_one_out.sigma_at_fruit_m.powi(2);
        let camera = found.camera.transform;
        true_error += camera
            .position(&fruit)
            .distance(&truth().position(&fruit))
            .powi(2);
    }
    let ratio = (foretold / true_error).sqrt();
    assert!((0.8..1.6).contains(&ratio), "{ratio}");
}

#[test]
fn millimetres_are_named() {
    for (camera, robot, word) in [(1e3, 1.0, "camera's"), (1.0, 1e3, "robot's")] {
        let mut samples = samples(10, 1e-4, 3);
        scaled(&mut samples, camera, robot);
        samples[2].robot = samples[5].robot;
        let error = calibrate(&samples).unwrap_err();
        let CalibrateError::Scale { scale, cause } = &error else {
            panic!("{error}");
        };
        assert!((scale * camera / robot - 1.0).abs() < 0.05, "{scale}");
        assert!(
            cause.contains(word) && cause.contains("millimetres"),
            "{cause}"
        );
    }
    let mut both = samples(10, 0.0, 3);
    scaled(&mut both, 1e3, 1e3);
    let error = calibrate(&both).unwrap_err();
    assert!(matches!(error, CalibrateError::TooFar { .. }), "{error}");
    assert!(error.to_string().contains("millimetres"));
}

#[test]
fn a_scale_of_a_few_per_cent_is_refused_and_a_small_one_told() {
    let mut wide = samples(12, 2e-4, 4);
    scaled(&mut wide, 1.05, 1.0);
    let error = calibrate(&wide).unwrap_err();
    assert!(matches!(error, CalibrateError::Scale { .. }), "{error}");
    let mut narrow = samples(12, 2e-4, 4);
    scaled(&mut narrow, 1.005, 1.0);
    let found = calibrate(&narrow).unwrap();
    assert!((found.scale * 1.005 - 1.0).abs() < 1e-3);
    assert!(
        found
            .quality
            .warnings
            .iter()
            .any(|w| w.message.contains("depth scale"))
    );
}

#[test]
fn a_left_handed_frame_is_named() {
    let mut samples = samples(10, 1e-3, 5);
    for s in &mut samples {
        let p = s.robot.point();
        s.robot = Position::new(Point3::new(p.x, -p.y, p.z));
    }
    assert_eq!(calibrate(&samples).unwrap_err(), CalibrateError::Mirrored);
}

#[test]
fn points_on_a_line_are_refused_also_with_one_wrong_one_beside() {
    let mut samples = samples(10, 0.0, 6);
    for (i, s) in samples.iter_mut().enumerate() {
        let camera = Position::new(Point3::new(0.05 * i as f64, 0.001 * (i % 2) as f64, 0.8));
        s.camera = camera;
        s.robot = truth().position(&camera);
    }
    let error = calibrate(&samples).unwrap_err();
    assert!(matches!(error, CalibrateError::Collinear { .. }), "{error}");
    samples[0].robot = Position::new(Point3::new(3.0, 3.0, 3.0));
    samples[0].camera = Position::new(Point3::new(-1.0, 0.3, 0.8));
    let error = calibrate(&samples).unwrap_err();
    assert!(matches!(error, CalibrateError::Collinear { .. }), "{error}");
}

#[test]
fn other_refusals() {
    let good = samples(10, 0.0, 7);
    let error = calibrate(&good[..3]).unwrap_err();
    assert_eq!(
        error,
        CalibrateError::TooFew {
            found: 3,
            needed: 4
        }
    );
    let mut twice = good.clone();
    twice[1].id = twice[0].id.clone();
    assert!(matches!(
        calibrate(&twice),
        Err(CalibrateError::SameId { .. })
    ));
    let mut nan = good.clone();
    nan[1].robot = Position::new(Point3::new(f64::NAN, 0.0, 0.0));
    assert!(matches!(
        calibrate(&nan),
        Err(CalibrateError::NotFinite { .. })
    ));
    let mut shuffled = good.clone();
    let n = good.len();
    for i in 0..n {
        shuffled[i].robot = good[(i * 7 + 3) % n].robot;
    }
    let error = calibrate(&shuffled).unwrap_err();
    assert!(
        matches!(error, CalibrateError::NoConsensus { .. }),
        "{error}"
    );
    let mut options = Options::default();
    options.translation_tolerance_m = f64::NAN;
    let error = calibrate_points(&good, &options, &mut ChaCha8Rng::seed_from_u64(0)).unwrap_err();
    assert!(matches!(error, CalibrateError::Setting { .. }), "{error}");
}
