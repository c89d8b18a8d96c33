//! Constraints hold in the outcome, and a refit that breaks one becomes the best fit that does not.

use crate::shapes::{cap, columns, direction, gauss, side};
use nalgebra::{Point3, Unit, Vector3};
use pomona_fit::{
    AngleWindow, CenterSide, CircleEstimator, CylinderEstimator, DistanceWindow, FootSide,
    HeldRefit, LineEstimator, PlaneEstimator, Points, RadiusWindow, Refusing, SphereEstimator,
    SphereRefit,
};
use pomona_geometry::{Circle, Cylinder, Line, Plane, Sphere, angle_between_axes};
use pomona_ransac::{
    Constraint, Estimator, FixedCount, LeastSquares, Msac, NoRefit, Ransac, RefitOnce, Reweighted,
    Scorer,
};
use proptest::prelude::*;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Searches with each local optimisation; the constraint must hold in every outcome, and no outcome that
/// climbs may score less than the best hypothesis as drawn.
fn search<E, C>(
    estimator: &E,
    constraint: C,
    threshold: f64,
    seed: u64,
) -> Result<Option<E::Model>, TestCaseError>
where
    E: HeldRefit<Model: std::fmt::Debug>,
    C: Constraint<E> + Copy,
{
    let rng = || ChaCha8Rng::seed_from_u64(seed);
    let search = || {
        Ransac::new(Msac::within(threshold))
            .constraint(constraint)
            .stopping(FixedCount::new(60))
    };
    let drawn = search()
        .local_optimization(NoRefit)
        .run(estimator, &mut rng());
    let Ok(drawn) = drawn else {
        return Ok(None);
    };
    let climbed = search()
        .local_optimization(LeastSquares::default())
        .run(estimator, &mut rng());
    let weighted = search()
        .local_optimization(Reweighted::by(|fraction: f64| {
            (1.0 - fraction * fraction).max(0.0)
        }))
        .run(estimator, &mut rng());
    let once = search()
        .local_optimization(RefitOnce)
        .run(estimator, &mut rng());
    for report in [&climbed, &weighted, &once] {
        let report = report.as_ref().expect("the same draws");
        prop_assert!(
            constraint.allows_model(estimator, &report.model),
            "{:?}",
            report.model
        );
    }
    for report in [&climbed, &weighted] {
        prop_assert!(report.as_ref().expect("the same draws").score >= drawn.score);
    }
    Ok(Some(climbed.expect("the same draws").model))
}

/// No model near `best` that the constraint allows has a smaller sum of squares.
fn is_best<E: Estimator>(
    estimator: &E,
    constraint: &impl Constraint<E>,
    best: &E::Model,
    near: impl Fn(&mut ChaCha8Rng, f64) -> Option<E::Model>,
) -> Result<(), TestCaseError> {
    let squares = |model: &E::Model| {
        let mut residuals = vec![0.0; estimator.len()];
        estimator.residuals(model, 0..estimator.len(), &mut residuals);
        residuals.iter().map(|r| r * r).sum::<f64>()
    };
    prop_assert!(constraint.allows_model(estimator, best));
    let least = squares(best);
    let mut rng = ChaCha8Rng::seed_from_u64(9);
    let mut tried = 0;
    for i in 0..2000 {
        let size = [1e-2, 1e-3, 1e-4, 1e-5][i % 4];
        let Some(other) = near(&mut rng, size) else {
            continue;
        };
        if constraint.allows_model(estimator, &other) {
            tried += 1;
            // The bound is kept to 1e-9 of the window's width.
            prop_assert!(
                squares(&other) >= least * (1.0 - 1e-6),
                "{} under {least}",
                squares(&other)
            );
        }
    }
    prop_assert!(tried > 100, "{tried} neighbours are allowed");
    Ok(())
}

fn shift(rng: &mut ChaCha8Rng, size: f64) -> Vector3<f64> {
    Vector3::from_fn(|_, _| size * rng.random_range(-1.0..1.0))
}

