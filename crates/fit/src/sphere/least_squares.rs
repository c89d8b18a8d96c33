use crate::points::centroid_and_extent;
use faer::Mat;
use faer::linalg::solvers::SolveLstsqCore;
use nalgebra::Point3;
use pomona_geometry::Sphere;

/// The sphere of linear least squares: minimises Σ (x² + y² + z² − Ax − By − Cz + D)².
///
/// Then a = A/2, b = B/2, c = C/2 are the centre and r² = a² + b² + c² − D (Gao et al.
/// 2022, Eqs. 3–7, doi 10.3390/agriculture12081170). The system is solved by a QR
/// decomposition with column pivoting in coordinates shifted to the centroid and scaled
/// to the points' extent, which changes no digit of the exact solution and saves those of
/// the computed one.
///
/// `None` for fewer than four points, for points in one plane (the least pivot under 1e-9 of
/// the largest), and where anything is not finite. On a small cap with noise this
/// fit is biased towards small radii; [`sphere_geometric`](crate::sphere_geometric) is not.
pub fn sphere_least_squares(
    points: impl ExactSizeIterator<Item = Point3<f64>> + Clone,
) -> Option<Sphere> {
    let n = points.len();
    if n < 4 {
        return None;
    }
    let (centroid, extent) = centroid_and_extent(points.clone())?;
    let mut a = Mat::zeros(n, 4);
    let mut rhs = Mat::zeros(n, 1);
    for (i, p) in points.enumerate() {
        let q = (p - centroid) / extent;
        for k in 0..3 {
            a[(i, k)] = q[k];
        }
        a[(i, 3)] = 1.0;
        rhs[(i, 0)] = q.norm_squared();
    }
    let qr = a.col_piv_qr();
    let r = qr.thin_R();
    let pivot = |k| f64::abs(r[(k, k)]);
    // Written so that NaN refuses as well.
    if !(pivot(3) > 1e-9 * pivot(0)) {
        return None;
    }
    qr.solve_lstsq_in_place_with_conj(faer::Conj::No, rhs.as_mut());
    let half = nalgebra::Vector3::new(rhs[(0, 0)], rhs[(1, 0)], rhs[(2, 0)]) / 2.0;
    let squared_radius = half.norm_squared() + rhs[(3, 0)];
    Sphere::new(centroid + half * extent, squared_radius.sqrt() * extent)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn matches_a_solution_by_hand() {
        // Six points on two spheres about the origin, in pairs: the fit is the mean of the squared radii.
        let r = [1.0, 1.0, 2.0, 2.0, 3.0, 3.0];
        let p = (0..6).map(|i| {
            let mut p = Point3::origin();
            p[i / 2] = if i % 2 == 0 { r[i] } else { -r[i] };
            p
        });
        let sphere = sphere_least_squares(p.collect::<Vec<_>>().into_iter()).unwrap();
        assert!(sphere.center.coords.norm() < 1e-12);
        assert!((sphere.radius - f64::sqrt(14.0 / 3.0)).abs() < 1e-12);
    }

    #[test]
    fn degenerate_sets_give_no_sphere() {
        let grid = (0..20).map(|i| Point3::new(f64::from(i % 5), f64::from(i / 5), 3.0));
        assert!(sphere_least_squares(grid).is_none(), "coplanar");
        assert!(sphere_least_squares((0..9).map(|_| Point3::new(0.1, 0.2, 0.3))).is_none());
        assert!(
            sphere_least_squares((0..3).map(|i| Point3::new(f64::from(i), 0.0, 1.0))).is_none()
        );
        let nan = (0..9).map(|i| Point3::new(f64::from(i).sin(), f64::from(i).cos(), f64::NAN));
        assert!(sphere_least_squares(nan).is_none());
    }
}
