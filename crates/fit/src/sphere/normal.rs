//! The sums over points that a step of a sphere's geometric fit needs, in one pass.

use crate::RadiusPrior;
use nalgebra::{Matrix4, Point3, Vector4};
use pomona_geometry::Sphere;
use pulp::{Arch, Simd, WithSimd};

/// Points are copied, so many at a time, to where wide registers can read them.
const CHUNK: usize = 256;
/// Sums kept apart so that they can be added side by side. Their number is part of the result: it says in
/// which order is added, on every machine.
const LANES: usize = 4;
/// Upper half of Σ w u uᵀ, Σ w u, Σ w, Σ w u f, Σ w f, Σ w f²; then Σ w g, and the upper half of Σ w g u uᵀ,
/// where g = f/‖p − c‖.
const SUMS: usize = 22;

/// `JᵀWJ`, `−JᵀWf` and `fᵀWf` of the residuals f = ‖p − c‖ − r, whose derivatives are −(p − c)/‖p − c‖ and −1.
pub(super) struct NormalEquations {
    pub(super) matrix: Matrix4<f64>,
    pub(super) gradient: Vector4<f64>,
    /// What makes of `matrix` half the second derivatives of the objective: Σ w f ∇²f, where
    /// ∇²f = (1 − u uᵀ)/‖p − c‖ for the centre.
    pub(super) curvature: Matrix4<f64>,
    /// Sum of the weighted squared residuals.
    pub(super) objective: f64,
    /// How many points have a weight.
    pub(super) points: usize,
}

impl NormalEquations {
    /// Of points with their weights. One at the centre has no direction, and pulls at the radius alone.
    pub(super) fn new(points: impl Iterator<Item = (Point3<f64>, f64)>, sphere: &Sphere) -> Self {
        let arch = Arch::new();
        let mut sums = [[0.0; LANES]; SUMS];
        let mut chunk = Chunk::new();
        let mut used = 0;
        for (p, weight) in points {
            used += usize::from(weight != 0.0);
            chunk.push(p - sphere.center, weight);
            if chunk.filled == CHUNK {
                arch.dispatch(Pass(&chunk, sphere.radius, &mut sums));
                chunk.filled = 0;
            }
        }
        if chunk.filled > 0 {
            // What stands there from the chunk before weighs nothing now.
            chunk.weight[chunk.filled..].fill(0.0);
            arch.dispatch(Pass(&chunk, sphere.radius, &mut sums));
        }
        let sums = sums.map(|lane| (lane[0] + lane[1]) + (lane[2] + lane[3]));
        let [xx, xy, xz, yy, yz, zz, x, y, z, w, ..] = sums;
        let [.., xf, yf, zf, f, ff, g, gxx, gxy, gxz, gyy, gyz, gzz] = sums;
        #[rustfmt::skip]
        let matrix = Matrix4::new(
            xx, xy, xz, x,
            xy, yy, yz, y,
            xz, yz, zz, z,
            x,  y,  z,  w,
        );
        #[rustfmt::skip]
        let curvature = Matrix4::new(
            g - gxx, -gxy,    -gxz,    0.0,
            -gxy,    g - gyy, -gyz,    0.0,
            -gxz,    -gyz,    g - gzz, 0.0,
            0.0,     0.0,     0.0,     0.0,
        );
        Self {
            matrix,
            gradient: Vector4::new(xf, yf, zf, f),
            curvature,
            objective: ff,
            points: used,
        }
    }

    /// Adds the square of the radius's deviation from what is known of it.
    pub(super) fn add_prior(&mut self, prior: RadiusPrior, radius: f64) {
        let deviation = prior.deviation(radius);
        self.matrix[(3, 3)] += prior.sigma().powi(-2);
        self.gradient[3] -= deviation / prior.sigma();
        self.objective += deviation * deviation;
    }
}

/// Points as seen from the centre.
struct Chunk {
    x: [f64; CHUNK],
    y: [f64; CHUNK],
    z: [f64; CHUNK],
    weight: [f64; CHUNK],
    filled: usize,
}

impl Chunk {
    fn new() -> Self {
        let [x, y, z, weight] = [[0.0; CHUNK]; 4];
        Self {
            x,
            y,
            z,
            weight,
            filled: 0,
        }
    }