/// Points about a line, with as many outliers.
fn rod(line: &Line, n: usize, noise: f64, seed: u64) -> Vec<Point3<f64>> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    (0..n)
        .map(|_| {
            let off = Vector3::from_fn(|_, _| noise * gauss(&mut rng));
            line.at(rng.random_range(-0.1..0.1)) + off
        })
        .collect()
}

fn clutter(points: &mut Vec<Point3<f64>>, n: usize, seed: u64) {
    let mut rng = ChaCha8Rng::seed_from_u64(seed ^ 0x77);
    let center = points[0];
    points.extend((0..n).map(|_| center + shift(&mut rng, 0.1)));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn radii_stay_in_their_window(low in 0.03..0.05f64, width in 0.001..0.01f64, seed in any::<u64>(), linear in any::<bool>()) {
        let truth = Sphere::new(Point3::new(0.1, -0.05, 0.8), 0.04).unwrap();
        let mut points = cap(&truth, 60, 0.9, 0.001, seed);
        clutter(&mut points, 30, seed);
        let window = RadiusWindow::new(low, low + width).unwrap();
        let refit = if linear { SphereRefit::Algebraic } else { SphereRefit::Geometric };
        let [x, y, z] = columns(&points);
        search(&SphereEstimator::new(Points::new(&x, &y, &z).unwrap(), refit), window, 0.004, seed)?;
        search(&CircleEstimator::new(Points::new(&x, &y, &z).unwrap()), window, 0.004, seed)?;
    }

    #[test]
    fn axes_keep_their_distance_and_their_angle(
        d in direction(), center in direction(), low in 0.0..0.05f64, width in 0.001..0.02f64,
        about in direction(), angle in 0.0..1.3f64, opening in 0.01..0.4f64, seed in any::<u64>(),
    ) {
        let line = Line::new(Point3::new(0.1, -0.05, 0.8), d.into_inner()).unwrap();
        let mut points = rod(&line, 60, 0.002, seed);
        clutter(&mut points, 30, seed);
        let [x, y, z] = columns(&points);
        let view = Points::new(&x, &y, &z).unwrap();
        let point = line.point + center.into_inner() * 0.03;
        search(&LineEstimator::new(view), DistanceWindow::new(point, low, low + width).unwrap(), 0.006, seed)?;
        let window = AngleWindow::new(about, angle, angle + opening).unwrap();
        search(&LineEstimator::new(view), window, 0.006, seed)?;
        search(&PlaneEstimator::new(view), window, 0.006, seed)?;
        let plane = Plane::new(line.point, center.into_inner()).unwrap();
        search(&LineEstimator::new(view), FootSide::positive(plane, point), 0.006, seed)?;
    }

    #[test]
    fn cylinders_obey(low in 0.005..0.012f64, width in 0.0005..0.003f64, d in direction(), about in direction(), seed in any::<u64>()) {
        let axis = Line::new(Point3::new(0.1, -0.05, 0.8), d.into_inner()).unwrap();
        let truth = Cylinder::new(axis, 0.008).unwrap();
        let (points, normals) = side(&truth, 80, (1.2, 0.1, 0.0005), seed);
        let [x, y, z] = columns(&points);
        let normals: Vec<_> = normals.into_iter().map(|n| Point3::from(n + 0.1 * about.into_inner())).collect();
        let [nx, ny, nz] = columns(&normals);
        let estimator = CylinderEstimator::new(Points::new(&x, &y, &z).unwrap(), Points::new(&nx, &ny, &nz).unwrap());
        search(&estimator, RadiusWindow::new(low, low + width).unwrap(), 0.002, seed)?;
        search(&estimator, AngleWindow::at_most(about, 1.0).unwrap(), 0.002, seed)?;
        search(&estimator, DistanceWindow::new(axis.point, 0.003, 0.01).unwrap(), 0.002, seed)?;
    }

    #[test]
    fn centres_stay_on_their_side(normal in direction(), height in -0.01..0.01f64, seed in any::<u64>()) {
        let truth = Sphere::new(Point3::new(0.1, -0.05, 0.8), 0.04).unwrap();
        let [x, y, z] = columns(&cap(&truth, 60, 0.9, 0.002, seed));
        let plane = Plane::new(truth.center + normal.into_inner() * height, normal.into_inner()).unwrap();
        let estimator = SphereEstimator::new(Points::new(&x, &y, &z).unwrap(), SphereRefit::Geometric);
        search(&estimator, CenterSide::positive(plane), 0.006, seed)?;
    }

    #[test]
    fn a_restored_sphere_is_the_best_in_the_window(bound in 0.02..0.036f64, seed in any::<u64>()) {
        let truth = Sphere::new(Point3::new(0.1, -0.05, 0.8), 0.04).unwrap();
        let [x, y, z] = columns(&cap(&truth, 60, 1.2, 0.0005, seed));
        let estimator = SphereEstimator::new(Points::new(&x, &y, &z).unwrap(), SphereRefit::Geometric);
        let all: Vec<usize> = (0..60).collect();
        let free = estimator.refit(&all, &truth).unwrap();
        let window = RadiusWindow::new(0.01, bound).unwrap();
        let held = window.restore(&estimator, &all, None, &free).unwrap();
        prop_assert!((held.radius - bound).abs() < 1e-9);
        is_best(&estimator, &window, &held, |rng, size| {
            Sphere::new(held.center + shift(rng, size), held.radius + shift(rng, size).x)
        })?;
    }

    #[test]
    fn a_restored_line_is_the_best_at_its_distance_or_angle(
        d in direction(), aside in 0.005..0.05f64, off in 0.004..0.02f64, lean in 0.05..0.3f64, seed in any::<u64>(),
    ) {
        let truth = Line::new(Point3::new(0.1, -0.05, 0.8), d.into_inner()).unwrap();
        let [x, y, z] = columns(&rod(&truth, 60, 0.003, seed));
        let estimator = LineEstimator::new(Points::new(&x, &y, &z).unwrap());
        let all: Vec<usize> = (0..60).collect();
        let free = estimator.refit(&all, &truth).unwrap();
        let [u, _] = pomona_geometry::across(&free.direction);
        let point = free.point + u * aside + d.into_inner() * 0.03;
        let near = |held: Line| move |rng: &mut ChaCha8Rng, size| {
            Line::new(held.point + shift(rng, size), held.direction.into_inner() + shift(rng, size))
        };
        for (min, max) in [(aside + off, 1.0), (0.0, (aside - off).max(1e-3))] {
            let window = DistanceWindow::new(point, min, max).unwrap();
            let Some(held) = window.restore(&estimator, &all, None, &free) else {
                prop_assert!(window.allows_model(&estimator, &free));
                continue;
            };
            is_best(&estimator, &window, &held, near(held))?;
        }
        let about = Unit::new_normalize(free.direction.into_inner() + u * lean);
        let angle = angle_between_axes(&about, &free.direction).unwrap();
        let window = AngleWindow::at_most(about, angle / 2.0).unwrap();
        let held = window.restore(&estimator, &all, None, &free).unwrap();
        is_best(&estimator, &window, &held, near(held))?;
    }

    #[test]
    fn a_restored_cylinder_is_the_best_within_its_cone(d in direction(), lean in 0.05..0.3f64, seed in any::<u64>()) {
        let axis = Line::new(Point3::new(0.1, -0.05, 0.8), d.into_inner()).unwrap();
        let truth = Cylinder::new(axis, 0.01).unwrap();
        let (points, normals) = side(&truth, 80, (1.5, 0.1, 0.0005), seed);
        let [x, y, z] = columns(&points);
        let normals: Vec<_> = normals.into_iter().map(Point3::from).collect();
        let [nx, ny, nz] = columns(&normals);
        let estimator = CylinderEstimator::new(Points::new(&x, &y, &z).unwrap(), Points::new(&nx, &ny, &nz).unwrap());
        let all: Vec<usize> = (0..80).collect();
        let free = estimator.refit(&all, &truth).unwrap();
        let [u, _] = pomona_geometry::across(&free.axis.direction);
        let about = Unit::new_normalize(free.axis.direction.into_inner() + u * lean);
        let angle = angle_between_axes(&about, &free.axis.direction).unwrap();
        let window = AngleWindow::at_most(about, 0.7 * angle).unwrap();
        let held = window.restore(&estimator, &all, None, &free).unwrap();
        is_best(&estimator, &window, &held, |rng, size| {
            let axis = Line::new(held.axis.point + shift(rng, size), held.axis.direction.into_inner() + shift(rng, size));
            Cylinder::new(axis?, held.radius + shift(rng, size).x)
        })?;
    }

    #[test]
    fn nothing_panics_where_nothing_can_be_restored(
        raw in prop::collection::vec(prop::array::uniform3(-1.0..1.0f64), 0..8),
        spoil in prop::option::of(prop::sample::select(vec![f64::NAN, f64::INFINITY, 1e300, 1e-300])),
        d in direction(),
    ) {
        let mut points: Vec<Point3<f64>> = raw.into_iter().map(Point3::from).collect();
        if let (Some(bad), Some(p)) = (spoil, points.first_mut()) {
            p.y = bad;
        }
        let [x, y, z] = columns(&points);
        let view = Points::new(&x, &y, &z).unwrap();
        let all: Vec<usize> = (0..points.len()).collect();
        let line = Line::new(Point3::origin(), d.into_inner()).unwrap();
        let circle = Circle::new(Point3::origin(), d.into_inner(), 2.0).unwrap();
        let plane = Plane::new(Point3::origin(), d.into_inner()).unwrap();
        let far = DistanceWindow::new(Point3::new(1.0, 2.0, 3.0), 20.0, 21.0).unwrap();
        let through = DistanceWindow::new(Point3::origin(), 0.5, 1.0).unwrap();
        let lines = LineEstimator::new(view);
        for window in [far, through] {
            if let Some(held) = window.restore(&lines, &all, None, &line) {
                prop_assert!(window.allows_model(&lines, &held));
            }
        }
        let small = RadiusWindow::new(0.1, 0.2).unwrap();
        let circles = CircleEstimator::new(view);
        if let Some(held) = small.restore(&circles, &all, None, &circle) {
            prop_assert!(small.allows_model(&circles, &held));
        }
        let narrow = AngleWindow::new(Vector3::x_axis(), 0.2, 0.3).unwrap();
        let planes = PlaneEstimator::new(view);
        if let Some(held) = narrow.restore(&planes, &all, None, &plane) {
            prop_assert!(narrow.allows_model(&planes, &held));
        }
    }
}

