//! Several spheres in one cloud, and several branches in a shell.

use crate::shapes::{cap, close_lines, columns, gauss, side, unit};
use nalgebra::{Point3, Vector3};
use pomona_fit::{
    CylinderEstimator, DistanceWindow, LineEstimator, Points, RadiusPrior, RadiusWindow,
    SphereEstimator, SphereRefit, ThreePointsAndRadius,
};
use pomona_geometry::{Cylinder, Line, Sphere};
use pomona_ransac::{
    Competition, FixedCount, LeastSquares, Msac, Ransac, RansacError, Report, Sequential,
};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// The points of the given numbers as three arrays.
fn copied(points: &[Point3<f64>], numbers: &[usize]) -> [Vec<f64>; 3] {
    columns(&numbers.iter().map(|&i| points[i]).collect::<Vec<_>>())
}

#[test]
fn three_apples_that_touch() {
    let truth = [[0.0, 0.0, 0.8], [0.085, 0.0, 0.82], [0.04, 0.08, 0.79]]
        .map(|c| Sphere::new(Point3::from(c), 0.04).unwrap());
    let mut points = Vec::new();
    for (i, sphere) in (0..).zip(&truth) {
        points.extend(cap(sphere, 400 - 80 * i as usize, 1.3, 0.001, i));
    }
    let mut rng = ChaCha8Rng::seed_from_u64(7);
    points.extend((0..500).map(|_| {
        let off = Vector3::from_fn(|_, _| rng.random_range(-0.12..0.12));
        truth[0].center + Vector3::new(0.04, 0.04, 0.0) + off
    }));
    let prior = RadiusPrior::new(0.038, 0.003).unwrap();
    let sample = ThreePointsAndRadius::new(prior).seen_from(Point3::origin());
    let search = Ransac::new(Msac::within(0.003))
        .constraint(RadiusWindow::new(0.03, 0.05).unwrap())
        .local_optimization(LeastSquares::default())
        .stopping(FixedCount::new(800));
    let found = Sequential::default()
        .min_inliers(120)
        .run(points.len(), |left| {
            let [x, y, z] = copied(&points, left);
            let view = Points::new(&x, &y, &z).expect("one length");
            let estimator = SphereEstimator::new(view, SphereRefit::Geometric)
                .prior(prior, 0.001)
                .expect("a noise")
                .sampling(sample);
            search.run(&estimator, &mut rng)
        });
    assert_eq!(found.structures.len(), 3, "{:?}", found.ended);

    // Together they share out the points where the apples touch, and each comes nearer to its own.
    let [x, y, z] = columns(&points);
    let estimator = SphereEstimator::new(Points::new(&x, &y, &z).unwrap(), SphereRefit::Geometric)
        .prior(prior, 0.001)
        .unwrap()
        .sampling(sample);
    let models = found.structures.iter().map(|report| report.model);
    let chosen = Competition::with_penalty(60.0).run(&search, &estimator, models);
    assert_eq!(chosen.instances.len(), 3);
    for sphere in &truth {
        let off = |s: &Sphere| (s.center - sphere.center).norm();
        let alone = found.structures.iter().map(|r| off(&r.model));
        let together = chosen.instances.iter().map(|i| off(&i.model));
        assert!(alone.fold(f64::INFINITY, f64::min) < 0.002);
        assert!(together.fold(f64::INFINITY, f64::min) < 0.001);
    }
}

#[test]
fn two_branches_that_cross_in_a_shell() {
    let center = Point3::new(0.0, 0.0, 0.8);
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    let branches = [
        ([0.0, 0.06, 0.8], [1.0, 0.2, 0.1]),
        ([0.01, 0.065, 0.81], [-0.2, 0.3, 1.0]),
    ]
    .map(|(p, d)| Line::new(Point3::from(p), Vector3::from(d)).unwrap());
    let mut points = Vec::new();
    let mut normals = Vec::new();
    for (i, axis) in (0..).zip(&branches) {
        let branch = Cylinder::new(*axis, 0.006).unwrap();
        let (p, n) = side(&branch, 500 - 150 * i as usize, (1.3, 0.16, 0.0005), i);
        points.extend(p);
        normals.extend(n.iter().map(|n| {
            let tilted = n + Vector3::from_fn(|_, _| 0.05 * gauss(&mut rng));
            Point3::from(tilted.normalize())
        }));
    }
    for _ in 0..500 {
        points.push(center + unit(&mut rng) * rng.random_range(0.05..0.12));
        normals.push(unit(&mut rng).into());
    }
    let near_apple = DistanceWindow::new(center, 0.02, 0.1).unwrap();

    // As lines, the way the paper does it: between the surface and the axis.
    let lines = Ransac::new(Msac::within(0.006))
        .constraint(near_apple)
        .local_optimization(LeastSquares::default())
        .stopping(FixedCount::new(1500));
    let mut search_lines = |left: &[usize]| -> Result<Report<Line>, RansacError> {
        let [x, y, z] = copied(&points, left);
        let view = Points::new(&x, &y, &z).expect("one length");
        lines.run(&LineEstimator::new(view), &mut rng)
    };
    let found = Sequential::default()
        .max_structures(2)
        .run(points.len(), &mut search_lines);
    for branch in &branches {
        let near = |r: &Report<Line>| close_lines(&r.model, branch, 0.1, 0.009);
        assert!(found.structures.iter().any(near), "{:?}", found.structures);
    }

    // As cylinders, which know the axis.
    let cylinders = Ransac::new(Msac::within(0.0015))
        .constraint(near_apple)
        .constraint(RadiusWindow::new(0.002, 0.015).unwrap())
        .local_optimization(LeastSquares::default())
        .stopping(FixedCount::new(1500));
    let found = Sequential::default()
        .min_inliers(150)
        .run(points.len(), |left| {
            let [x, y, z] = copied(&points, left);
            let [nx, ny, nz] = copied(&normals, left);
            let normals = Points::new(&nx, &ny, &nz).expect("one length");
            let estimator =
                CylinderEstimator::new(Points::new(&x, &y, &z).expect("one length"), normals);
            cylinders.run(&estimator, &mut rng)
        });
    assert_eq!(found.structures.len(), 2, "{:?}", found.ended);
    for branch in &branches {
        let near = |r: &Report<Cylinder>| close_lines(&r.model.axis, branch, 0.02, 0.001);
        assert!(found.structures.iter().any(near), "{:?}", found.structures);
    }
}
