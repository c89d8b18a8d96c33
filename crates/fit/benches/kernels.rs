//! Points per second of scoring, for each primitive, kind of score and type of coordinate.
//!
//! `l1`: 1024 points, one block. `l2`: 16384 points, in the second-level cache. `memory`: a million
//! points against eight spheres, one sphere after the other or the eight of them block by block.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use nalgebra::{Point3, Vector3};
use pomona_fit::{
    Coordinate, CylinderEstimator, LineEstimator, PlaneEstimator, Points, SphereEstimator,
    SphereRefit,
};
use pomona_geometry::{Cylinder, Line, Plane, Sphere};
use pomona_ransac::{BLOCK, Estimator};
use std::hint::black_box;
use std::time::Duration;

const THRESHOLD: f64 = 0.003;

/// Points in a cube of 0.2 m about (0.1, −0.2, 0.8).
fn cloud<T: Coordinate>(n: usize) -> [Vec<T>; 3] {
    let along = |step: f64, center: f64| {
        let at = |i: usize| center - 0.1 + 0.2 * (i as f64 * step).fract();
        (0..n).map(|i| T::from_f64(at(i))).collect()
    };
    [
        along(0.618_034, 0.1),
        along(0.414_213, -0.2),
        along(0.732_051, 0.8),
    ]
}

fn blocks(n: usize) -> impl Iterator<Item = std::ops::Range<usize>> {
    (0..n)
        .step_by(BLOCK)
        .map(move |start| start..(start + BLOCK).min(n))
}

fn measure<E: Estimator>(criterion: &mut Criterion, name: &str, estimator: &E, model: &E::Model) {
    let n = estimator.len();
    let mut group = criterion.benchmark_group(name);
    group
        .throughput(Throughput::Elements(n as u64))
        .sample_size(20)
        .warm_up_time(Duration::from_millis(100))
        .measurement_time(Duration::from_millis(300));
    group.bench_function("count", |b| {
        b.iter(|| {
            let count = |block| estimator.count_within(black_box(model), block, THRESHOLD);
            blocks(n).map(count).sum::<usize>()
        });
    });
    group.bench_function("msac", |b| {
        b.iter(|| {
            let gain = |block| estimator.truncated_gain(black_box(model), block, THRESHOLD);
            blocks(n).map(gain).sum::<f64>()
        });
    });
    let mut selected = Vec::with_capacity(n);
    group.bench_function("select", |b| {
        b.iter(|| {
            selected.clear();
            for block in blocks(n) {
                estimator.select_within(black_box(model), block, THRESHOLD, &mut selected);
            }
            selected.len()
        });
    });
    group.finish();
}

fn shapes<T: Coordinate>(criterion: &mut Criterion, number: &str) {
    let center = Point3::new(0.1, -0.2, 0.8);
    let axis = Line::new(center, Vector3::new(0.3, 1.0, 0.2)).expect("a line");
    for (place, n) in [("l1", BLOCK), ("l2", 16 * BLOCK)] {
        let [x, y, z] = cloud::<T>(n);
        let points = Points::new(&x, &y, &z).expect("one length");
        let name = |shape: &str| format!("{shape}/{number}/{place}");
        let sphere = Sphere::new(center, 0.04).expect("a sphere");
        let spheres = SphereEstimator::new(points, SphereRefit::Geometric);
        measure(criterion, &name("sphere"), &spheres, &sphere);
        measure(criterion, &name("line"), &LineEstimator::new(points), &axis);
        let plane = Plane::new(center, Vector3::new(0.1, 0.2, -1.0)).expect("a plane");
        measure(
            criterion,
            &name("plane"),
            &PlaneEstimator::new(points),
            &plane,
        );
        let cylinder = Cylinder::new(axis, 0.01).expect("a cylinder");
        let cylinders = CylinderEstimator::new(points, points);
        measure(criterion, &name("cylinder"), &cylinders, &cylinder);
    }
}

fn many_hypotheses(criterion: &mut Criterion) {
    const N: usize = 1_000_000;
    let [x, y, z] = cloud::<f32>(N);
    let points = Points::new(&x, &y, &z).expect("one length");
    let estimator = SphereEstimator::new(points, SphereRefit::Geometric);
    let sphere = |i: i32| {
        Sphere::new(Point3::new(0.1, -0.2, 0.8), 0.03 + 0.002 * f64::from(i)).expect("a sphere")
    };
    let spheres: Vec<Sphere> = (0..8).map(sphere).collect();
    let count =
        |sphere: &Sphere, block| estimator.count_within(black_box(sphere), block, THRESHOLD);
    let mut group = criterion.benchmark_group("memory");
    group
        .throughput(Throughput::Elements(8 * N as u64))
        .sample_size(10)
        .measurement_time(Duration::from_secs(1));
    group.bench_function(BenchmarkId::new("sphere/f32", "one by one"), |b| {
        b.iter(|| {
            let all = |s: &Sphere| blocks(N).map(|block| count(s, block)).sum::<usize>();
            spheres.iter().map(all).sum::<usize>()
        });
    });
    group.bench_function(BenchmarkId::new("sphere/f32", "eight at once"), |b| {
        b.iter(|| {
            blocks(N)
                .map(|block| {
                    spheres
                        .iter()
                        .map(|s| count(s, block.clone()))
                        .sum::<usize>()
                })
                .sum::<usize>()
        });
    });
    group.finish();
}

fn kernels(criterion: &mut Criterion) {
    shapes::<f32>(criterion, "f32");
    shapes::<f64>(criterion, "f64");
    many_hypotheses(criterion);
}

criterion_group!(benches, kernels);
criterion_main!(benches);