#[test]
fn a_refit_that_leaves_the_window_is_kept_on_its_bound() {
    // The window ends a little under the true radius, so that the unconstrained refit leaves it.
    let truth = Sphere::new(Point3::new(0.1, -0.05, 0.8), 0.04).unwrap();
    let mut points = cap(&truth, 200, 1.2, 0.0005, 1);
    clutter(&mut points, 50, 1);
    let [x, y, z] = columns(&points);
    let estimator = SphereEstimator::new(Points::new(&x, &y, &z).unwrap(), SphereRefit::Geometric);
    let report = Ransac::new(Msac::within(0.002))
        .constraint(RadiusWindow::new(0.02, 0.0395).unwrap())
        .local_optimization(LeastSquares::default())
        .stopping(FixedCount::new(200))
        .run(&estimator, &mut ChaCha8Rng::seed_from_u64(2))
        .unwrap();
    assert!((report.model.radius - 0.0395).abs() < 1e-9);
    assert_eq!(report.counts.rejections()[0].refits, 0);
    let refused = Ransac::new(Msac::within(0.002))
        .constraint(Refusing(RadiusWindow::new(0.02, 0.0395).unwrap()))
        .local_optimization(LeastSquares::default())
        .stopping(FixedCount::new(200))
        .run(&estimator, &mut ChaCha8Rng::seed_from_u64(2))
        .unwrap();
    assert!(refused.counts.rejections()[0].refits > 0 && refused.score < report.score);
    let scorer = Msac::within(0.002);
    assert_eq!(
        scorer.score(&estimator, &report.model, 0.0),
        Some(report.score)
    );
}
