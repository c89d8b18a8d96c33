//! The first two moments of points, in one pass over them.

use crate::points::centroid_and_extent;
use nalgebra::{Matrix3, Point3, Vector3};
use pulp::{Arch, Simd, WithSimd};

/// Points are copied, so many at a time, to where wide registers can read them.
const CHUNK: usize = 128;
/// Sums kept apart so that they can be added side by side. Their number is part of the result: it says in
/// which order is added, on every machine.
const LANES: usize = 4;
/// Σ w, Σ w q and the upper half of Σ w q qᵀ.
const SUMS: usize = 10;

/// Weight, centroid and scatter of points with weights.
///
/// Whatever is a sum of squares linear in the points, as the squared distance from a line is, depends on the
/// points through these alone.
pub(crate) struct Moments {
    pub(crate) centroid: Point3<f64>,
    /// Sum of the weights.
    pub(crate) weight: f64,
    /// Σ w (p − m)(p − m)ᵀ about the centroid m, lengths being in units of `unit`.
    pub(crate) scatter: Matrix3<f64>,
    unit: f64,
    /// How many points have a weight.
    pub(crate) points: usize,
}

impl Moments {
    /// `None` for no points, for points that coincide up to rounding, and where they are not finite.
    ///
    /// Sums are taken about the first point, which lies among the others, so that the distance from the origin costs
    /// no digits; and in the points' own extent where their squares leave the range of numbers.
    pub(crate) fn new(points: impl Iterator<Item = (Point3<f64>, f64)> + Clone) -> Option<Self> {
        let (origin, _) = points.clone().find(|&(_, weight)| weight != 0.0)?;
        let near = Self::about(points.clone(), origin, 1.0);
        if near.is_plain() {
            return near.determined();
        }
        let used = points.clone().filter(|&(_, weight)| weight != 0.0);
        let (centroid, extent) = centroid_and_extent(used.map(|(p, _)| p))?;
        Self::about(points, centroid, extent).determined()
    }

    /// Whether the sums kept their digits.
    fn is_plain(&self) -> bool {
        (1e-200..1e200).contains(&self.scatter.trace())
    }

    fn determined(self) -> Option<Self> {
        let spread = (self.scatter.trace() / self.weight).sqrt() * self.unit;
        let rounding = 8.0 * f64::EPSILON * self.centroid.coords.amax();
        // Written so that NaN refuses as well.
        (spread > rounding && spread.is_finite()).then_some(self)
    }

    fn about(
        points: impl Iterator<Item = (Point3<f64>, f64)>,
        origin: Point3<f64>,
        unit: f64,
    ) -> Self {
        let arch = Arch::new();
        let scale = 1.0 / unit;
        let mut sums = [[0.0; LANES]; SUMS];
        let mut chunk = Chunk([[0.0; CHUNK]; 4]);
        let (mut filled, mut used) = (0, 0);
        for (p, weight) in points {
            used += usize::from(weight != 0.0);
            let q = (p - origin) * scale;
            for (numbers, number) in chunk.0.iter_mut().zip([q.x, q.y, q.z, weight]) {
                numbers[filled] = number;
            }
            filled += 1;
            if filled == CHUNK {
                arch.dispatch(Pass(&chunk, &mut sums));
                filled = 0;
            }
        }
        if filled > 0 {
            for numbers in &mut chunk.0 {
                numbers[filled..].fill(0.0);
            }
            arch.dispatch(Pass(&chunk, &mut sums));
        }
        let [w, x, y, z, xx, xy, xz, yy, yz, zz] =
            sums.map(|lane| (lane[0] + lane[1]) + (lane[2] + lane[3]));
        let mean = Vector3::new(x, y, z) / w;
        let scatter =
            Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz) - mean * mean.transpose() * w;
        Self {
            centroid: origin + mean * unit,
            weight: w,
            scatter,
            unit,
            points: used,
        }
    }

    /// Six points with weights that have the same moments: what is minimised over them is what is
    /// minimised over all, whatever the number of these.
    pub(crate) fn stand_ins(&self) -> [(Point3<f64>, f64); 6] {
        let eigen = self.scatter.symmetric_eigen();
        std::array::from_fn(|k| {
            let (axis, sign) = (k / 2, if k % 2 == 0 { 1.0 } else { -1.0 });
            let away = (3.0 * eigen.eigenvalues[axis].max(0.0) / self.weight).sqrt();
            let offset = eigen.eigenvectors.column(axis) * (sign * away * self.unit);
            (self.centroid + offset, self.weight / 6.0)
        })
    }
}

