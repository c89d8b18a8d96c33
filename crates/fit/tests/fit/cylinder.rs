//! Cylinders: exact recovery, equivariance, no refit worse than its start, one-sided surfaces with
//! a prior, and a search with normals.

use crate::shapes::{close_cylinders, columns, direction, gauss, motion, side, unit, vector};
use nalgebra::{Point3, Unit, UnitQuaternion, Vector3};
use pomona_fit::{
    CylinderEstimator, Points, RadiusPrior, cylinder_geometric, cylinder_near_line,
    cylinder_through, cylinder_weighted,
};
use pomona_geometry::{Cylinder, Line, across, angle_between_axes};
use pomona_ransac::{Estimator, FixedCount, LeastSquares, Msac, Ransac};
use proptest::prelude::*;
use rand::{RngExt, SeedableRng, seq::SliceRandom};
use rand_chacha::ChaCha8Rng;
use std::f64::consts::PI;

fn cylinder(point: Vector3<f64>, direction: Unit<Vector3<f64>>, radius: f64) -> Cylinder {
    let axis = Line::new(point.into(), direction.into_inner());
    Cylinder::new(axis.expect("a line"), radius).expect("a radius")
}

/// Another cylinder nearby.
fn disturbed(c: &Cylinder, by: Vector3<f64>, scale: f64) -> Cylinder {
    let direction = Unit::new_normalize(c.axis.direction.into_inner() + by * 0.2);
    cylinder(
        c.axis.point.coords + by * c.radius,
        direction,
        c.radius * scale,
    )
}

fn squares(points: &[Point3<f64>], c: &Cylinder) -> f64 {
    points.iter().map(|p| c.signed_distance(p).powi(2)).sum()
}

proptest! {
    #[test]
    fn cylinders_are_recovered_exactly(
        point in vector(1.0), d in direction(), r in 0.003..0.05f64, by in vector(0.3), scale in 0.7..1.4f64, seed in any::<u64>(),
    ) {
        let truth = cylinder(point, d, r);
        let (points, normals) = side(&truth, 200, (PI / 2.0, 10.0 * r, 0.0), seed);
        let pair = (1..200).find(|&j| normals[0].cross(&normals[j]).norm() > 0.3).unwrap();
        let minimal = cylinder_through([points[0], points[pair]], [normals[0] * -3.0, normals[pair]]).unwrap();
        prop_assert!(close_cylinders(&minimal, &truth, 1e-12), "{minimal:?}");
        let fit = cylinder_geometric(points.iter().copied(), &disturbed(&truth, by, scale)).unwrap();
        prop_assert!(close_cylinders(&fit, &truth, 1e-9), "{fit:?} of {truth:?}");
    }

    #[test]
    fn cylinders_move_with_the_points(m in motion(), r in 0.003..0.05f64, seed in any::<u64>()) {
        let truth = cylinder(Vector3::new(0.1, 0.2, 0.8), Unit::new_normalize(Vector3::new(1.0, 0.3, -0.2)), r);
        let (points, _) = side(&truth, 150, (PI / 2.0, 10.0 * r, 0.02 * r), seed);
        let there = |c: &Cylinder| Cylinder::new(
            Line::new(m * c.axis.point, m * c.axis.direction.into_inner()).unwrap(), c.radius,
        ).unwrap();
        let a = cylinder_geometric(points.iter().copied(), &truth).unwrap();
        let moved = points.iter().map(|p| m * p).collect::<Vec<_>>();
        let b = cylinder_geometric(moved.iter().copied(), &there(&truth)).unwrap();
        prop_assert!(close_cylinders(&there(&a), &b, 1e-8));
        prop_assert!((there(&a).axis.point - b.axis.point).norm() < 1e-8);
    }

    #[test]
    fn the_order_of_points_does_not_matter(seed in any::<u64>()) {
        let truth = cylinder(Vector3::new(0.1, 0.2, 0.8), Vector3::x_axis(), 0.01);
        let (mut points, _) = side(&truth, 100, (1.2, 0.1, 0.0005), seed);
        let a = cylinder_geometric(points.iter().copied(), &truth).unwrap();
        points.shuffle(&mut ChaCha8Rng::seed_from_u64(seed ^ 1));
        let b = cylinder_geometric(points.iter().copied(), &truth).unwrap();
        prop_assert!(close_cylinders(&a, &b, 1e-8));
    }

    #[test]
    fn a_refit_is_never_worse_and_never_panics(
        raw in prop::collection::vec(prop::array::uniform3(-1.0..1.0f64), 0..20), by in vector(1.0), scale in 0.1..5.0f64,
        spoil in prop::option::of(prop::sample::select(vec![f64::NAN, f64::INFINITY, 1e300, 1e-300])),
    ) {
        let start = disturbed(&cylinder(Vector3::zeros(), Vector3::z_axis(), 0.5), by, scale);
        let mut points: Vec<Point3<f64>> = raw.into_iter().map(Point3::from).collect();
        if let (Some(bad), Some(p)) = (spoil, points.first_mut()) {
            p.x = bad;
        }
        if let Some(fit) = cylinder_geometric(points.iter().copied(), &start) {
            // The axis's point moves along the axis before and after: that rounds.
            prop_assert!(squares(&points, &fit) <= squares(&points, &start) * (1.0 + 1e-9));
        }
    }

    #[test]
    fn a_narrow_side_is_recovered_with_a_prior(d in direction(), seed in any::<u64>()) {
        // 40° of a branch of 6 mm with 0.5 mm noise: alone it does not tell the radius.
        let truth = cylinder(Vector3::new(0.1, 0.1, 0.8), d, 0.006);
        let (points, _) = side(&truth, 400, (0.35, 0.06, 0.0005), seed);
        let prior = RadiusPrior::new(0.006, 0.0005).unwrap();
        let start = disturbed(&truth, Vector3::new(0.2, -0.1, 0.1), 1.5);
        let weighted = points.iter().map(|&p| (p, 0.0005_f64.powi(-2)));
        let fit = cylinder_weighted(weighted, &start, Some(prior)).unwrap();
        prop_assert!((fit.radius - 0.006).abs() < 0.0021, "{fit:?}");
        prop_assert!(fit.axis.distance(&truth.axis.point) < 0.0022, "{fit:?}");
        prop_assert!(angle_between_axes(&fit.axis.direction, &d).unwrap() < 0.06);
    }

    #[test]
    fn the_axis_is_found_behind_a_line_through_the_visible_side(
        around in 0.0..PI, tilt in -0.08..0.08f64, r in 0.003..0.012f64, known in 0.8..1.25f64, seed in any::<u64>(),
    ) {
        // A branch at 0.8 m seen from the origin: only its near side has points.
        let d = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), around) * Vector3::new(1.0, 0.0, 0.2);
        let truth = cylinder(Vector3::new(0.05, -0.02, 0.8), Unit::new_normalize(d), r);
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let toward = -truth.axis.point.coords;
        let toward = (toward - d * toward.dot(&d) / d.norm_squared()).normalize();
        let sideways = d.normalize().cross(&toward);
        let points: Vec<Point3<f64>> = (0..600).map(|_| {
            let x: f64 = rng.random_range(-0.95..0.95);
            truth.axis.at(rng.random_range(-0.04..0.04))
                + (sideways * x + toward * (1.0 - x * x).sqrt()) * r
                + unit(&mut rng) * (0.0003 * gauss(&mut rng))
        }).collect();
        let [u, _] = across(&truth.axis.direction);
        let line = Line::new(truth.axis.point + toward * (r * 0.8), truth.axis.direction.into_inner() + u * tilt).unwrap();
        let prior = RadiusPrior::new(r * known, 0.3 * r).unwrap();
        let weighted = points.iter().map(|&p| (p, 0.0003_f64.powi(-2)));
        let fit = cylinder_near_line(weighted, &line, &Point3::origin(), prior).unwrap();
        prop_assert!((fit.radius - r).abs() < 3e-4, "{fit:?} of {r}");
        prop_assert!(fit.axis.distance(&truth.axis.point) < 3e-4, "{fit:?}");
        prop_assert!(angle_between_axes(&fit.axis.direction, &truth.axis.direction).unwrap() < 0.01);
    }
}

