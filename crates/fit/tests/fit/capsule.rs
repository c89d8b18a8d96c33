//! Capsules: a rod with two ends among points on its axis's continuation.

use crate::shapes::{columns, side, unit};
use nalgebra::{Point3, Vector3};
use pomona_fit::{CapsuleEstimator, Points, RadiusPrior};
use pomona_geometry::{Cylinder, Line};
use pomona_ransac::{Candidates, Estimator, FixedCount, LeastSquares, Msac, Ransac};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

#[test]
fn a_rod_is_found_with_its_ends() {
    for seed in 0..5 {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let axis = Line::new(Point3::new(0.1, 0.1, 0.8), unit(&mut rng)).unwrap();
        let truth = Cylinder::new(axis, 0.008).unwrap();
        let (mut points, mut normals) = side(&truth, 600, (1.3, 0.1, 0.0003), seed);
        // Another piece of the same cylinder, 10 cm farther on, and clutter.
        let far = Line::new(axis.at(0.2), axis.direction.into_inner()).unwrap();
        let far = Cylinder::new(far, 0.008).unwrap();
        let (p, n) = side(&far, 200, (1.3, 0.05, 0.0003), seed + 100);
        points.extend(p);
        normals.extend(n);
        for _ in 0..500 {
            points.push(axis.point + Vector3::from_fn(|_, _| rng.random_range(-0.1..0.1)));
            normals.push(unit(&mut rng));
        }
        let [x, y, z] = columns(&points);
        let normals: Vec<Point3<f64>> = normals.into_iter().map(Point3::from).collect();
        let [nx, ny, nz] = columns(&normals);
        let estimator = CapsuleEstimator::new(
            Points::new(&x, &y, &z).unwrap(),
            Points::new(&nx, &ny, &nz).unwrap(),
            0.001,
            0.004,
        )
        .prior(RadiusPrior::new(0.008, 0.002).unwrap(), 0.0003)
        .unwrap();
        let report = Ransac::new(Msac::within(0.001))
            .local_optimization(LeastSquares::default())
            .stopping(FixedCount::new(500))
            .run(&estimator, &mut rng)
            .unwrap();
        let capsule = report.model;
        assert!((capsule.radius - 0.008).abs() < 2e-4, "{capsule:?}");
        let (a, b) = (
            axis.parameter(&capsule.segment.start),
            axis.parameter(&capsule.segment.end),
        );
        assert!(axis.distance(&capsule.segment.start) < 5e-4, "{capsule:?}");
        assert!((a.min(b) + 0.05).abs() < 0.006, "from {a} to {b}");
        assert!((a.max(b) - 0.05).abs() < 0.006, "from {a} to {b}");
    }
}

#[test]
fn senseless_settings_make_no_model() {
    let (x, y, z) = ([0.0, 1.0], [0.0, 0.0], [1.0, 1.0]);
    let points = Points::new(&x, &y, &z).unwrap();
    let normals = Points::new(&y, &z, &x).unwrap();
    for (distance, gap) in [
        (-1.0, 1.0),
        (f64::NAN, 1.0),
        (1.0, 0.0),
        (1.0, f64::NAN),
        (1.0, f64::INFINITY),
    ] {
        let mut candidates = Candidates::new(1);
        CapsuleEstimator::new(points, normals, distance, gap).fit(&[0, 1], &mut candidates);
        assert!(candidates.is_empty());
    }
}
