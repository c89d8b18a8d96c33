//! Properties that every solver has: exact recovery, equivariance under rigid motions,
//! indifference to the order of the points, no refit worse than where it started.

use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3};
use pomona_fit::{
    line_least_squares, plane_least_squares, sphere_geometric, sphere_least_squares, sphere_through,
};
use pomona_geometry::{Line, Sphere, angle_between_axes};
use proptest::prelude::*;
use rand::{RngExt, SeedableRng, seq::SliceRandom};
use rand_chacha::ChaCha8Rng;

fn vector(limit: f64) -> impl Strategy<Value = Vector3<f64>> {
    prop::array::uniform3(-limit..limit).prop_map(Vector3::from)
}

fn motion() -> impl Strategy<Value = Isometry3<f64>> {
    (vector(2.0), vector(3.0)).prop_map(|(t, r)| {
        Isometry3::from_parts(Translation3::from(t), UnitQuaternion::from_scaled_axis(r))
    })
}

fn unit(rng: &mut ChaCha8Rng) -> Vector3<f64> {
    loop {
        let v = Vector3::from_fn(|_, _| rng.random_range(-1.0..1.0));
        let n = v.norm();
        if n > 0.1 && n < 1.0 {
            return v / n;
        }
    }
}

/// Points of a sphere's cap within 60° of a random direction, off the surface by up to `noise`.
fn cap(sphere: &Sphere, n: usize, noise: f64, seed: u64) -> Vec<Point3<f64>> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let pole = unit(&mut rng);
    let mut points = Vec::new();
    while points.len() < n {
        let u = unit(&mut rng);
        if u.dot(&pole) > 0.5 {
            let off = noise * rng.random_range(-1.0..=1.0);
            points.push(sphere.center + u * (sphere.radius + off));
        }
    }
    points
}

fn rod(line: &Line, n: usize, noise: f64, seed: u64) -> Vec<Point3<f64>> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    (0..n)
        .map(|_| {
            line.at(rng.random_range(-0.1..0.1))
                + unit(&mut rng) * noise * rng.random_range(0.0..=1.0)
        })
        .collect()
}

fn close(a: &Sphere, b: &Sphere, tolerance: f64) -> bool {
    (a.center - b.center).norm() < tolerance && (a.radius - b.radius).abs() < tolerance
}

fn squares(points: &[Point3<f64>], sphere: &Sphere) -> f64 {
    points
        .iter()
        .map(|p| sphere.signed_distance(p).powi(2))
        .sum()
}

