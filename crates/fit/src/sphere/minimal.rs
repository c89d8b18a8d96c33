use crate::circle_through;
use nalgebra::{Point3, Vector3};
use pomona_geometry::{Line, Sphere};

/// The sphere through four points; `None` where they lie in one plane or are not finite.
///
/// With the first point as origin and q₁, q₂, q₃ the others, the centre solves
/// 2 qᵢ · c = |qᵢ|², so that
///
/// c = (|q₁|² q₂×q₃ + |q₂|² q₃×q₁ + |q₃|² q₁×q₂) / (2 q₁·(q₂×q₃)).
///
/// The points count as coplanar where the volume they span is less than 1e-9 of
/// |q₁||q₂||q₃|. (Eq. 1 of Gao et al. 2022, doi 10.3390/agriculture12081170, solved for
/// four points.)
#[inline]
pub fn sphere_through(points: [Point3<f64>; 4]) -> Option<Sphere> {
    let (q1, q2, q3) = (
        points[1] - points[0],
        points[2] - points[0],
        points[3] - points[0],
    );
    let (s1, s2, s3) = (q1.norm_squared(), q2.norm_squared(), q3.norm_squared());
    let q2xq3 = q2.cross(&q3);
    let volume = q1.dot(&q2xq3);
    // Written so that NaN refuses as well.
    if !(volume * volume > 1e-18 * s1 * s2 * s3) {
        return None;
    }
    let center = (q2xq3 * s1 + q3.cross(&q1) * s2 + q1.cross(&q2) * s3) * (0.5 / volume);
    Sphere::new(points[0] + center, center.norm())
}

/// The two spheres of a given radius through three points.
///
/// Their centres lie over and under the centre of the points' circle, by √(radius² − ρ²) with ρ
/// the circle's radius; over is the side to which (p₂ − p₁) × (p₃ − p₁) points. Where the
/// circle is a great circle of the sphere both are the same.
///
/// `None` where the radius is less than ρ, and for points that make no circle (see
/// [`circle_through`]).
pub fn spheres_of_radius(points: [Point3<f64>; 3], radius: f64) -> Option<[Sphere; 2]> {
    let circle = circle_through(points)?;
    let squared_height = (radius - circle.radius) * (radius + circle.radius);
    // Written so that NaN refuses as well.
    if !(squared_height >= 0.0) {
        return None;
    }
    let up = circle.normal.into_inner() * squared_height.sqrt();
    let over = Sphere::new(circle.center + up, radius)?;
    let under = Sphere::new(circle.center - up, radius)?;
    Some([over, under])
}

/// The sphere through two points whose surface normals are known, of either sign and any length.
///
/// Its centre is the middle between the nearest points of the lines pᵢ + sᵢ nᵢ, and its radius the mean of the
/// points' distances from it (Schnabel, Wahl and Klein 2007, section 4.1,
/// doi 10.1111/j.1467-8659.2007.01016.x).
///
/// `None` where the normals are parallel (their angle under 1e-9 rad), a normal has no length, or
/// anything is not finite.
pub fn sphere_through_normals(
    points: [Point3<f64>; 2],
    normals: [Vector3<f64>; 2],
) -> Option<Sphere> {
    let first = Line::new(points[0], normals[0])?;
    let second = Line::new(points[1], normals[1])?;
    let (a, b) = first.closest_points(&second)?;
    let center = nalgebra::center(&a, &b);
    let [d1, d2] = points.map(|p| (p - center).norm());
    Sphere::new(center, f64::midpoint(d1, d2))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn degenerate_samples_give_no_sphere() {
        let p = |x, y, z| Point3::new(x, y, z);
        let (a, b, c) = (p(0.0, 0.0, 1.0), p(1.0, 0.0, 1.0), p(0.0, 1.0, 1.0));
        assert!(
            sphere_through([a, b, c, p(1.0, 1.0, 1.0)]).is_none(),
            "coplanar"
        );
        assert!(sphere_through([a, b, c, a]).is_none(), "coincident");
        assert!(sphere_through([a, a, a, a]).is_none(), "all the same");
        assert!(
            sphere_through([a, b, p(2.0, 0.0, 1.0), p(3.0, 0.0, 1.0)]).is_none(),
            "collinear"
        );
        assert!(sphere_through([a, b, c, p(0.0, f64::NAN, 0.0)]).is_none());
        assert!(sphere_through([a, b, c, p(0.0, f64::INFINITY, 0.0)]).is_none());
    }

    #[test]
    fn spheres_that_do_not_exist() {
        let p = |x, y, z| Point3::new(x, y, z);
        let right = [p(1.0, 0.0, 0.0), p(-1.0, 0.0, 0.0), p(0.0, 1.0, 0.0)];
        assert!(spheres_of_radius(right, 0.9).is_none(), "too small");
        assert!(spheres_of_radius(right, f64::NAN).is_none());
        assert!(spheres_of_radius([right[0]; 3], 1.0).is_none());
        let [a, b] = spheres_of_radius(right, 1.0).unwrap();
        assert_eq!(a, b);
        let [a, b] = spheres_of_radius(right, 1.25).unwrap();
        assert!((a.center - p(0.0, 0.0, -0.75)).norm() < 1e-15, "{a:?}");
        assert!((b.center - p(0.0, 0.0, 0.75)).norm() < 1e-15, "{b:?}");

        let two = [p(0.0, 0.0, 0.0), p(1.0, 0.0, 0.0)];
        let n = Vector3::y();
        assert!(sphere_through_normals(two, [n, -n]).is_none(), "parallel");
        assert!(sphere_through_normals(two, [n, Vector3::zeros()]).is_none());
        let nan = Vector3::new(f64::NAN, 1.0, 0.0);
        assert!(sphere_through_normals(two, [n, nan]).is_none());
    }
}
