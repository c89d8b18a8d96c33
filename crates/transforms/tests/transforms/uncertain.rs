//! Covariances against Monte Carlo: perturb, compute, and compare the spread with the prediction.

use nalgebra::{Isometry3, Matrix3, Matrix6, Point3, SMatrix, UnitQuaternion, Vector3, Vector6};
use pomona_transforms::{
    CameraFrame, CovarianceError, Direction, FlangeFrame, NamedTransform, Position, RobotFrame,
    ToolOrientation, Transform, UNKNOWN_ANGLE_SIGMA_RAD, UncertainDirection, UncertainPosition,
    UncertainTransform, twist,
};
use rand::RngExt;
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};

const DRAWS: usize = 40_000;

fn normal(rng: &mut ChaCha8Rng) -> f64 {
    let (u, v): (f64, f64) = (rng.random(), rng.random());
    (-2.0 * (1.0 - u).ln()).sqrt() * (std::f64::consts::TAU * v).cos()
}

/// A covariance with correlations: about 0.5° and 4 mm.
fn covariance(rng: &mut ChaCha8Rng) -> Matrix6<f64> {
    let size = Vector6::new(8e-3, 6e-3, 9e-3, 4e-3, 5e-3, 3e-3);
    let mix = Matrix6::from_fn(|i, j| {
        let off = rng.random_range(-0.4..0.4);
        size[i] * if i == j { 1.0 } else { off }
    });
    mix * mix.transpose()
}

fn draw<const N: usize>(root: &SMatrix<f64, N, N>, rng: &mut ChaCha8Rng) -> SMatrix<f64, N, 1> {
    root * SMatrix::<f64, N, 1>::from_fn(|_, _| normal(rng))
}

fn uncertain<To: pomona_transforms::FrameTag, From: pomona_transforms::FrameTag>(
    rng: &mut ChaCha8Rng,
) -> UncertainTransform<To, From> {
    let t = twist::exp(&Vector6::from_fn(|_, _| rng.random_range(-1.0..1.0)));
    UncertainTransform::new(Transform::from_isometry(&t).unwrap(), covariance(rng)).unwrap()
}

/// Draws of a true transform: Exp(ξ) T̂.
fn root<To: pomona_transforms::FrameTag, From: pomona_transforms::FrameTag>(
    t: &UncertainTransform<To, From>,
) -> Matrix6<f64> {
    t.covariance.cholesky().unwrap().l()
}

fn close<const N: usize>(found: &SMatrix<f64, N, N>, predicted: &SMatrix<f64, N, N>) {
    for i in 0..N {
        for j in 0..N {
            let scale = (predicted[(i, i)] * predicted[(j, j)]).sqrt();
            let off = (found[(i, j)] - predicted[(i, j)]).abs() / scale;
            assert!(off < 0.04, "({i}, {j}): {off}\n{found}\n{predicted}");
        }
    }
}

fn spread<const N: usize>(draws: &[SMatrix<f64, N, 1>]) -> SMatrix<f64, N, N> {
    let sum: SMatrix<f64, N, N> = draws.iter().map(|d| d * d.transpose()).sum();
    sum / draws.len() as f64
}

#[test]
fn through_products_and_inverses() {
    let rng = &mut ChaCha8Rng::seed_from_u64(1);
    let a = uncertain::<RobotFrame, FlangeFrame>(rng);
    let b = uncertain::<FlangeFrame, CameraFrame>(rng);
    let (root_a, root_b) = (root(&a), root(&b));
    let (both, back) = (a * b, a.inverse());
    let mean = |t: &Isometry3<f64>| t.inverse();
    let (mean_both, mean_back) = (
        mean(&both.transform.isometry()),
        mean(&back.transform.isometry()),
    );
    let (mut of_both, mut of_back) = (Vec::new(), Vec::new());
    for _ in 0..DRAWS {
        let true_a = twist::exp(&draw(&root_a, rng)) * a.transform.isometry();
        let true_b = twist::exp(&draw(&root_b, rng)) * b.transform.isometry();
        of_both.push(twist::log(&(true_a * true_b * mean_both)));
        of_back.push(twist::log(&(true_a.inverse() * mean_back)));
    }
    close(&spread(&of_both), &both.covariance);
    close(&spread(&of_back), &back.covariance);
    let twice = back.inverse();
    assert!((twice.covariance - a.covariance).amax() < 1e-15);
}

