//! The fast scoring paths agree with each other and with the plain residuals.

use nalgebra::{Point3, Vector3};
use pomona_fit::{
    CylinderEstimator, LineEstimator, PlaneEstimator, Points, SphereEstimator, SphereRefit,
};
use pomona_geometry::{Cylinder, Line, Plane, Sphere};
use pomona_ransac::{BLOCK, Estimator};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Coordinates about the threshold surface of a shape, where a rounding error would show.
fn near(seed: u64, n: usize, surface: impl Fn(Vector3<f64>, f64) -> Point3<f64>) -> [Vec<f64>; 3] {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut out = [vec![], vec![], vec![]];
    for _ in 0..n {
        let u = Vector3::from_fn(|_, _| rng.random_range(-1.0..1.0_f64));
        let p = surface(u, rng.random_range(-1e-3..1e-3));
        for k in 0..3 {
            out[k].push(p[k]);
        }
    }
    out
}

fn check<E: Estimator>(estimator: &E, model: &E::Model, threshold: f64, slack: f64) {
    let (mut counted, mut selected) = (0, Vec::new());
    let n = estimator.len();
    for start in (0..n).step_by(BLOCK) {
        let block = start..(start + BLOCK).min(n);
        counted += estimator.count_within(model, block.clone(), threshold);
        estimator.select_within(model, block.clone(), threshold, &mut selected);
        let mut residuals = vec![0.0; block.len()];
        estimator.residuals(model, block.clone(), &mut residuals);
        let gain = estimator.truncated_gain(model, block.clone(), threshold);
        let within = residuals.iter().filter(|r| **r <= threshold);
        let exact: f64 = within.map(|r| 1.0 - (r / threshold).powi(2)).sum();
        // A gain changes by twice the residual's error, in thresholds.
        let tolerance = block.len() as f64 * (4.0 * slack / threshold + 1e-6);
        assert!((gain - exact).abs() < tolerance, "{gain} and {exact}");
        for (i, r) in block.zip(residuals) {
            // Nearer to the threshold than the arithmetic's rounding either answer is right.
            if (r - threshold).abs() > slack {
                assert_eq!(
                    selected.binary_search(&i).is_ok(),
                    r <= threshold,
                    "datum {i}, residual {r}"
                );
            }
        }
    }
    assert_eq!(counted, selected.len());
    assert!(
        counted > n / 10 && counted < n - n / 10,
        "{counted} of {n}: the test misses the threshold"
    );
}

#[test]
fn sphere_paths_agree_near_the_threshold() {
    let sphere = Sphere::new(Point3::new(0.13, -0.08, 0.8), 0.04).unwrap();
    let xyz = near(1, 200_000, |u, off| {
        sphere.center + u.normalize() * (sphere.radius + 0.008 + off)
    });
    let [x, y, z] = &xyz;
    check(
        &SphereEstimator::new(Points::new(x, y, z).unwrap(), SphereRefit::Algebraic),
        &sphere,
        0.008,
        1e-15,
    );
    let narrow = xyz.map(|v| v.into_iter().map(|c| c as f32).collect::<Vec<_>>());
    let [x, y, z] = &narrow;
    check(
        &SphereEstimator::new(Points::new(x, y, z).unwrap(), SphereRefit::Algebraic),
        &sphere,
        0.008,
        2e-7,
    );
}

#[test]
fn line_paths_agree_near_the_threshold() {
    let line = Line::new(Point3::new(0.13, -0.08, 0.8), Vector3::new(1.0, -2.0, 0.7)).unwrap();
    let xyz = near(2, 200_000, |u, off| {
        line.at(u.z * 0.1) + line.direction.cross(&u).normalize() * (0.005 + off)
    });
    let [x, y, z] = &xyz;
    check(
        &LineEstimator::new(Points::new(x, y, z).unwrap()),
        &line,
        0.005,
        1e-15,
    );
    let narrow = xyz.map(|v| v.into_iter().map(|c| c as f32).collect::<Vec<_>>());
    let [x, y, z] = &narrow;
    check(
        &LineEstimator::new(Points::new(x, y, z).unwrap()),
        &line,
        0.005,
        2e-7,
    );
}

#[test]
fn plane_and_cylinder_paths_agree_near_the_threshold() {
    let axis = Line::new(Point3::new(0.13, -0.08, 0.8), Vector3::new(1.0, -2.0, 0.7)).unwrap();
    let cylinder = Cylinder::new(axis, 0.01).unwrap();
    let about = near(3, 200_000, |u, off| {
        axis.at(u.z * 0.1) + axis.direction.cross(&u).normalize() * (0.014 + off)
    });
    let plane = Plane::new(axis.point, Vector3::new(0.2, 0.3, -1.0)).unwrap();
    let over = near(4, 200_000, |u, off| {
        let foot = plane.project(&(axis.point + u * 0.1));
        foot + plane.normal.into_inner() * (0.004 + off).copysign(u.x)
    });
    let [x, y, z] = &about;
    let points = Points::new(x, y, z).unwrap();
    check(
        &CylinderEstimator::new(points, points),
        &cylinder,
        0.004,
        1e-15,
    );
    let [x, y, z] = &over;
    let points = Points::new(x, y, z).unwrap();
    check(&PlaneEstimator::new(points), &plane, 0.004, 1e-15);
    let [x, y, z] = &about.map(|v| v.into_iter().map(|c| c as f32).collect::<Vec<_>>());
    let points = Points::new(x, y, z).unwrap();
    check(
        &CylinderEstimator::new(points, points),
        &cylinder,
        0.004,
        2e-7,
    );
    let [x, y, z] = &over.map(|v| v.into_iter().map(|c| c as f32).collect::<Vec<_>>());
    let points = Points::new(x, y, z).unwrap();
    check(&PlaneEstimator::new(points), &plane, 0.004, 2e-7);
}

#[test]
fn a_senseless_threshold_holds_nothing() {
    let (x, y, z) = ([0.0_f32, 1.0], [0.0, 0.0], [1.0, 1.0]);
    let points = Points::new(&x, &y, &z).unwrap();
    let sphere = Sphere::new(Point3::new(0.0, 0.0, 1.0), 1.0).unwrap();
    let line = Line::new(Point3::origin(), Vector3::z()).unwrap();
    for threshold in [-1.0, f64::NAN] {
        assert_eq!(
            SphereEstimator::new(points, SphereRefit::Algebraic).count_within(
                &sphere,
                0..2,
                threshold
            ),
            0
        );
        assert_eq!(
            LineEstimator::new(points).count_within(&line, 0..2, threshold),
            0
        );
    }
    let nan = [f32::NAN; 2];
    let nowhere = Points::new(&nan, &nan, &nan).unwrap();
    assert_eq!(
        LineEstimator::new(nowhere).count_within(&line, 0..2, f64::INFINITY),
        0
    );
}
