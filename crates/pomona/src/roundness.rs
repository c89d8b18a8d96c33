//! How round a surface is, whatever sphere was laid through it.

use nalgebra::{Matrix2, Matrix6, Point3, Vector3, Vector6};
use pomona_geometry::Sphere;

/// The lesser of a surface's two principal curvatures as a share of a sphere's: 1 for the sphere itself, 0 for a cylinder
/// and for a plane, negative for a saddle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Roundness {
    pub(crate) least: f64,
    /// Its standard deviation.
    pub(crate) least_sd: f64,
}

/// Points farther over the sphere's visible cap than this are left out, as a cosine: their tangential
/// coordinates hardly differ while their height does.
const CAP_COSINE: f64 = 0.45;

impl Roundness {
    /// Of the points near `sphere`, with noise `sigma` (metres) across the surface.
    ///
    /// With u, v the tangential coordinates about the cap's middle and e the distance from the sphere, all in radii, the
    /// quadric e = a + bu + cv + du² + fuv + gv² is fitted by least squares. A sphere has the height
    /// 1 − (u² + v²)/2 in second order, so that the surface's curvature is the identity less the Hessian of e, exactly 1
    /// where e is flat. What the points do not determine has a large standard deviation.
    ///
    /// `None` for fewer than 8 points.
    pub(crate) fn of(
        points: impl Iterator<Item = Point3<f64>> + Clone,
        sphere: &Sphere,
        sigma: f64,
    ) -> Option<Self> {
        let r = sphere.radius;
        let mean: Vector3<f64> = points
            .clone()
            .filter_map(|p| (p - sphere.center).try_normalize(1e-9))
            .sum();
        let n = mean.try_normalize(1e-9)?;
        let e1 = n.cross(&Vector3::y()).try_normalize(1e-6)?;
        let e2 = n.cross(&e1);
        let (mut a, mut b, mut count) = (Matrix6::zeros(), Vector6::zeros(), 0usize);
        let mut squares = 0.0;
        for p in points {
            let q = (p - sphere.center) / r;
            if q.dot(&n) < CAP_COSINE {
                continue;
            }
            let (u, v, e) = (q.dot(&e1), q.dot(&e2), q.norm() - 1.0);
            let row = Vector6::new(1.0, u, v, u * u, u * v, v * v);
            a += row * row.transpose();
            b += row * e;
            squares += e * e;
            count += 1;
        }
        if count < 8 {
            return None;
        }
        // Curvatures are known to within a few spheres' beforehand, which keeps the system regular.
        let noise = sigma / r;
        for k in 3..6 {
            a[(k, k)] += noise * noise / 4.0;
        }
        a[(0, 0)] += 1e-9;
        let inverse = a.cholesky()?.inverse();
        let x = inverse * b;
        // What is left is noise too, leaves among it.
        let left = ((squares - x.dot(&b)).max(0.0) / (count - 6).max(1) as f64).sqrt();
        let noise = noise.max(left);
        let hessian = Matrix2::new(2.0 * x[3], x[4], x[4], 2.0 * x[5]);
        let eigen = hessian.symmetric_eigen();
        let high = eigen.eigenvalues.imax();
        let d = eigen.eigenvectors.column(high);
        let (c, s) = (d[0], d[1]);
        let along = Vector6::new(0.0, 0.0, 0.0, 2.0 * c * c, 2.0 * c * s, 2.0 * s * s);
        Some(Self {
            least: 1.0 - eigen.eigenvalues[high],
            least_sd: noise * along.dot(&(inverse * along)).max(0.0).sqrt(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Readings of `surface` (depth in radii by tangential place) before a sphere about (0, 0, 1).
    fn of(surface: impl Fn(f64, f64) -> f64) -> Roundness {
        let sphere = Sphere::new(Point3::new(0.0, 0.0, 1.0), 1.0).unwrap();
        let grid = (0..15).flat_map(|i| (0..15).map(move |j| (i, j)));
        let points: Vec<Point3<f64>> = grid
            .map(|(i, j)| (f64::from(i - 7) / 14.0, f64::from(j - 7) / 14.0))
            .map(|(u, v)| Point3::new(u, v, surface(u, v)))
            .collect();
        Roundness::of(points.iter().copied(), &sphere, 0.01).unwrap()
    }

    #[test]
    fn a_sphere_is_round_and_a_cylinder_and_a_plane_are_not() {
        let near = |a: f64, b: f64| (a - b).abs() < 0.12;
        let sphere = of(|u, v| 1.0 - (1.0 - u * u - v * v).sqrt());
        assert!(near(sphere.least, 1.0), "{sphere:?}");
        let cylinder = of(|u, _| 1.0 - (1.0 - u * u).sqrt());
        assert!(near(cylinder.least, 0.0), "{cylinder:?}");
        let plane = of(|u, _| 0.1 * u);
        assert!(near(plane.least, 0.0), "{plane:?}");
        assert!(of(|u, v| 0.5 * (u * u - v * v)).least < -0.5, "a saddle");
    }

    #[test]
    fn a_small_patch_does_not_know() {
        let sphere = Sphere::new(Point3::new(0.0, 0.0, 1.0), 1.0).unwrap();
        let grid = (0..25).map(|i| (f64::from(i % 5 - 2) * 0.02, f64::from(i / 5 - 2) * 0.02));
        let points = grid.map(|(u, v)| Point3::new(u, v, 0.0));
        let roundness = Roundness::of(points, &sphere, 0.05).unwrap();
        assert!(roundness.least_sd > 1.0, "{roundness:?}");
        assert!(Roundness::of(std::iter::empty(), &sphere, 0.05).is_none());
    }
}
