use crate::{RadiusPrior, cylinder_weighted};
use nalgebra::Point3;
use pomona_geometry::{Cylinder, Line};
use std::f64::consts::FRAC_PI_4;

/// The cylinder whose visible side the points are, where a line through them and its radius are
/// roughly known.
///
/// A line fitted to the surface points of a branch lies between the camera and the axis: the points
/// seen are nearer than the axis by √(r² − x²), x being their offset to the side, of which
/// the mean is πr/4. So the axis is sought behind the line as seen from `viewpoint`, from three starts with
/// radii of the prior's mean and one standard deviation to either side, and the best of the refits by
/// [`cylinder_weighted`] is taken. Its direction is free to leave the line's.
///
/// Each item is a point and its weight, 1/σ² of its noise (times a robust weight, if any).
/// `line` and `viewpoint` (the camera's centre) are in the points' frame.
///
/// `None` for fewer than four points of positive weight, for points that coincide, where the line passes through
/// the viewpoint (nearer than 1e-9 of their distance), and where anything is not finite.
#[expect(
    clippy::needless_pass_by_value,
    reason = "an iterator is taken whole, as by the other solvers"
)]
pub fn cylinder_near_line(
    points: impl Iterator<Item = (Point3<f64>, f64)> + Clone,
    line: &Line,
    viewpoint: &Point3<f64>,
    prior: RadiusPrior,
) -> Option<Cylinder> {
    let (sum, weight) = points
        .clone()
        .fold((nalgebra::Vector3::zeros(), 0.0), |(sum, total), (p, w)| {
            (sum + p.coords * w, total + w)
        });
    let foot = line.foot(&Point3::from(sum / weight));
    let sight = foot - viewpoint;
    let away = sight - line.direction.into_inner() * sight.dot(&line.direction);
    // Written so that NaN refuses as well.
    if !(away.norm() > 1e-9 * sight.norm()) {
        return None;
    }
    let away = away.normalize();
    let objective = |cylinder: &Cylinder| {
        let squares = points
            .clone()
            .map(|(p, w)| w * cylinder.signed_distance(&p).powi(2));
        squares.sum::<f64>() + prior.deviation(cylinder.radius).powi(2)
    };
    [0.0, -1.0, 1.0]
        .into_iter()
        .filter_map(|deviation| {
            let radius = prior.mean() + deviation * prior.sigma();
            let axis = Line::new(
                foot + away * (radius * FRAC_PI_4),
                line.direction.into_inner(),
            )?;
            let start = Cylinder::new(axis, radius)?;
            let fit = cylinder_weighted(points.clone(), &start, Some(prior))?;
            Some((fit, objective(&fit)))
        })
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .map(|(fit, _)| fit)
}
