use nalgebra::Vector3;

/// Angle between two vectors, in `0..=π` radians; `None` where one has no length or is not finite.
///
/// It is taken as atan2(‖a × b‖, a · b), which keeps its accuracy near 0 and π
/// where the arc cosine of the normalised dot product loses half the digits
/// (Kahan 2006, "How Futile are Mindless Assessments of Roundoff", section 12).
#[inline]
pub fn angle_between(a: &Vector3<f64>, b: &Vector3<f64>) -> Option<f64> {
    let (scale_a, scale_b) = (a.amax(), b.amax());
    let usable = |v: &Vector3<f64>, s: f64| s > 0.0 && v.iter().all(|c| c.is_finite());
    if !usable(a, scale_a) || !usable(b, scale_b) {
        return None;
    }
    let (a, b) = (a / scale_a, b / scale_b);
    Some(a.cross(&b).norm().atan2(a.dot(&b)))
}

/// Angle between two axes (vectors without a sign), in `0..=π/2` radians;
/// `None` as for [`angle_between`].
#[inline]
pub fn angle_between_axes(a: &Vector3<f64>, b: &Vector3<f64>) -> Option<f64> {
    angle_between(a, b).map(|angle| angle.min(std::f64::consts::PI - angle))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_4, PI};

    #[test]
    fn known_angles() {
        let x = Vector3::x();
        let d = Vector3::new(1.0, 1.0, 0.0);
        assert!((angle_between(&x, &d).unwrap() - FRAC_PI_4).abs() < 1e-15);
        assert!((angle_between(&x, &-d).unwrap() - 3.0 * FRAC_PI_4).abs() < 1e-15);
        assert!((angle_between_axes(&x, &-d).unwrap() - FRAC_PI_4).abs() < 1e-15);
        assert_eq!(angle_between(&x, &-x).unwrap(), PI);
    }

    #[test]
    fn tiny_angles_keep_their_digits() {
        let small = 1e-9;
        let v = Vector3::new(f64::cos(small), f64::sin(small), 0.0);
        assert!((angle_between(&Vector3::x(), &v).unwrap() - small).abs() < 1e-20);
    }

    #[test]
    fn no_angle_to_nothing() {
        assert!(angle_between(&Vector3::x(), &Vector3::zeros()).is_none());
        assert!(angle_between(&Vector3::x(), &Vector3::new(f64::NAN, 1.0, 0.0)).is_none());
        assert!(angle_between(&Vector3::x(), &(Vector3::x() * 1e-200)).is_some());
    }
}
