use crate::points::centroid_and_extent;
use nalgebra::{Matrix3, Point3};
use pomona_geometry::Plane;

/// The plane of total least squares: the least sum of squared distances of the points from it.
///
/// It passes through the centroid across the eigenvector of the scatter matrix with the
/// smallest eigenvalue (Pearson 1901, doi 10.1080/14786440109462720).
///
/// `None` for fewer than three points, points on one line (the two smallest eigenvalues
/// equal to 1e-12 of the largest), and where anything is not finite.
pub fn plane_least_squares(
    points: impl ExactSizeIterator<Item = Point3<f64>> + Clone,
) -> Option<Plane> {
    if points.len() < 3 {
        return None;
    }
    let (centroid, extent) = centroid_and_extent(points.clone())?;
    let scatter = points.fold(Matrix3::zeros(), |sum, p| {
        let q = (p - centroid) / extent;
        sum + q * q.transpose()
    });
    let eigen = scatter.symmetric_eigen();
    let smallest = eigen.eigenvalues.imin();
    let second = (0..3)
        .filter(|&k| k != smallest)
        .map(|k| eigen.eigenvalues[k])
        .fold(f64::INFINITY, f64::min);
    // Written so that NaN refuses as well.
    if !(second - eigen.eigenvalues[smallest] > 1e-12 * eigen.eigenvalues.amax()) {
        return None;
    }
    Plane::new(centroid, eigen.eigenvectors.column(smallest).into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_without_a_plane_give_none() {
        let on_line = (0..9).map(|i| Point3::new(f64::from(i), 2.0 * f64::from(i), 0.5));
        assert!(plane_least_squares(on_line).is_none());
        assert!(plane_least_squares([Point3::origin(); 5].into_iter()).is_none());
        assert!(plane_least_squares((0..2).map(|i| Point3::new(f64::from(i), 0.0, 0.0))).is_none());
    }
}
