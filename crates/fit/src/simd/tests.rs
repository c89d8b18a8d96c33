use super::*;
use crate::cylinder::pipe;
use crate::line::Tube;
use crate::plane::Slab;
use crate::sphere::shell;
use nalgebra::{Point3, Vector3};
use pomona_geometry::{Cylinder, Line, Plane, Sphere};
use pulp::Scalar;

/// Points at a distance of `radius` ± 10 mm from an origin, an axis along z or a plane across z, within some units
/// of the last place of f32, and some far off.
fn near_the_threshold(n: u32, at: impl Fn([f64; 3], f64) -> [f64; 3]) -> [Vec<f64>; 3] {
    let point = |i: u32| {
        let (a, b) = (f64::from(i) * 0.618, f64::from(i) * 0.414);
        let direction = [a.cos() * b.cos(), a.sin() * b.cos(), b.sin()];
        let threshold = if i.is_multiple_of(2) { 0.01 } else { -0.01 };
        let off = if i.is_multiple_of(5) {
            f64::from(i % 97) * 2e-4 - 0.01
        } else {
            threshold + f64::from(i % 7) * 1e-8 - 3e-8
        };
        at(direction, off)
    };
    let points: Vec<_> = (0..n).map(point).collect();
    [0, 1, 2].map(|k| points.iter().map(|p| p[k]).collect())
}

/// All operations, dispatched and not, over blocks of an odd length.
fn compare<T: Coordinate>(points: &[Vec<T>; 3], kernel: impl Kernel<T>) {
    let n = points[0].len();
    let mut all = 0;
    for start in (0..n).step_by(1021) {
        let r = start..(start + 1021).min(n);
        let [x, y, z] = [0, 1, 2].map(|k| &points[k][r.clone()]);
        let block = (x, y, z);
        let counted = count(block, kernel);
        let narrow = Count { block, kernel }.with_simd(Scalar::new()) as usize;
        assert_eq!(counted, narrow, "count {r:?}");

        let gained = gain(block, kernel);
        let narrow = Gain { block, kernel }.with_simd(Scalar::new());
        assert_eq!(gained.to_bits(), narrow.to_bits(), "gain {r:?}");
        assert!(0.0 <= gained && gained <= counted as f64);

        let (mut selected, mut narrow) = (Vec::new(), Vec::new());
        select(block, start, kernel, &mut selected);
        let out = &mut narrow;
        Select {
            block,
            first: start,
            kernel,
            out,
        }
        .with_simd(Scalar::new());
        assert_eq!(selected, narrow, "selection {r:?}");
        let held = r.clone().filter(|&i| {
            let i = i - start;
            kernel.holds(x[i], y[i], z[i])
        });
        assert!(selected.iter().copied().eq(held) && selected.len() == counted);
        all += counted;
    }
    assert!(
        all > n / 10 && all < n - n / 10,
        "{all} of {n}: off the threshold"
    );
}

fn compare_both<W: Kernel<f64>, N: Kernel<f32>>(points: &[Vec<f64>; 3], wide: W, narrow: N) {
    compare(points, wide);
    let rounded = [0, 1, 2].map(|k| points[k].iter().map(|&c| c as f32).collect::<Vec<f32>>());
    compare(&rounded, narrow);
}

#[test]
fn every_path_computes_the_same_bits() {
    const N: u32 = 1_000_000;
    let center = Point3::new(0.1, -0.2, 0.8);
    let origin = [center.x, center.y, center.z];
    let add = |p: [f64; 3]| [0, 1, 2].map(|k| p[k] + origin[k]);

    let sphere = Sphere::new(center, 0.04).unwrap();
    let points = near_the_threshold(N, |d, off| add(d.map(|c| c * (0.04 + off))));
    compare_both(&points, shell(&sphere, 0.01), shell(&sphere, 0.01));

    let axis = Line::new(center, Vector3::z()).unwrap();
    let about = |radius: f64| {
        move |[x, y, z]: [f64; 3], off: f64| {
            let scale = (radius + off) / x.hypot(y).max(1e-9);
            add([x * scale, y * scale, z])
        }
    };
    let points = near_the_threshold(N, about(0.0));
    compare_both(&points, Tube::new(&axis, 0.01), Tube::new(&axis, 0.01));

    let cylinder = Cylinder::new(axis, 0.02).unwrap();
    let points = near_the_threshold(N, about(0.02));
    compare_both(&points, pipe(&cylinder, 0.01), pipe(&cylinder, 0.01));

    let plane = Plane::new(center, Vector3::z()).unwrap();
    let points = near_the_threshold(N, |[x, y, _], off| add([x, y, off]));
    compare_both(&points, Slab::new(&plane, 0.01), Slab::new(&plane, 0.01));
}

#[test]
fn points_that_are_not_finite_gain_nothing() {
    let line = Line::new(Point3::origin(), Vector3::x()).unwrap();
    let bad = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 0.0];
    let zero = [0.0_f32; 4];
    let sphere = Sphere::new(Point3::origin(), 1.0).unwrap();
    for threshold in [f64::INFINITY, f64::NAN, -1.0, 0.5] {
        assert!(gain((&zero, &bad, &zero), Tube::new(&line, threshold)) <= 4.0);
        assert!(gain((&zero, &bad, &zero), shell(&sphere, threshold)) <= 4.0);
    }
    assert_eq!(gain((&zero, &bad, &zero), Tube::new(&line, 0.5)), 1.0);
    assert_eq!(gain((&zero, &bad, &zero), shell(&sphere, 0.5)), 0.0);
}
