//! The sums over points that a step of a sphere's geometric fit needs, in one pass.

use crate::RadiusPrior;
use nalgebra::{Matrix4, Point3, Vector4};
use pomona_geometry::Sphere;
use pulp::{Arch, Simd, WithSimd};

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
}

impl NormalEquations {
    /// Of points with their weights. One at the centre has no direction, and pulls at the radius alone.
    pub(super) fn new(points: &Gathered, sphere: &Sphere) -> Self {
        let mut sums = [[0.0; LANES]; SUMS];
        Arch::new().dispatch(Pass {
            groups: &points.groups,
            sphere,
            sums: &mut sums,
        });
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

/// Points with weights, copied once to where every step reads them by wide registers.
pub(super) struct Gathered {
    groups: Vec<Group>,
    /// How many points have a weight.
    pub(super) points: usize,
}

/// x, y, z and weight of as many points as there are lanes; those that are none weigh nothing.
type Group = [[f64; LANES]; 4];

impl Gathered {
    pub(super) fn new(points: impl Iterator<Item = (Point3<f64>, f64)>) -> Self {
        let mut groups = Vec::with_capacity(points.size_hint().0.div_ceil(LANES));
        let mut used = 0;
        let mut group = [[0.0; LANES]; 4];
        let mut filled = 0;
        for (p, weight) in points {
            used += usize::from(weight != 0.0);
            for (numbers, number) in group.iter_mut().zip([p.x, p.y, p.z, weight]) {
                numbers[filled] = number;
            }
            filled += 1;
            if filled == LANES {
                groups.push(group);
                filled = 0;
            }
        }
        if filled > 0 {
            group[3][filled..].fill(0.0);
            groups.push(group);
        }
        Self {
            groups,
            points: used,
        }
    }
}

/// Adds the points' shares to the sums, by the widest registers there are; no multiplication is fused
/// with an addition, so every path adds the same numbers in the same order.
struct Pass<'a> {
    groups: &'a [Group],
    sphere: &'a Sphere,
    sums: &'a mut [[f64; LANES]; SUMS],
}

impl WithSimd for Pass<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self {
            groups,
            sphere,
            sums: total,
        } = self;
        let (cx, cy, cz) = (sphere.center.x, sphere.center.y, sphere.center.z);
        let radius = sphere.radius;
        let mut sums = *total;
        for [xs, ys, zs, weights] in groups {
            for lane in 0..LANES {
                let (x, y, z) = (xs[lane] - cx, ys[lane] - cy, zs[lane] - cz);
                let w = weights[lane];
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
        let sums = NormalEquations::new(&Gathered::new(points.iter().copied()), &sphere);
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

        let gathered = Gathered::new(points.iter().copied());
        let (mut wide, mut portable) = ([[0.0; LANES]; SUMS], [[0.0; LANES]; SUMS]);
        let groups = &gathered.groups;
        let pass = |sums| Pass {
            groups,
            sphere: &sphere,
            sums,
        };
        Arch::new().dispatch(pass(&mut wide));
        pass(&mut portable).with_simd(pulp::Scalar::new());
        assert_eq!(wide, portable);
    }

    #[test]
    fn a_point_at_the_center_pulls_at_the_radius() {
        let sphere = Sphere::new(Point3::origin(), 2.0).unwrap();
        let sums = NormalEquations::new(
            &Gathered::new([(Point3::origin(), 1.0)].into_iter()),
            &sphere,
        );
        assert_eq!(sums.objective, 4.0);
        assert_eq!(sums.gradient, Vector4::new(0.0, 0.0, 0.0, -2.0));
    }
}
