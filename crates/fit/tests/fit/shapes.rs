//! Random shapes and points on them.

use nalgebra::{Isometry3, Point3, Translation3, Unit, UnitQuaternion, Vector3};
use pomona_geometry::{Cylinder, Line, Sphere, across};
use proptest::prelude::*;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

pub(crate) fn vector(limit: f64) -> impl Strategy<Value = Vector3<f64>> {
    prop::array::uniform3(-limit..limit).prop_map(Vector3::from)
}

pub(crate) fn direction() -> impl Strategy<Value = Unit<Vector3<f64>>> {
    vector(1.0)
        .prop_filter("a length", |v| v.norm() > 0.1)
        .prop_map(Unit::new_normalize)
}

pub(crate) fn motion() -> impl Strategy<Value = Isometry3<f64>> {
    (vector(2.0), vector(3.0)).prop_map(|(t, r)| {
        Isometry3::from_parts(Translation3::from(t), UnitQuaternion::from_scaled_axis(r))
    })
}

/// A standard normal number (Box and Muller 1958).
pub(crate) fn gauss(rng: &mut ChaCha8Rng) -> f64 {
    let (a, b): (f64, f64) = (
        rng.random_range(f64::EPSILON..1.0),
        rng.random_range(0.0..1.0),
    );
    (-2.0 * a.ln()).sqrt() * (std::f64::consts::TAU * b).cos()
}

pub(crate) fn unit(rng: &mut ChaCha8Rng) -> Vector3<f64> {
    loop {
        let v = Vector3::from_fn(|_, _| rng.random_range(-1.0..1.0));
        let n = v.norm();
        if n > 0.1 && n < 1.0 {
            return v / n;
        }
    }
}

/// `n` points of a cylinder's side within `half_angle` of a direction across the axis, over a `length` about
/// the axis's point, off the surface by σ = `noise`; and the outward normals.
pub(crate) fn side(
    cylinder: &Cylinder,
    n: usize,
    (half_angle, length, noise): (f64, f64, f64),
    seed: u64,
) -> (Vec<Point3<f64>>, Vec<Vector3<f64>>) {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let [u, v] = across(&cylinder.axis.direction);
    (0..n)
        .map(|_| {
            let angle: f64 = rng.random_range(-half_angle..half_angle);
            let normal = u * angle.cos() + v * angle.sin();
            let along = length * rng.random_range(-0.5..0.5);
            let off = noise * gauss(&mut rng);
            (
                cylinder.axis.at(along) + normal * (cylinder.radius + off),
                normal,
            )
        })
        .unzip()
}

/// `n` points of a sphere's cap within `half_angle` of the direction towards the origin, off the surface
/// by σ = `noise`.
pub(crate) fn cap(
    sphere: &Sphere,
    n: usize,
    half_angle: f64,
    noise: f64,
    seed: u64,
) -> Vec<Point3<f64>> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let pole = -sphere.center.coords.normalize();
    let mut points = Vec::new();
    while points.len() < n {
        let normal = unit(&mut rng);
        if normal.dot(&pole) > half_angle.cos() {
            points.push(sphere.center + normal * (sphere.radius + noise * gauss(&mut rng)));
        }
    }
    points
}

pub(crate) fn close_lines(a: &Line, b: &Line, angle: f64, distance: f64) -> bool {
    pomona_geometry::angle_between_axes(&a.direction, &b.direction).is_some_and(|d| d < angle)
        && a.distance(&b.point) < distance
        && b.distance(&a.point) < distance
}

pub(crate) fn close_cylinders(a: &Cylinder, b: &Cylinder, tolerance: f64) -> bool {
    close_lines(&a.axis, &b.axis, tolerance / 0.01, tolerance)
        && (a.radius - b.radius).abs() < tolerance
}

/// Three arrays of coordinates.
pub(crate) fn columns(points: &[Point3<f64>]) -> [Vec<f64>; 3] {
    [0, 1, 2].map(|k| points.iter().map(|p| p[k]).collect())
}
