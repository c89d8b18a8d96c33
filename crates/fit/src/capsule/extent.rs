use nalgebra::Point3;
use pomona_geometry::{Capsule, Cylinder};

/// The piece of `cylinder` that points cover: from the foot of the first point on the axis
/// to that of the last.
///
/// Where two neighbouring feet are more than `max_gap` apart the points fall into runs, and the run with most points
/// is taken (the first of equals); an infinite `max_gap` takes them all. The round ends of the capsule stand
/// out beyond the outermost points, which is right for a rod whose ends are not seen.
///
/// `None` for no points, a `max_gap` that is negative or NaN, and where anything is not finite.
pub fn capsule_along(
    cylinder: &Cylinder,
    points: impl IntoIterator<Item = Point3<f64>>,
    max_gap: f64,
) -> Option<Capsule> {
    let along = points.into_iter().map(|p| cylinder.axis.parameter(&p));
    let mut along: Vec<f64> = along.collect();
    if along.is_empty() || !(max_gap >= 0.0) || !along.iter().all(|t| t.is_finite()) {
        return None;
    }
    along.sort_unstable_by(f64::total_cmp);
    let mut longest = &along[..0];
    for run in along.chunk_by(|a, b| b - a <= max_gap) {
        if run.len() > longest.len() {
            longest = run;
        }
    }
    Capsule::cut(cylinder, *longest.first()?, *longest.last()?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;
    use pomona_geometry::Line;

    #[test]
    fn the_run_with_most_points_is_taken() {
        let axis = Line::new(Point3::origin(), Vector3::x()).unwrap();
        let cylinder = Cylinder::new(axis, 0.5).unwrap();
        let points = || [5.0, 0.0, 0.4, 9.0, 0.8].map(|x| Point3::new(x, 0.5, 0.0));
        let all = capsule_along(&cylinder, points(), f64::INFINITY).unwrap();
        assert_eq!((all.segment.start.x, all.segment.end.x), (0.0, 9.0));
        let run = capsule_along(&cylinder, points(), 0.5).unwrap();
        assert_eq!((run.segment.start.x, run.segment.end.x), (0.0, 0.8));
        assert!(capsule_along(&cylinder, [], 1.0).is_none());
        assert!(capsule_along(&cylinder, points(), f64::NAN).is_none());
        let nan = [Point3::new(f64::NAN, 0.0, 0.0)];
        assert!(capsule_along(&cylinder, nan, 1.0).is_none());
    }
}
