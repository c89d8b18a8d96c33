use nalgebra::{Point3, Unit, Vector3};

/// The point of a ray from the camera nearest to `center`.
pub(crate) fn nearest_on_ray(ray: &Unit<Vector3<f64>>, center: &Point3<f64>) -> Point3<f64> {
    Point3::from(ray.into_inner() * center.coords.dot(ray))
}