#[test]
fn to_positions_directions_and_the_translation() {
    let rng = &mut ChaCha8Rng::seed_from_u64(2);
    let t = uncertain::<RobotFrame, CameraFrame>(rng);
    let p = Position::new(Point3::new(0.2, -0.1, 0.9));
    let own: Matrix3<f64> = Matrix3::new(9e-6, 2e-6, 0.0, 2e-6, 4e-6, 1e-6, 0.0, 1e-6, 2e-5);
    let d = Direction::new(Vector3::new(0.3, -0.8, 0.5)).unwrap();
    let across = Matrix3::identity() - d.vector() * d.vector().transpose();
    let tilt = across * 0.01_f64.powi(2);
    let position = t.position(&UncertainPosition {
        position: p,
        covariance_m2: own,
    });
    let direction = t.direction(&UncertainDirection {
        direction: d,
        covariance_rad2: tilt,
    });
    let (root_t, root_p) = (root(&t), own.cholesky().unwrap().l());
    let (mut of_p, mut of_d, mut of_t) = (Vec::new(), Vec::new(), Vec::new());
    for _ in 0..DRAWS {
        let truth = twist::exp(&draw(&root_t, rng)) * t.transform.isometry();
        of_p.push(truth * (p.point() + draw(&root_p, rng)) - position.position.point());
        let turn = Vector3::from_fn(|_, _| 0.01 * normal(rng));
        let tilted = UnitQuaternion::from_scaled_axis(turn) * d.vector();
        of_d.push(truth.rotation * tilted - direction.direction.vector());
        of_t.push(truth.translation.vector - t.transform.translation_m());
    }
    close(&spread(&of_p), &position.covariance_m2);
    close(&spread(&of_t), &t.translation_covariance_m2());
    // Across the direction only; along it the error is of second order.
    let found = across_of(&spread(&of_d), &direction.direction.vector());
    close(
        &found,
        &across_of(&direction.covariance_rad2, &direction.direction.vector()),
    );
    let u = direction.direction.vector();
    assert!((direction.covariance_rad2 * u).norm() < 1e-12);
}

fn across_of(c: &Matrix3<f64>, d: &Vector3<f64>) -> nalgebra::Matrix2<f64> {
    let a = d.cross(&Vector3::x()).normalize();
    let basis = nalgebra::Matrix3x2::from_columns(&[a, d.cross(&a)]);
    basis.transpose() * c * basis
}

#[test]
fn what_is_no_covariance_is_refused() {
    let t = Transform::<RobotFrame, RobotFrame>::identity();
    let good = covariance(&mut ChaCha8Rng::seed_from_u64(3));
    assert!(UncertainTransform::new(t, good).is_ok());
    assert!(UncertainTransform::new(t, Matrix6::zeros()).is_ok());
    let mut nan = good;
    nan[(0, 0)] = f64::NAN;
    assert_eq!(
        UncertainTransform::new(t, nan),
        Err(CovarianceError::NotFinite)
    );
    let mut skewed = good;
    skewed[(0, 1)] += 1e-5;
    let error = UncertainTransform::new(t, skewed).unwrap_err();
    assert!(
        matches!(error, CovarianceError::NotSymmetric { .. }),
        "{error}"
    );
    let error = UncertainTransform::new(t, -good).unwrap_err();
    assert!(
        matches!(error, CovarianceError::NegativeVariance { .. }),
        "{error}"
    );
    let mut impossible = Matrix6::identity();
    impossible[(0, 1)] = 1.5;
    impossible[(1, 0)] = 1.5;
    let error = UncertainTransform::new(t, impossible).unwrap_err();
    assert!(
        matches!(error, CovarianceError::NegativeVariance { .. }),
        "{error}"
    );
}

