use nalgebra::{Matrix4, Point3, Vector4};
use pomona_geometry::Sphere;

/// The sphere with the least sum of squared distances of the points from its surface:
/// minimises Σ (‖p − c‖ − r)², starting from `start`.
///
/// Levenberg–Marquardt on the centre and radius (Ahn, Rauh and Warnecke 2001, "Least-squares
/// orthogonal distances fitting of circle, sphere, ellipse, hyperbola, and parabola",
/// doi 10.1016/S0031-3203(00)00152-7, section 2). The sum never grows from one step to the next, so
/// the result is at least as good as `start`. Points at the centre have no direction
/// and are left out of a step.
///
/// `None` for fewer than four points and where anything is not finite.
#[expect(
    clippy::needless_pass_by_value,
    reason = "an iterator is taken whole, as by the other solvers"
)]
pub fn sphere_geometric(
    points: impl ExactSizeIterator<Item = Point3<f64>> + Clone,
    start: &Sphere,
) -> Option<Sphere> {
    const MAX_STEPS: usize = 100;
    if points.len() < 4 {
        return None;
    }
    let mut sphere = *start;
    let mut objective = sum_of_squares(points.clone(), &sphere);
    if !objective.is_finite() {
        return None;
    }
    let mut damping = 1e-6;
    for _ in 0..MAX_STEPS {
        let (normal, gradient) = normal_equations(points.clone(), &sphere);
        let mut improved = None;
        // Damping grows until a step goes down; at 1e12 no step is left to take.
        while damping < 1e12 {
            let mut damped = normal;
            for k in 0..4 {
                damped[(k, k)] += damping * normal[(k, k)].max(f64::MIN_POSITIVE);
            }
            let candidate = damped
                .cholesky()
                .and_then(|c| stepped(&sphere, &c.solve(&gradient)));
            if let Some(candidate) = candidate {
                let sum = sum_of_squares(points.clone(), &candidate);
                if sum <= objective {
                    improved = Some((candidate, sum));
                    break;
                }
            }
            damping *= 10.0;
        }
        let Some((candidate, sum)) = improved else {
            break;
        };
        let moved = (candidate.center - sphere.center)
            .norm()
            .max((candidate.radius - sphere.radius).abs());
        sphere = candidate;
        objective = sum;
        damping = (damping / 10.0).max(1e-12);
        if moved <= 1e-14 * (sphere.radius + sphere.center.coords.norm()) {
            break;
        }
    }
    Some(sphere)
}

fn stepped(sphere: &Sphere, step: &Vector4<f64>) -> Option<Sphere> {
    Sphere::new(
        sphere.center + step.fixed_rows::<3>(0),
        sphere.radius + step[3],
    )
}

fn sum_of_squares(points: impl Iterator<Item = Point3<f64>>, sphere: &Sphere) -> f64 {
    points.map(|p| sphere.signed_distance(&p).powi(2)).sum()
}

/// `JᵀJ` and `−Jᵀf` of the residuals f = ‖p − c‖ − r, whose derivatives are −(p − c)/‖p − c‖ and −1.
fn normal_equations(
    points: impl Iterator<Item = Point3<f64>>,
    sphere: &Sphere,
) -> (Matrix4<f64>, Vector4<f64>) {
    let mut normal = Matrix4::zeros();
    let mut gradient = Vector4::zeros();
    for p in points {
        let offset = p - sphere.center;
        let norm = offset.norm();
        if norm == 0.0 {
            continue;
        }
        let u = offset / norm;
        let row = Vector4::new(u.x, u.y, u.z, 1.0);
        normal += row * row.transpose();
        gradient += row * (norm - sphere.radius);
    }
    (normal, gradient)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_shells_balance_at_the_mean_radius() {
        // Octahedra of radius 1 and 2 about the origin: distances balance at 1.5, where the
        // linear fit takes the root of the mean square.
        let corners: Vec<Point3<f64>> = (0..12)
            .map(|i| {
                let mut p = Point3::origin();
                p[i % 3] = if i % 2 == 0 { 1.0 } else { -1.0 } * if i < 6 { 1.0 } else { 2.0 };
                p
            })
            .collect();
        let start = Sphere::new(Point3::new(0.2, -0.1, 0.1), 3.0).unwrap();
        let sphere = sphere_geometric(corners.iter().copied(), &start).unwrap();
        assert!(sphere.center.coords.norm() < 1e-9, "{sphere:?}");
        assert!((sphere.radius - 1.5).abs() < 1e-9, "{sphere:?}");
    }

    #[test]
    fn nothing_to_refine() {
        let start = Sphere::new(Point3::origin(), 1.0).unwrap();
        assert!(sphere_geometric(std::iter::empty(), &start).is_none());
        let nan = [Point3::new(f64::NAN, 0.0, 0.0); 5];
        assert!(sphere_geometric(nan.into_iter(), &start).is_none());
    }

    #[test]
    fn equal_points_neither_panic_nor_worsen() {
        let start = Sphere::new(Point3::origin(), 1.0).unwrap();
        let same = [Point3::new(3.0, 0.0, 0.0); 9];
        let sphere = sphere_geometric(same.into_iter(), &start).unwrap();
        assert!(sphere.signed_distance(&same[0]).abs() <= 2.0);
    }
}
