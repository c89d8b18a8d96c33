use crate::circle::CircleChart;
use crate::levenberg::{Condition, Objective};
use crate::{RadiusPrior, points::centroid_and_extent};
use nalgebra::Point3;
use pomona_geometry::Circle;

/// The circle with the least sum of squared distances of the points from it, near `start`.
///
/// [`circle_weighted`] with a weight of 1 for each point and no prior on the radius.
///
/// `None` for fewer than three points, for points that coincide and where anything is not finite.
pub fn circle_geometric(
    points: impl ExactSizeIterator<Item = Point3<f64>> + Clone,
    start: &Circle,
) -> Option<Circle> {
    circle_weighted(points.map(|p| (p, 1.0)), start, None)
}

/// The circle that minimises Σ wᵢ dist(pᵢ, circle)², plus ((r − mean)/sigma)² where a prior on the
/// radius is given, near `start`.
///
/// Weights are as for [`cylinder_weighted`](crate::cylinder_weighted). Levenberg–Marquardt on
/// two tangents of the normal, the centre and the radius (Ahn, Rauh and Warnecke 2001,
/// doi 10.1016/S0031-3203(00)00152-7); the distance has a part within the circle's plane and
/// one across it. The objective never grows, so the result is at least as good as `start`.
///
/// `None` for fewer than three points of positive weight, for points that coincide and where
/// anything is not finite.
pub fn circle_weighted(
    points: impl Iterator<Item = (Point3<f64>, f64)> + Clone,
    start: &Circle,
    prior: Option<RadiusPrior>,
) -> Option<Circle> {
    circle_held(points, start, prior, None)
}

/// [`circle_weighted`] among the circles that fulfil a condition, if one is given.
pub(crate) fn circle_held(
    points: impl Iterator<Item = (Point3<f64>, f64)> + Clone,
    start: &Circle,
    prior: Option<RadiusPrior>,
    condition: Option<&Condition<'_, Circle>>,
) -> Option<Circle> {
    let points = points.filter(|&(_, weight)| weight != 0.0);
    if points.clone().count() < 3 {
        return None;
    }
    centroid_and_extent(points.clone().map(|(p, _)| p))?;
    Objective { points, prior }.minimize::<CircleChart, 6, 2>(start, condition)
}