#[test]
fn a_file_keeps_the_covariance_to_the_last_bit() {
    let rng = &mut ChaCha8Rng::seed_from_u64(4);
    let t = uncertain::<RobotFrame, CameraFrame>(rng);
    let mut named = NamedTransform::new(t.transform, "base", "camera");
    named.covariance = Some(t.covariance);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("t.json");
    named.write(&path).unwrap();
    assert_eq!(NamedTransform::read(&path).unwrap(), named);
    assert_eq!(named.inverse().covariance, Some(t.inverse().covariance));
    let text = std::fs::read_to_string(&path).unwrap();
    for (old, new, word) in [
        ("\"left\"", "\"right\"", "right"),
        (
            "rotation_translation",
            "translation_rotation",
            "translation_rotation",
        ),
    ] {
        std::fs::write(&path, text.replace(old, new)).unwrap();
        let error = NamedTransform::<RobotFrame, CameraFrame>::read(&path).unwrap_err();
        assert!(error.to_string().contains(word), "{error}");
    }
    named.covariance = Some(-t.covariance);
    let error = named.write(&path).unwrap_err().to_string();
    assert!(error.contains("negative variance"), "{error}");
}

#[test]
fn near_the_pole_the_azimuth_is_unsure_and_the_reference_taken() {
    let along = |polar: f64, azimuth: f64| {
        let (sin, cos) = polar.sin_cos();
        Direction::<RobotFrame>::new(Vector3::new(sin * azimuth.cos(), sin * azimuth.sin(), cos))
            .unwrap()
    };
    let sigma = 2.0_f64.to_radians();
    let with = |direction: Direction<RobotFrame>| {
        let d = direction.vector();
        let covariance_rad2 = (Matrix3::identity() - d * d.transpose()) * sigma * sigma;
        UncertainDirection {
            direction,
            covariance_rad2,
        }
    };
    for polar in [0.5, 1.2, 2.0, 2.8] {
        let d = with(along(polar, 0.7));
        let tool = ToolOrientation::along_uncertain(&d, 2.0).unwrap();
        assert!((tool.rz_sigma_rad - sigma / f64::sin(polar)).abs() < 1e-12);
        assert!((tool.ry_sigma_rad - sigma).abs() < 1e-12);
        assert_eq!(tool.orientation, ToolOrientation::along(&d.direction));
    }
    // Monte Carlo of the angles, where first order holds.
    let d = with(along(0.8, -2.0));
    let tool = ToolOrientation::along_uncertain(&d, 0.0).unwrap();
    let rng = &mut ChaCha8Rng::seed_from_u64(5);
    let (mut rz, mut ry) = (0.0, 0.0);
    for _ in 0..DRAWS {
        let turn = UnitQuaternion::from_scaled_axis(Vector3::from_fn(|_, _| sigma * normal(rng)));
        let e = ToolOrientation::along(&Direction::new(turn * d.direction.vector()).unwrap()).euler;
        rz += (e.rz - tool.orientation.euler.rz).powi(2);
        ry += (e.ry - tool.orientation.euler.ry).powi(2);
    }
    assert!(((rz / DRAWS as f64).sqrt() / tool.rz_sigma_rad - 1.0).abs() < 0.02);
    assert!(((ry / DRAWS as f64).sqrt() / tool.ry_sigma_rad - 1.0).abs() < 0.02);
    // A degree from the pole two degrees of noise leave the azimuth to the reference.
    for polar in [0.0, 1e-7, 0.017, 3.13] {
        for reference in [0.0, -2.5] {
            let d = with(along(polar, 0.7));
            let tool = ToolOrientation::along_uncertain(&d, reference).unwrap();
            assert!(tool.orientation.singular && tool.rz_sigma_rad > 1.0);
            assert!(tool.rz_sigma_rad <= UNKNOWN_ANGLE_SIGMA_RAD);
            let off = tool.orientation.quaternion * Vector3::x() - d.direction.vector();
            assert!(off.norm() < 1.1e-6, "{off}");
            // The tool's y axis stays where the reference puts it, within the tilt.
            let y = Vector3::new(-f64::sin(reference), f64::cos(reference), 0.0);
            assert!((tool.orientation.quaternion * Vector3::y()).angle(&y) < 0.02);
        }
    }
    assert!(ToolOrientation::along_uncertain(&d, f64::NAN).is_none());
}
