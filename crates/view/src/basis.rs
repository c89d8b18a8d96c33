use nalgebra::Vector3;

/// Largest x of a unit vector that counts as far enough from the x axis for a cross product with it.
const FAR_FROM_X: f64 = 0.9;

/// Two unit vectors perpendicular to the unit vector `axis` and to each other.
pub(crate) fn perpendiculars(axis: &Vector3<f64>) -> (Vector3<f64>, Vector3<f64>) {
    let side = if axis.x.abs() < FAR_FROM_X {
        Vector3::x()
    } else {
        Vector3::y()
    };
    let first = axis.cross(&side).normalize();
    (first, axis.cross(&first))
}
