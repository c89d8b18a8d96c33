//! The covariance in a report tells the truth: its 95 % ellipsoid holds the true shape 95 times in 100.

use crate::shapes::{cap, columns, gauss, side};
use nalgebra::{Point3, Unit, Vector3};
use pomona_fit::{
    CapsuleEstimator, CircleEstimator, CylinderEstimator, LineEstimator, PlaneEstimator, Points,
    SphereEstimator, SphereRefit,
};
use pomona_geometry::{Circle, Cylinder, Line, Plane, Sphere, across};
use pomona_ransac::{Estimator, FixedCount, LeastSquares, Msac, Ransac};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

const SIGMA: f64 = 5e-4;
const DRAWS: u64 = 2000;
const POINTS: usize = 250;

/// 95 % quantiles of χ² with 3 to 6 degrees of freedom (Abramowitz and Stegun 1964, table 26.8).
const QUANTILES: [f64; 4] = [7.815, 9.488, 11.070, 12.592];

/// Whether the ellipsoid about the model that a search finds holds the truth, whose deviation from a
/// model `deviation` gives.
fn holds<E: Estimator, const N: usize>(
    estimator: &E,
    seed: u64,
    deviation: impl Fn(&E::Model) -> [f64; N],
) -> bool {
    let report = Ransac::new(Msac::within(4.0 * SIGMA))
        .local_optimization(LeastSquares::rounds(50))
        .stopping(FixedCount::new(20))
        .run(estimator, &mut ChaCha8Rng::seed_from_u64(seed))
        .expect("a model");
    let covariance = report.covariance.expect("derivatives");
    let squared = covariance
        .mahalanobis_squared(&deviation(&report.model))
        .expect("as many parameters");
    squared <= QUANTILES[N - 3]
}

fn assert_coverage(shape: &str, holds: impl Fn(u64) -> bool) {
    let share = (0..DRAWS).filter(|&seed| holds(seed)).count() as f64 / DRAWS as f64;
    println!("{shape}: {:.1} %", 100.0 * share);
    assert!((0.93..=0.97).contains(&share), "{shape}: {share}");
}

/// (τ₁, τ₂) of a direction in the chart of another, and the two vectors across it.
fn tangents(of: &Unit<Vector3<f64>>, about: &Unit<Vector3<f64>>) -> ([f64; 2], [Vector3<f64>; 2]) {
    let [u, v] = across(about);
    let along = of.dot(about);
    ([of.dot(&u) / along, of.dot(&v) / along], [u, v])
}

/// (τ₁, τ₂, o₁, o₂) of a line in the chart of another.
fn line_deviation(truth: &Line, model: &Line) -> [f64; 4] {
    let ([t1, t2], [u, v]) = tangents(&truth.direction, &model.direction);
    // Where the true line crosses the plane through the model's point across it.
    let offset = truth.point - model.point;
    let crossing = truth.at(-offset.dot(&model.direction) / truth.direction.dot(&model.direction));
    let offset = crossing - model.point;
    [t1, t2, offset.dot(&u), offset.dot(&v)]
}

fn noise(rng: &mut ChaCha8Rng) -> Vector3<f64> {
    Vector3::from_fn(|_, _| SIGMA * gauss(rng))
}

#[test]
fn of_a_sphere() {
    let truth = Sphere::new(Point3::new(0.1, -0.05, 0.8), 0.04).unwrap();
    assert_coverage("sphere", |seed| {
        let [x, y, z] = columns(&cap(&truth, POINTS, 1.3, SIGMA, seed));
        let points = Points::new(&x, &y, &z).unwrap();
        let estimator = SphereEstimator::new(points, SphereRefit::Geometric);
        holds(&estimator, seed, |model| {
            let off = truth.center - model.center;
            [off.x, off.y, off.z, truth.radius - model.radius]
        })
    });
}

