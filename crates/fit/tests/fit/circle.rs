//! Circles in space: exact recovery, equivariance, no refit worse than its start.

use crate::shapes::{columns, direction, gauss, motion, unit, vector};
use nalgebra::{Point3, Unit, Vector3};
use pomona_fit::{CircleEstimator, Points, circle_geometric, circle_through};
use pomona_geometry::{Circle, across, angle_between_axes};
use pomona_ransac::{FixedCount, LeastSquares, Msac, Ransac};
use proptest::prelude::*;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

fn circle(center: Vector3<f64>, normal: Unit<Vector3<f64>>, radius: f64) -> Circle {
    Circle::new(center.into(), normal.into_inner(), radius).expect("a circle")
}

/// Points of three quarters of a circle.
fn arc(circle: &Circle, n: usize, noise: f64, seed: u64) -> Vec<Point3<f64>> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let [u, v] = across(&circle.normal);
    (0..n)
        .map(|_| {
            let angle: f64 = rng.random_range(0.0..4.7);
            let off = Vector3::from_fn(|_, _| noise * gauss(&mut rng));
            circle.center + (u * angle.cos() + v * angle.sin()) * circle.radius + off
        })
        .collect()
}

fn close(a: &Circle, b: &Circle, tolerance: f64) -> bool {
    (a.center - b.center).norm() < tolerance
        && (a.radius - b.radius).abs() < tolerance
        && angle_between_axes(&a.normal, &b.normal).is_some_and(|d| d < 100.0 * tolerance)
}

proptest! {
    #[test]
    fn circles_are_recovered_exactly(
        center in vector(1.0), n in direction(), r in 0.01..0.2f64, off in vector(0.2), seed in any::<u64>(),
    ) {
        let truth = circle(center, n, r);
        let points = arc(&truth, 30, 0.0, seed);
        let [p, q] = [points[1] - points[0], points[2] - points[0]].map(|v| v / r);
        if p.cross(&q).norm() > 0.1 {
            prop_assert!(close(&circle_through([points[0], points[1], points[2]]).unwrap(), &truth, 1e-12));
        }
        let start = circle(center + off * r, Unit::new_normalize(n.into_inner() + off), r * 1.3);
        let fit = circle_geometric(points.iter().copied(), &start).unwrap();
        prop_assert!(close(&fit, &truth, 1e-9), "{fit:?} of {truth:?}");
    }

    #[test]
    fn circles_move_with_the_points(m in motion(), seed in any::<u64>()) {
        let truth = circle(Vector3::new(0.1, 0.2, 0.8), Vector3::x_axis(), 0.05);
        let points = arc(&truth, 60, 0.001, seed);
        let there = |c: &Circle| circle((m * c.center).coords, m * c.normal, c.radius);
        let a = circle_geometric(points.iter().copied(), &truth).unwrap();
        let moved: Vec<_> = points.iter().map(|p| m * p).collect();
        let b = circle_geometric(moved.iter().copied(), &there(&truth)).unwrap();
        prop_assert!(close(&there(&a), &b, 1e-8));
    }

    #[test]
    fn a_refit_is_never_worse_and_never_panics(
        raw in prop::collection::vec(prop::array::uniform3(-1.0..1.0f64), 0..15), n in direction(), r in 0.1..2.0f64,
        spoil in prop::option::of(prop::sample::select(vec![f64::NAN, f64::INFINITY, 1e300, 1e-300])),
    ) {
        let start = circle(Vector3::zeros(), n, r);
        let mut points: Vec<Point3<f64>> = raw.into_iter().map(Point3::from).collect();
        if let (Some(bad), Some(p)) = (spoil, points.first_mut()) {
            p.y = bad;
        }
        let squares = |c: &Circle| points.iter().map(|p| c.distance(p).powi(2)).sum::<f64>();
        if let Some(fit) = circle_geometric(points.iter().copied(), &start) {
            prop_assert!(squares(&fit) <= squares(&start));
        }
    }
}

#[test]
fn a_search_finds_a_circle_among_outliers() {
    let truth = circle(
        Vector3::new(0.1, 0.0, 0.8),
        Unit::new_normalize(Vector3::new(0.2, 0.4, 1.0)),
        0.05,
    );
    let mut points = arc(&truth, 200, 0.0005, 1);
    let mut rng = ChaCha8Rng::seed_from_u64(2);
    points.extend((0..200).map(|_| truth.center + unit(&mut rng) * rng.random_range(0.0..0.1)));
    let [x, y, z] = columns(&points);
    let report = Ransac::new(Msac::within(0.002))
        .local_optimization(LeastSquares::default())
        .stopping(FixedCount::new(300))
        .run(
            &CircleEstimator::new(Points::new(&x, &y, &z).unwrap()),
            &mut ChaCha8Rng::seed_from_u64(3),
        )
        .unwrap();
    assert!(close(&report.model, &truth, 3e-4), "{:?}", report.model);
}
