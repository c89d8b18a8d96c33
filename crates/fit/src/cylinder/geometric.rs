use crate::cylinder::CylinderChart;
use crate::levenberg::{Condition, Objective};
use crate::{RadiusPrior, points::centroid_and_extent};
use nalgebra::Point3;
use pomona_geometry::{Cylinder, Line};

/// The cylinder with the least sum of squared distances of the points from its surface, near `start`.
///
/// [`cylinder_weighted`] with a weight of 1 for each point and no prior on the radius.
///
/// `None` for fewer than five points, for points that coincide and where anything is not finite.
pub fn cylinder_geometric(
    points: impl ExactSizeIterator<Item = Point3<f64>> + Clone,
    start: &Cylinder,
) -> Option<Cylinder> {
    cylinder_weighted(points.map(|p| (p, 1.0)), start, None)
}

/// The cylinder that minimises Σ wᵢ (dist(pᵢ, axis) − r)², plus ((r − mean)/sigma)² where a prior
/// on the radius is given, near `start`.
///
/// Each item is a point and its weight, not negative: 1/σ² of the point's noise σ across the
/// surface, times whatever a robust loss makes of it. With a prior the weights must have that
/// unit; without one only their ratios matter. Points of zero weight are left out.
///
/// Levenberg–Marquardt on two tangents of the direction, two offsets of the axis and the radius (Lukács,
/// Martin and Marshall 1998, "Faithful least-squares fitting of spheres, cylinders, cones and
/// tori", doi 10.1007/BFb0055697). The distance is the geometric one, so the fit has no bias towards
/// small radii when only one side of the surface is seen; where the side seen is so narrow that the
/// points cannot tell the radius, the prior does. The objective never grows, so the result is at
/// least as good as `start`. The axis's point is the foot of the points' centroid.
///
/// `None` for fewer than five points of positive weight (four with a prior), for points that
/// coincide and where anything is not finite.
pub fn cylinder_weighted(
    points: impl Iterator<Item = (Point3<f64>, f64)> + Clone,
    start: &Cylinder,
    prior: Option<RadiusPrior>,
) -> Option<Cylinder> {
    cylinder_held(points, start, prior, None)
}

/// [`cylinder_weighted`] among the cylinders that fulfil a condition, if one is given.
pub(crate) fn cylinder_held(
    points: impl Iterator<Item = (Point3<f64>, f64)> + Clone,
    start: &Cylinder,
    prior: Option<RadiusPrior>,
    condition: Option<&Condition<'_, Cylinder>>,
) -> Option<Cylinder> {
    let points = points.filter(|&(_, weight)| weight != 0.0);
    if points.clone().count() + usize::from(prior.is_some()) < 5 {
        return None;
    }
    let (centroid, _) = centroid_and_extent(points.clone().map(|(p, _)| p))?;
    // About the centroid direction and offset hardly depend on each other.
    let axis = Line {
        point: start.axis.foot(&centroid),
        ..start.axis
    };
    let start = Cylinder { axis, ..*start };
    let objective = Objective { points, prior };
    let cylinder = objective.minimize::<CylinderChart, 5, 1>(&start, condition)?;
    let axis = Line {
        point: cylinder.axis.foot(&centroid),
        ..cylinder.axis
    };
    Some(Cylinder { axis, ..cylinder })
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;

    #[test]
    fn two_shells_balance_at_the_mean_radius() {
        let start = Line::new(Point3::new(0.1, 0.05, 0.0), Vector3::new(0.05, 0.02, 1.0)).unwrap();
        let start = Cylinder::new(start, 2.5).unwrap();
        let points = (0..48).map(|i| {
            let r = if i % 2 == 0 { 1.0 } else { 2.0 };
            let angle = f64::from(i / 2 % 4) * std::f64::consts::FRAC_PI_2;
            Point3::new(r * angle.cos(), r * angle.sin(), f64::from(i / 8) - 2.5)
        });
        let cylinder = cylinder_geometric(points, &start).unwrap();
        assert!((cylinder.radius - 1.5).abs() < 1e-9, "{cylinder:?}");
        assert!(cylinder.axis.distance(&Point3::origin()) < 1e-9);
        assert!((cylinder.axis.direction.z.abs() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn nothing_to_refine() {
        let axis = Line::new(Point3::origin(), Vector3::z()).unwrap();
        let start = Cylinder::new(axis, 1.0).unwrap();
        assert!(cylinder_geometric(std::iter::empty(), &start).is_none());
        assert!(cylinder_geometric([Point3::origin(); 9].into_iter(), &start).is_none());
        let nan = [Point3::new(f64::NAN, 0.0, 0.0); 9];
        assert!(cylinder_geometric(nan.into_iter(), &start).is_none());
        let weightless = (0..9).map(|i| (Point3::new(f64::from(i), 1.0, 0.0), 0.0));
        assert!(cylinder_weighted(weightless, &start, None).is_none());
    }
}