#[test]
fn of_a_line() {
    let truth = Line::new(Point3::new(0.1, -0.05, 0.8), Vector3::new(1.0, 0.4, -0.2)).unwrap();
    assert_coverage("line", |seed| {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let point = |_| truth.at(rng.random_range(-0.1..0.1)) + noise(&mut rng);
        let [x, y, z] = columns(&(0..POINTS).map(point).collect::<Vec<_>>());
        let estimator = LineEstimator::new(Points::new(&x, &y, &z).unwrap());
        holds(&estimator, seed, |model| line_deviation(&truth, model))
    });
}

#[test]
fn of_a_plane() {
    let truth = Plane::new(Point3::new(0.1, -0.05, 0.8), Vector3::new(0.2, 0.4, -1.0)).unwrap();
    let [u, v] = across(&truth.normal);
    assert_coverage("plane", |seed| {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let mut span = || rng.random_range(-0.1..0.1);
        let on = (0..POINTS).map(|_| Point3::new(0.1, -0.05, 0.8) + u * span() + v * span());
        let on: Vec<_> = on.collect();
        let points = on.into_iter().map(|p| truth.project(&p) + noise(&mut rng));
        let [x, y, z] = columns(&points.collect::<Vec<_>>());
        let estimator = PlaneEstimator::new(Points::new(&x, &y, &z).unwrap());
        holds(&estimator, seed, |model| {
            let ([t1, t2], _) = tangents(&truth.normal, &model.normal);
            // Where the true plane crosses the model's normal through its foot.
            let foot = Point3::from(model.normal.into_inner() * model.offset);
            let shift = -truth.signed_distance(&foot) / truth.normal.dot(&model.normal);
            [t1, t2, shift]
        })
    });
}

#[test]
fn of_a_cylinder_and_a_capsule() {
    let axis = Line::new(Point3::new(0.1, -0.05, 0.8), Vector3::new(1.0, 0.4, -0.2)).unwrap();
    let truth = Cylinder::new(axis, 0.02).unwrap();
    let deviation = |model: &Cylinder| {
        let [t1, t2, o1, o2] = line_deviation(&truth.axis, &model.axis);
        [t1, t2, o1, o2, truth.radius - model.radius]
    };
    let drawn = |seed| {
        let (points, normals) = side(&truth, POINTS, (1.4, 0.2, SIGMA), seed);
        let normals: Vec<_> = normals.into_iter().map(Point3::from).collect();
        (columns(&points), columns(&normals))
    };
    assert_coverage("cylinder", |seed| {
        let ([x, y, z], [nx, ny, nz]) = drawn(seed);
        let points = Points::new(&x, &y, &z).unwrap();
        let estimator = CylinderEstimator::new(points, Points::new(&nx, &ny, &nz).unwrap());
        holds(&estimator, seed, deviation)
    });
    assert_coverage("capsule", |seed| {
        let ([x, y, z], [nx, ny, nz]) = drawn(seed);
        let points = Points::new(&x, &y, &z).unwrap();
        let normals = Points::new(&nx, &ny, &nz).unwrap();
        let estimator = CapsuleEstimator::new(points, normals, 4.0 * SIGMA, 0.03);
        holds(&estimator, seed, |model| {
            deviation(&model.cylinder().expect("a length"))
        })
    });
}

#[test]
fn of_a_circle() {
    let center = Point3::new(0.1, -0.05, 0.8);
    let truth = Circle::new(center, Vector3::new(0.2, 0.4, -1.0), 0.05).unwrap();
    let [u, v] = across(&truth.normal);
    assert_coverage("circle", |seed| {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let point = |_| {
            let angle: f64 = rng.random_range(0.0..4.0);
            center + (u * angle.cos() + v * angle.sin()) * truth.radius + noise(&mut rng)
        };
        let [x, y, z] = columns(&(0..POINTS).map(point).collect::<Vec<_>>());
        let estimator = CircleEstimator::new(Points::new(&x, &y, &z).unwrap());
        holds(&estimator, seed, |model| {
            let ([t1, t2], [u, v]) = tangents(&truth.normal, &model.normal);
            let off = truth.center - model.center;
            let shift = [off.dot(&u), off.dot(&v), off.dot(&model.normal)];
            let radius = truth.radius - model.radius;
            [t1, t2, shift[0], shift[1], shift[2], radius]
        })
    });
}