#[test]
fn a_search_finds_a_cylinder_among_outliers() {
    let truth = cylinder(
        Vector3::new(0.1, 0.1, 0.8),
        Unit::new_normalize(Vector3::new(0.3, 1.0, 0.1)),
        0.008,
    );
    let (mut points, mut normals) = side(&truth, 600, (1.2, 0.1, 0.0003), 4);
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    for n in &mut normals {
        *n = (*n + unit(&mut rng) * 0.1).normalize();
    }
    for _ in 0..900 {
        points.push(truth.axis.point + Vector3::from_fn(|_, _| rng.random_range(-0.06..0.06)));
        normals.push(unit(&mut rng));
    }
    let [x, y, z] = columns(&points);
    let normals: Vec<Point3<f64>> = normals.into_iter().map(Point3::from).collect();
    let [nx, ny, nz] = columns(&normals);
    let view = Points::new(&x, &y, &z).unwrap();
    let estimator = CylinderEstimator::new(view, Points::new(&nx, &ny, &nz).unwrap())
        .prior(RadiusPrior::new(0.007, 0.002).unwrap(), 0.0003)
        .unwrap();
    let report = Ransac::new(Msac::within(0.001))
        .local_optimization(LeastSquares::default())
        .stopping(FixedCount::new(500))
        .run(&estimator, &mut ChaCha8Rng::seed_from_u64(1))
        .unwrap();
    assert!(
        close_cylinders(&report.model, &truth, 2e-4),
        "{:?}",
        report.model
    );

    // Fewer normals than points: the sample is refused, nothing panics.
    let none = CylinderEstimator::new(view, Points::new(&nx[..1], &ny[..1], &nz[..1]).unwrap());
    let mut candidates = pomona_ransac::Candidates::new(1);
    none.fit(&[0, 5], &mut candidates);
    assert!(candidates.is_empty());
}

#[test]
fn the_radius_of_a_visible_side_has_no_bias() {
    // 140° of a branch of 8 mm with 0.5 mm noise: of second order a distance fit is off by σ²/2r = 16 µm.
    let truth = cylinder(
        Vector3::new(0.1, 0.1, 0.8),
        Unit::new_normalize(Vector3::new(0.3, 1.0, 0.1)),
        0.008,
    );
    let radii: Vec<f64> = (0..300)
        .map(|seed| {
            let (points, _) = side(&truth, 300, (1.22, 0.08, 0.0005), seed);
            cylinder_geometric(points.into_iter(), &truth)
                .expect("a cylinder")
                .radius
        })
        .collect();
    let mean = radii.iter().sum::<f64>() / 300.0;
    let spread = radii.iter().map(|r| (r - mean).powi(2)).sum::<f64>() / 299.0;
    let standard_error = (spread / 300.0).sqrt();
    assert!(
        (mean - 0.008).abs() < 3.0 * standard_error + 2.5e-5,
        "{mean} ± {standard_error}"
    );
    assert!(spread.sqrt() < 2.5e-4, "{}", spread.sqrt());
}