/// Coordinates about the origin and weights.
struct Chunk([[f64; CHUNK]; 4]);

/// Adds a chunk's share to the sums, by the widest registers there are; no multiplication is fused
/// with an addition, so every path adds the same numbers in the same order.
struct Pass<'a>(&'a Chunk, &'a mut [[f64; LANES]; SUMS]);

impl WithSimd for Pass<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self(Chunk([xs, ys, zs, weights]), total) = self;
        let mut sums = *total;
        for start in (0..CHUNK).step_by(LANES) {
            for lane in 0..LANES {
                let i = start + lane;
                let (x, y, z, w) = (xs[i], ys[i], zs[i], weights[i]);
                let (wx, wy, wz) = (w * x, w * y, w * z);
                let terms = [
                    w,
                    wx,
                    wy,
                    wz,
                    wx * x,
                    wx * y,
                    wx * z,
                    wy * y,
                    wy * z,
                    wz * z,
                ];
                for (sum, term) in sums.iter_mut().zip(terms) {
                    sum[lane] += term;
                }
            }
        }
        *total = sums;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rod(n: i32, unit: f64) -> Vec<(Point3<f64>, f64)> {
        let wave = |i: i32, k: f64| (f64::from(i) * k).sin();
        (0..n)
            .map(|i| {
                let p = [10.0 + wave(i, 0.7), 0.3 * wave(i, 1.3), 0.01 * wave(i, 2.9)];
                (Point3::from(p.map(|c| c * unit)), f64::from(i % 3))
            })
            .collect()
    }

    #[test]
    fn moments_are_those_of_the_definition_in_any_unit() {
        for (n, unit) in [
            (3, 1.0),
            (128, 1.0),
            (1000, 1.0),
            (1000, 1e-160),
            (1000, 1e150),
        ] {
            let points = rod(n, unit);
            let moments = Moments::new(points.iter().copied()).unwrap();
            let weight: f64 = points.iter().map(|(_, w)| w).sum();
            let sum: Vector3<f64> = points.iter().map(|(p, w)| p.coords * *w).sum();
            let centroid = Point3::from(sum / weight);
            let scatter: Matrix3<f64> = points
                .iter()
                .map(|(p, w)| ((p - centroid) / unit, w))
                .map(|(q, w)| q * q.transpose() * *w)
                .sum();
            assert_eq!(moments.weight, weight);
            assert_eq!(
                moments.points,
                points.iter().filter(|(_, w)| *w > 0.0).count()
            );
            assert!((moments.centroid - centroid).amax() < 1e-12 * unit);
            let own = moments.unit / unit;
            assert!((moments.scatter * own * own - scatter).amax() < 1e-12 * scatter.amax());
        }
    }

    #[test]
    fn stand_ins_have_the_same_moments() {
        let moments = Moments::new(rod(500, 1.0).into_iter()).unwrap();
        let again = Moments::new(moments.stand_ins().into_iter()).unwrap();
        assert!((moments.centroid - again.centroid).amax() < 1e-14);
        assert!((moments.scatter - again.scatter).amax() < 1e-12);
        assert!((moments.weight - again.weight).abs() < 1e-10);
    }

    #[test]
    fn what_determines_nothing_has_none() {
        let p = Point3::new(0.3, 0.2, 0.1);
        assert!(Moments::new(std::iter::empty()).is_none());
        assert!(Moments::new([(p, 1.0); 7].into_iter()).is_none());
        assert!(Moments::new([(p, 0.0), (p + Vector3::x(), 0.0)].into_iter()).is_none());
        let nan = Point3::new(f64::NAN, 0.0, 0.0);
        assert!(Moments::new([(p, 1.0), (nan, 1.0)].into_iter()).is_none());
    }

    #[test]
    fn every_path_adds_the_same() {
        let chunk = Chunk(std::array::from_fn(|k| {
            std::array::from_fn(|i| ((i * 4 + k) as f64 * 1.7).sin())
        }));
        let (mut wide, mut portable) = ([[0.0; LANES]; SUMS], [[0.0; LANES]; SUMS]);
        Arch::new().dispatch(Pass(&chunk, &mut wide));
        Pass(&chunk, &mut portable).with_simd(pulp::Scalar::new());
        assert_eq!(wide, portable);
    }
}
