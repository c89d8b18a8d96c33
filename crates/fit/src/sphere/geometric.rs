use crate::RadiusPrior;
use crate::levenberg::{Condition, Objective};
use crate::sphere::SphereChart;
use crate::sphere::normal::{Gathered, NormalEquations};
use nalgebra::{Matrix4, Point3, Vector4};
use pomona_geometry::Sphere;

/// The sphere with the least sum of squared distances of the points from its surface:
/// minimises Σ (‖p − c‖ − r)², starting from `start`.
///
/// [`sphere_weighted`] with a weight of 1 for each point and no prior on the radius.
///
/// `None` for fewer than four points and where anything is not finite.
pub fn sphere_geometric(
    points: impl ExactSizeIterator<Item = Point3<f64>> + Clone,
    start: &Sphere,
) -> Option<Sphere> {
    sphere_weighted(points.map(|p| (p, 1.0)), start, None)
}

/// The sphere that minimises Σ wᵢ (‖pᵢ − c‖ − r)², plus ((r − mean)/sigma)² where a prior on the
/// radius is given, near `start`.
///
/// Each item is a point and its weight, not negative: 1/σ² of the point's noise σ across the
/// surface, times whatever a robust loss makes of it. With a prior the weights must have that
/// unit; without one only their ratios matter. Points of zero weight are left out.
///
/// Newton's method on the centre and radius, damped as by Levenberg and Marquardt; residuals as in
/// Ahn, Rauh and Warnecke 2001, "Least-squares orthogonal distances fitting of circle, sphere, ellipse,
/// hyperbola, and parabola", doi 10.1016/S0031-3203(00)00152-7, section 2. On a small cap Gauss–Newton
/// steps, without the second derivatives, are three times as many. The sum never grows from one step
/// to the next, so the result is at least as good as `start`. It ends with a step that
/// leaves less than 10⁻⁸ of the radius to go. A point at the centre has no direction, and pulls at the
/// radius alone.
///
/// `None` for fewer than four points of positive weight (three with a prior) and where anything is not finite.
pub fn sphere_weighted(
    points: impl Iterator<Item = (Point3<f64>, f64)> + Clone,
    start: &Sphere,
    prior: Option<RadiusPrior>,
) -> Option<Sphere> {
    sphere_held(points, start, prior, None)
}

/// [`sphere_weighted`] among the spheres that fulfil a condition, if one is given.
pub(crate) fn sphere_held(
    points: impl Iterator<Item = (Point3<f64>, f64)> + Clone,
    start: &Sphere,
    prior: Option<RadiusPrior>,
    condition: Option<&Condition<'_, Sphere>>,
) -> Option<Sphere> {
    if condition.is_none() {
        return newton(points, start, prior);
    }
    let points = points.filter(|&(_, weight)| weight != 0.0);
    if points.clone().count() + usize::from(prior.is_some()) < 4 {
        return None;
    }
    Objective { points, prior }.minimize::<SphereChart, 4, 1>(start, condition)
}

/// [`sphere_weighted`], among all spheres.
fn newton(
    points: impl Iterator<Item = (Point3<f64>, f64)>,
    start: &Sphere,
    prior: Option<RadiusPrior>,
) -> Option<Sphere> {
    const MAX_STEPS: usize = 100;
    const CONVERGED: f64 = 1e-7;
    let points = Gathered::new(points);
    if points.points + usize::from(prior.is_some()) < 4 {
        return None;
    }
    let equations = |sphere: &Sphere| {
        let mut equations = NormalEquations::new(&points, sphere);
        if let Some(prior) = prior {
            equations.add_prior(prior, sphere.radius);
        }
        equations
    };
    let mut sphere = *start;
    let mut current = equations(&sphere);
    if !current.objective.is_finite() {
        return None;
    }
    let mut damping = 1e-6;
    for _ in 0..MAX_STEPS {
        let mut improved = false;
        let mut moved = f64::INFINITY;
        // Damping grows until a step goes down, or is too short to matter.
        while !improved && damping < 1e12 && moved > CONVERGED * sphere.radius {
            if let Some(step) = damped_step(&current, damping) {
                moved = step.amax();
                if let Some(candidate) = stepped(&sphere, &step) {
                    if is_last(&current, &step, damping, sphere.radius) {
                        return Some(candidate);
                    }
                    let next = equations(&candidate);
                    improved = next.objective <= current.objective;
                    if improved {
                        (sphere, current) = (candidate, next);
                    }
                }
            }
            damping *= if improved { 0.1 } else { 10.0 };
        }
        damping = damping.max(1e-12);
        if !improved || moved <= CONVERGED * sphere.radius {
            break;
        }
    }
    Some(sphere)
}

/// A step by the second derivatives where these curve upwards, and by their positive part otherwise.
fn damped_step(equations: &NormalEquations, damping: f64) -> Option<Vector4<f64>> {
    let NormalEquations {
        matrix, curvature, ..
    } = equations;
    let damp = |mut m: Matrix4<f64>| {
        for k in 0..4 {
            m[(k, k)] += damping * matrix[(k, k)].max(f64::MIN_POSITIVE);
        }
        m.cholesky()
    };
    let damped = damp(matrix + curvature).or_else(|| damp(*matrix))?;
    Some(damped.solve(&equations.gradient))
}

/// Whether a step leaves less than 10⁻⁸ of the radius to go, so that no other pass over the points is needed.
///
/// With λ the curvature along the step s, W the sum of the weights and 10 W/r a bound of the third derivatives where
/// points lie about the surface, what is left is at most (10 W/r) |s|²/2λ, and the damping's share. The
/// sum cannot have grown then: the fall of λ|s|²/2 exceeds what third derivatives can add.
fn is_last(equations: &NormalEquations, step: &Vector4<f64>, damping: f64, radius: f64) -> bool {
    const LEFT: f64 = 1e-8;
    let weight = equations.matrix[(3, 3)];
    let length = step.norm();
    let curvature = step.dot(&equations.gradient) / (length * length);
    // Written so that NaN and a step uphill refuse.
    curvature > 0.0
        && weight * length * (5.0 * length / radius + damping) <= LEFT * radius * curvature
}

fn stepped(sphere: &Sphere, step: &Vector4<f64>) -> Option<Sphere> {
    Sphere::new(
        sphere.center + step.fixed_rows::<3>(0),
        sphere.radius + step[3],
    )
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