proptest! {
    #[test]
    fn spheres_are_recovered_exactly(center in vector(1.5), r in 0.01..0.2f64, seed in any::<u64>()) {
        let truth = Sphere::new(center.into(), r).unwrap();
        let points = cap(&truth, 60, 0.0, seed);
        // Four points nearly in a plane amplify the rounding of their coordinates: 2e-16 of
        // 1.5 m by at most the inverse of the volume they span.
        let four = [points[0], points[1], points[2], points[3]];
        let [a, b, c] = [1, 2, 3].map(|i| (four[i] - four[0]) / r);
        prop_assume!(a.dot(&b.cross(&c)).abs() > 1e-3);
        prop_assert!(close(&sphere_through(four).unwrap(), &truth, 1e-10));
        let linear = sphere_least_squares(points.iter().copied()).unwrap();
        prop_assert!(close(&linear, &truth, 1e-12));
        let start = Sphere::new(truth.center + Vector3::new(0.3, -0.2, 0.1) * r, 1.4 * r).unwrap();
        let geometric = sphere_geometric(points.iter().copied(), &start).unwrap();
        prop_assert!(close(&geometric, &truth, 1e-9));
    }

    #[test]
    fn spheres_move_with_the_points(m in motion(), r in 0.01..0.2f64, seed in any::<u64>()) {
        let sphere = Sphere::new(Point3::new(0.1, 0.2, 0.8), r).unwrap();
        let points = cap(&sphere, 80, 0.03 * r, seed);
        let moved: Vec<_> = points.iter().map(|p| m * p).collect();
        let there = |s: &Sphere| Sphere::new(m * s.center, s.radius).unwrap();
        let a = sphere_least_squares(points.iter().copied()).unwrap();
        let b = sphere_least_squares(moved.iter().copied()).unwrap();
        prop_assert!(close(&there(&a), &b, 1e-11));
        let a = sphere_geometric(points.iter().copied(), &sphere).unwrap();
        let b = sphere_geometric(moved.iter().copied(), &there(&sphere)).unwrap();
        prop_assert!(close(&there(&a), &b, 1e-7));
    }

    #[test]
    fn the_order_of_points_does_not_matter(seed in any::<u64>()) {
        let sphere = Sphere::new(Point3::new(0.1, 0.2, 0.8), 0.04).unwrap();
        let points = cap(&sphere, 50, 0.002, seed);
        let mut shuffled = points.clone();
        shuffled.shuffle(&mut ChaCha8Rng::seed_from_u64(seed ^ 1));
        let a = sphere_least_squares(points.iter().copied()).unwrap();
        let b = sphere_least_squares(shuffled.iter().copied()).unwrap();
        prop_assert!(close(&a, &b, 1e-12));
        let a = sphere_geometric(points.iter().copied(), &sphere).unwrap();
        let b = sphere_geometric(shuffled.iter().copied(), &sphere).unwrap();
        prop_assert!(close(&a, &b, 1e-8));

        let line = Line::new(Point3::new(0.1, 0.2, 0.8), unit(&mut ChaCha8Rng::seed_from_u64(seed))).unwrap();
        let points = rod(&line, 50, 0.005, seed);
        let mut shuffled = points.clone();
        shuffled.shuffle(&mut ChaCha8Rng::seed_from_u64(seed ^ 1));
        let a = line_least_squares(points.into_iter()).unwrap();
        let b = line_least_squares(shuffled.into_iter()).unwrap();
        prop_assert!(angle_between_axes(&a.direction, &b.direction).unwrap() < 1e-9);
        prop_assert!((a.point - b.point).norm() < 1e-12);
    }

    #[test]
    fn geometric_refinement_is_never_worse(
        r in 0.01..0.1f64, noise in 0.0..0.5f64, seed in any::<u64>(), off in vector(0.05), scale in 0.2..3.0f64,
    ) {
        let truth = Sphere::new(Point3::new(0.0, 0.1, 0.9), r).unwrap();
        let points = cap(&truth, 40, noise * r, seed);
        let start = Sphere::new(truth.center + off, r * scale).unwrap();
        let end = sphere_geometric(points.iter().copied(), &start).unwrap();
        prop_assert!(squares(&points, &end) <= squares(&points, &start));
        if let Some(linear) = sphere_least_squares(points.iter().copied()) {
            let refined = sphere_geometric(points.iter().copied(), &linear).unwrap();
            prop_assert!(squares(&points, &refined) <= squares(&points, &linear));
        }
    }

    #[test]
    fn lines_are_recovered_and_move_with_the_points(
        m in motion(), p in vector(1.0), seed in any::<u64>(),
    ) {
        let direction = unit(&mut ChaCha8Rng::seed_from_u64(seed));
        let truth = Line::new(p.into(), direction).unwrap();
        let exact = line_least_squares(rod(&truth, 30, 0.0, seed).into_iter()).unwrap();
        prop_assert!(angle_between_axes(&exact.direction, &direction).unwrap() < 1e-10);
        prop_assert!(truth.distance(&exact.point) < 1e-12);

        let points = rod(&truth, 60, 0.01, seed);
        let a = line_least_squares(points.iter().copied()).unwrap();
        let b = line_least_squares(points.iter().map(|p| m * p).collect::<Vec<_>>().into_iter()).unwrap();
        prop_assert!(angle_between_axes(&(m * a.direction.into_inner()), &b.direction).unwrap() < 1e-9);
        prop_assert!((m * a.point - b.point).norm() < 1e-11);
    }

    #[test]
    fn no_line_fits_better_than_total_least_squares(
        seed in any::<u64>(), turn in vector(0.2), shift in vector(0.01),
    ) {
        let line = Line::new(Point3::new(0.1, 0.2, 0.8), Vector3::new(1.0, 2.0, -0.5)).unwrap();
        let points = rod(&line, 50, 0.01, seed);
        let best = line_least_squares(points.iter().copied()).unwrap();
        let other = Line::new(
            best.point + shift,
            UnitQuaternion::from_scaled_axis(turn) * best.direction.into_inner(),
        ).unwrap();
        let sum = |l: &Line| points.iter().map(|p| l.distance(p).powi(2)).sum::<f64>();
        prop_assert!(sum(&best) <= sum(&other) + 1e-15);
    }

    #[test]
    fn planes_are_recovered(p in vector(1.0), seed in any::<u64>()) {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let normal = unit(&mut rng);
        let points: Vec<Point3<f64>> = (0..40)
            .map(|_| Point3::from(p) + normal.cross(&unit(&mut rng)))
            .collect();
        let plane = plane_least_squares(points.iter().copied()).unwrap();
        prop_assert!(angle_between_axes(&plane.normal, &normal).unwrap() < 1e-9);
        prop_assert!(points.iter().all(|q| plane.signed_distance(q).abs() < 1e-9));
    }

    #[test]
    fn any_points_give_a_finite_model_or_none(
        raw in prop::collection::vec(prop::array::uniform3(prop_oneof![
            4 => -1.0..1.0f64, 1 => Just(0.0), 1 => Just(f64::NAN), 1 => Just(f64::INFINITY),
            1 => Just(1e300), 1 => Just(1e-300),
        ]), 0..12),
    ) {
        let points: Vec<Point3<f64>> = raw.into_iter().map(Point3::from).collect();
        let finite = |s: Sphere| s.radius.is_finite() && s.center.iter().all(|c| c.is_finite());
        let it = || points.iter().copied();
        prop_assert!(sphere_least_squares(it()).is_none_or(finite));
        let start = Sphere::new(Point3::origin(), 1.0).unwrap();
        prop_assert!(sphere_geometric(it(), &start).is_none_or(finite));
        prop_assert!(line_least_squares(it()).is_none_or(|l| l.point.iter().all(|c| c.is_finite())));
        prop_assert!(plane_least_squares(it()).is_none_or(|p| p.offset.is_finite()));
        if let [a, b, c, d, ..] = points[..] {
            prop_assert!(sphere_through([a, b, c, d]).is_none_or(finite));
        }
    }
}
