use nalgebra::{Point3, Vector3};
use pomona_geometry::{Cylinder, Line};

/// The cylinder through two points whose surface normals are known, of either sign and any length.
///
/// The axis is along n₁ × n₂. Across it, the lines pᵢ + sᵢ nᵢ meet in a point of the axis, and the
/// radius is the mean of the points' distances from it (Schnabel, Wahl and Klein 2007, "Efficient
/// RANSAC for point-cloud shape detection", section 4.1, doi 10.1111/j.1467-8659.2007.01016.x).
/// The axis's point is the foot of the points' midpoint.
///
/// `None` where the normals are parallel (sine of their angle under 1e-6), a normal has no
/// length, or anything is not finite.
pub fn cylinder_through(points: [Point3<f64>; 2], normals: [Vector3<f64>; 2]) -> Option<Cylinder> {
    let [n1, n2] = normals.map(|n| n / n.norm());
    let cross = n1.cross(&n2);
    let sine = cross.norm();
    // Written so that NaN refuses as well.
    if !(sine > 1e-6) {
        return None;
    }
    let axis = cross / sine;
    // Within the plane across the axis, where n₁ and n₂ lie: p₁ + s n₁ = p₂ + t n₂.
    let offset = points[1] - points[0];
    let s = offset.cross(&n2).dot(&axis) / sine;
    let center = points[0] + n1 * s;
    let line = Line::new(center, axis)?;
    let middle = nalgebra::center(&points[0], &points[1]);
    let line = Line::new(line.foot(&middle), axis)?;
    Cylinder::new(
        line,
        f64::midpoint(line.distance(&points[0]), line.distance(&points[1])),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn degenerate_samples_give_no_cylinder() {
        let (o, x) = (Point3::origin(), Point3::new(1.0, 0.0, 0.0));
        let n = Vector3::y();
        assert!(cylinder_through([o, x], [n, n]).is_none(), "parallel");
        assert!(cylinder_through([o, x], [n, -n]).is_none(), "opposite");
        assert!(cylinder_through([o, x], [n, Vector3::zeros()]).is_none());
        assert!(
            cylinder_through([o, o], [n, Vector3::x()]).is_none(),
            "no radius"
        );
        let nan = Vector3::new(f64::NAN, 0.0, 0.0);
        assert!(cylinder_through([o, x], [n, nan]).is_none());
        let far = Point3::new(f64::INFINITY, 0.0, 0.0);
        assert!(cylinder_through([o, far], [n, Vector3::x()]).is_none());
    }
}
