use crate::moments::Moments;
use nalgebra::Point3;
use pomona_geometry::Line;

/// The line of total least squares: the least sum of squared distances of the points from it.
///
/// It passes through the centroid along the eigenvector of the scatter matrix
/// Σ (p − m)(p − m)ᵀ with the largest eigenvalue (Pearson 1901, doi 10.1080/14786440109462720).
///
/// `None` for fewer than two points, coincident points, points without a
/// preferred direction (the two largest eigenvalues equal to 1e-12), and where anything is
/// not finite.
pub fn line_least_squares(
    points: impl ExactSizeIterator<Item = Point3<f64>> + Clone,
) -> Option<Line> {
    if points.len() < 2 {
        return None;
    }
    let moments = Moments::new(points.map(|p| (p, 1.0)))?;
    let eigen = moments.scatter.symmetric_eigen();
    let largest = eigen.eigenvalues.imax();
    let second = (0..3)
        .filter(|&k| k != largest)
        .map(|k| eigen.eigenvalues[k])
        .fold(0.0, f64::max);
    // Written so that NaN refuses as well.
    if !(eigen.eigenvalues[largest] - second > 1e-12 * eigen.eigenvalues[largest]) {
        return None;
    }
    Line::new(moments.centroid, eigen.eigenvectors.column(largest).into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_without_a_direction_give_no_line() {
        let p = Point3::new(0.3, 0.2, 0.1);
        assert!(line_least_squares([p].into_iter()).is_none());
        assert!(line_least_squares([p; 7].into_iter()).is_none());
        let square = [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)];
        assert!(
            line_least_squares(square.into_iter().map(|(x, y)| Point3::new(x, y, 0.0))).is_none()
        );
        assert!(line_least_squares([p, Point3::new(f64::NAN, 0.0, 0.0)].into_iter()).is_none());
    }
}
