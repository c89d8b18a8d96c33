use nalgebra::Point3;
use pomona_geometry::Sphere;

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
    let [q1, q2, q3] = [1, 2, 3].map(|i| points[i] - points[0]);
    let (s1, s2, s3) = (q1.norm_squared(), q2.norm_squared(), q3.norm_squared());
    let q2xq3 = q2.cross(&q3);
    let volume = q1.dot(&q2xq3);
    // Written so that NaN refuses as well.
    if !(volume * volume > 1e-18 * s1 * s2 * s3) {
        return None;
    }
    let center = (q2xq3 * s1 + q3.cross(&q1) * s2 + q1.cross(&q2) * s3) / (2.0 * volume);
    Sphere::new(points[0] + center, center.norm())
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
}