    #[inline]
    fn push(&mut self, offset: nalgebra::Vector3<f64>, weight: f64) {
        self.x[self.filled] = offset.x;
        self.y[self.filled] = offset.y;
        self.z[self.filled] = offset.z;
        self.weight[self.filled] = weight;
        self.filled += 1;
    }
}

/// Adds a chunk's share to the sums, by the widest registers there are; no multiplication is fused
/// with an addition, so every path adds the same numbers in the same order.
struct Pass<'a>(&'a Chunk, f64, &'a mut [[f64; LANES]; SUMS]);

impl WithSimd for Pass<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self(chunk, radius, total) = self;
        let mut sums = *total;
        for start in (0..CHUNK).step_by(LANES) {
            for lane in 0..LANES {
                let i = start + lane;
                let (x, y, z, w) = (chunk.x[i], chunk.y[i], chunk.z[i], chunk.weight[i]);
                let norm = (x * x + y * y + z * z).sqrt();
                let inverse = if norm > 0.0 { 1.0 / norm } else { 0.0 };
                let (x, y, z, f) = (x * inverse, y * inverse, z * inverse, norm - radius);
                let (wx, wy, wz, wf) = (w * x, w * y, w * z, w * f);
                let wg = wf * inverse;
                let (gx, gy) = (wg * x, wg * y);
                let terms = [
                    wx * x,
                    wx * y,
                    wx * z,
                    wy * y,
                    wy * z,
                    wz * z,
                    wx,
                    wy,
                    wz,
                    w,
                    wx * f,
                    wy * f,
                    wz * f,
                    wf,
                    wf * f,
                    wg,
                    gx * x,
                    gx * y,
                    gx * z,
                    gy * y,
                    gy * z,
                    wg * z * z,
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

    #[test]
    fn sums_are_those_of_the_definition_and_the_same_on_every_path() {
        let sphere = Sphere::new(Point3::new(0.1, -0.2, 0.8), 0.04).unwrap();
        let points: Vec<(Point3<f64>, f64)> = (0..1000)
            .map(|i| {
                let (a, b) = (f64::from(i) * 0.7, f64::from(i) * 1.3);
                let offset = nalgebra::Vector3::new(a.cos(), a.sin() * b.cos(), a.sin() * b.sin());
                let r = 0.04 + 0.001 * f64::from(i % 5);
                (sphere.center + offset * r, f64::from(i % 3))
            })
            .collect();
        let sums = NormalEquations::new(points.iter().copied(), &sphere);
        let (mut matrix, mut gradient, mut objective) = (Matrix4::zeros(), Vector4::zeros(), 0.0);
        let mut curvature = nalgebra::Matrix3::zeros();
        for (p, w) in &points {
            let u = (p - sphere.center).normalize();
            let f = sphere.signed_distance(p);
            let row = Vector4::new(u.x, u.y, u.z, 1.0);
            matrix += row * row.transpose() * *w;
            gradient += row * (f * w);
            objective += f * f * w;
            curvature += (nalgebra::Matrix3::identity() - u * u.transpose())
                * (w * f / (p - sphere.center).norm());
        }
        assert!((sums.matrix - matrix).amax() < 1e-9);
        assert!((sums.gradient - gradient).amax() < 1e-12);
        assert!((sums.curvature.fixed_view::<3, 3>(0, 0) - curvature).amax() < 1e-9);
        assert!((sums.objective - objective).abs() < 1e-12);

        let mut chunk = Chunk::new();
        for (p, w) in &points[..CHUNK] {
            chunk.push(p - sphere.center, *w);
        }
        let (mut wide, mut portable) = ([[0.0; LANES]; SUMS], [[0.0; LANES]; SUMS]);
        Arch::new().dispatch(Pass(&chunk, 0.04, &mut wide));
        Pass(&chunk, 0.04, &mut portable).with_simd(pulp::Scalar::new());
        assert_eq!(wide, portable);
    }

    #[test]
    fn a_point_at_the_center_pulls_at_the_radius() {
        let sphere = Sphere::new(Point3::origin(), 2.0).unwrap();
        let sums = NormalEquations::new([(Point3::origin(), 1.0)].into_iter(), &sphere);
        assert_eq!(sums.objective, 4.0);
        assert_eq!(sums.gradient, Vector4::new(0.0, 0.0, 0.0, -2.0));
    }
}
