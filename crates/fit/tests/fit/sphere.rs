//! Spheres from three points and a radius, from two normals, and refits with a prior.

use crate::shapes::{cap, columns, unit, vector};
use nalgebra::{Point3, Vector3};
use pomona_fit::{
    Points, RadiusPrior, SphereEstimator, SphereRefit, ThreePointsAndRadius, TwoNormals,
    sphere_geometric, sphere_through_normals, sphere_weighted, spheres_of_radius,
};
use pomona_geometry::Sphere;
use pomona_ransac::{Candidates, Estimator, FixedCount, LeastSquares, Msac, Ransac};
use proptest::prelude::*;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

fn close(a: &Sphere, b: &Sphere, tolerance: f64) -> bool {
    (a.center - b.center).norm() < tolerance && (a.radius - b.radius).abs() < tolerance
}

proptest! {
    #[test]
    fn one_of_the_two_spheres_of_a_radius_is_the_one_sampled(
        center in vector(1.0), r in 0.01..0.2f64, seed in any::<u64>(),
    ) {
        let truth = Sphere::new(center.into(), r).unwrap();
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let normals = [0; 3].map(|_| unit(&mut rng));
        // On a great circle the height of the centre is the root of a rounding error.
        prop_assume!((normals[1] - normals[0]).cross(&(normals[2] - normals[0])).normalize().dot(&normals[0]).abs() > 0.05);
        prop_assume!((normals[1] - normals[0]).cross(&(normals[2] - normals[0])).norm() > 0.1);
        let points = normals.map(|n| truth.center + n * r);
        let both = spheres_of_radius(points, r).unwrap();
        prop_assert!(both.iter().any(|s| close(s, &truth, 1e-11)), "{both:?}");
        for sphere in &both {
            for p in &points {
                prop_assert!(sphere.signed_distance(p).abs() < 1e-12);
            }
        }
        prop_assume!(normals[0].cross(&normals[1]).norm() > 0.1);
        let by_normals = sphere_through_normals([points[0], points[1]], [normals[0], normals[1] * -2.0]).unwrap();
        prop_assert!(close(&by_normals, &truth, 1e-12), "{by_normals:?}");
    }

    #[test]
    fn the_camera_sees_the_near_side(seed in any::<u64>()) {
        let truth = Sphere::new(Point3::new(0.1, -0.05, 0.8), 0.04).unwrap();
        let [x, y, z] = columns(&cap(&truth, 3, 1.0, 0.0, seed));
        let points = Points::new(&x, &y, &z).unwrap();
        let by_three = ThreePointsAndRadius::new(RadiusPrior::new(0.04, 0.002).unwrap());
        let estimator = SphereEstimator::new(points, SphereRefit::Geometric);
        let mut candidates = Candidates::new(2);
        estimator.sampling(by_three).fit(&[0, 1, 2], &mut candidates);
        prop_assert_eq!(candidates.len(), 2);
        let mut seen = Candidates::new(2);
        estimator.sampling(by_three.seen_from(Point3::origin())).fit(&[0, 1, 2], &mut seen);
        prop_assert_eq!(seen.len(), 1);
        prop_assert!(candidates.as_ref().contains(&seen.as_ref()[0]));
        let other = candidates.as_ref().iter().find(|s| **s != seen.as_ref()[0]).unwrap();
        prop_assert!(other.center.coords.norm() <= seen.as_ref()[0].center.coords.norm());
    }

    #[test]
    fn a_prior_only_adds_what_it_knows(seed in any::<u64>(), mean in 0.03..0.05f64) {
        let truth = Sphere::new(Point3::new(0.1, -0.05, 0.8), 0.04).unwrap();
        let points = cap(&truth, 100, 0.8, 0.001, seed);
        let weighted = |sigma: f64| points.iter().map(move |&p| (p, sigma.powi(-2)));
        let free = sphere_geometric(points.iter().copied(), &truth).unwrap();
        let fit = |sigma| {
            let prior = RadiusPrior::new(mean, sigma).unwrap();
            sphere_weighted(weighted(0.001), &truth, Some(prior)).unwrap()
        };
        // A vague prior changes nothing, a sharp one dictates, one between lies between.
        prop_assert!(close(&fit(1e3), &free, 1e-8));
        prop_assert!((fit(1e-9).radius - mean).abs() < 1e-9);
        let between = fit(0.001).radius;
        prop_assert!((between - mean) * (between - free.radius) <= 1e-15, "{mean} {between} {}", free.radius);
    }

    #[test]
    fn weights_count_like_repeated_points(seed in any::<u64>(), off in vector(0.01)) {
        let truth = Sphere::new(Point3::new(0.0, 0.0, 0.8), 0.04).unwrap();
        let points = cap(&truth, 40, 1.0, 0.002, seed);
        let start = Sphere::new(truth.center + off, 0.05).unwrap();
        let twice: Vec<_> = points.iter().chain(&points[..20]).copied().collect();
        let a = sphere_geometric(twice.iter().copied(), &start).unwrap();
        let weight = |i| if i < 20 { 2.0 } else { 1.0 };
        let b = sphere_weighted(points.iter().enumerate().map(|(i, &p)| (p, weight(i))), &start, None).unwrap();
        prop_assert!(close(&a, &b, 1e-8));
    }
}

#[test]
fn a_search_by_normals_and_one_by_three_points_find_the_same_sphere() {
    let truth = Sphere::new(Point3::new(0.1, -0.05, 0.8), 0.04).unwrap();
    let mut points = cap(&truth, 400, 1.2, 0.0005, 3);
    let normals = points
        .iter()
        .map(|p| Point3::from((p - truth.center).normalize()));
    let mut normals: Vec<Point3<f64>> = normals.collect();
    let mut rng = ChaCha8Rng::seed_from_u64(4);
    for _ in 0..600 {
        points.push(truth.center + Vector3::from_fn(|_, _| rng.random_range(-0.08..0.08)));
        normals.push(unit(&mut rng).into());
    }
    let [x, y, z] = columns(&points);
    let [nx, ny, nz] = columns(&normals);
    let points = Points::new(&x, &y, &z).unwrap();
    let prior = RadiusPrior::new(0.038, 0.003).unwrap();
    let estimator = SphereEstimator::new(points, SphereRefit::Algebraic)
        .prior(prior, 0.0005)
        .unwrap();
    let search = Ransac::new(Msac::within(0.002))
        .local_optimization(LeastSquares::default())
        .stopping(FixedCount::new(300));
    let by_normals = estimator.sampling(TwoNormals::new(Points::new(&nx, &ny, &nz).unwrap()));
    let a = search
        .run(&by_normals, &mut ChaCha8Rng::seed_from_u64(1))
        .unwrap();
    let by_three = estimator.sampling(ThreePointsAndRadius::new(prior));
    let b = search
        .run(&by_three, &mut ChaCha8Rng::seed_from_u64(1))
        .unwrap();
    assert!(close(&a.model, &truth, 1e-3), "{:?}", a.model);
    assert!(close(&a.model, &b.model, 5e-4), "{:?}", b.model);
    assert!(estimator.prior(prior, 0.0).is_err());
}
