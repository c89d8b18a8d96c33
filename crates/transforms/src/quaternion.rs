use crate::TransformError;
use nalgebra::{Quaternion, UnitQuaternion};

/// How far the norm of a quaternion that comes in as numbers may be from 1.
const NORM_TOLERANCE: f64 = 1e-3;

/// A component this small is the rounding error of a zero.
const ZERO: f64 = 1e-15;

/// The rotation of a quaternion x y z w, normalised where its norm is 1 within 1e-3.
pub(crate) fn from_xyzw(
    xyzw: [f64; 4],
    field: &'static str,
) -> Result<UnitQuaternion<f64>, TransformError> {
    if !xyzw.iter().all(|c| c.is_finite()) {
        return Err(TransformError::NotFinite { field });
    }
    let [x, y, z, w] = xyzw;
    let quaternion = Quaternion::new(w, x, y, z);
    let norm = quaternion.norm();
    if !((norm - 1.0).abs() <= NORM_TOLERANCE) {
        return Err(TransformError::NotUnit { field, norm });
    }
    // Dividing by a norm that is 1 but for rounding would change the last bits on each reading.
    Ok(if (norm - 1.0).abs() <= 4.0 * f64::EPSILON {
        UnitQuaternion::new_unchecked(quaternion)
    } else {
        UnitQuaternion::new_unchecked(quaternion / norm)
    })
}

/// Its components x y z w.
pub(crate) fn to_xyzw(quaternion: &UnitQuaternion<f64>) -> [f64; 4] {
    quaternion.coords.into()
}

/// Of the two quaternions of a rotation, q and −q, the one with w > 0; for a half turn, whose w
/// is 0, the one whose first component that is not 0 is positive.
///
/// A component within 1e-15 of 0 counts as 0, and such a w becomes 0: otherwise the rounding of
/// a half turn would decide. There are no negative zeros in the result.
pub(crate) fn canonical(quaternion: &UnitQuaternion<f64>) -> UnitQuaternion<f64> {
    let [x, y, z, w] = to_xyzw(quaternion);
    let first = [w, x, y, z].into_iter().find(|c| c.abs() > ZERO);
    let sign = if first.is_some_and(|c| c < 0.0) {
        -1.0
    } else {
        1.0
    };
    let w = if w.abs() > ZERO { w } else { 0.0 };
    // Adding 0 turns −0 into 0.
    let [w, x, y, z] = [w, x, y, z].map(|c| sign * c + 0.0);
    UnitQuaternion::new_unchecked(Quaternion::new(w, x, y, z))
}

/// A rotation as x y z w with w ≥ 0; for a half turn, with w = 0, the first component that is not 0 is positive.
pub fn canonical_xyzw(rotation: &UnitQuaternion<f64>) -> [f64; 4] {
    to_xyzw(&canonical(rotation))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_1_SQRT_2;

    fn signs(x: f64, y: f64, z: f64, w: f64) -> [f64; 4] {
        to_xyzw(&canonical(&UnitQuaternion::new_unchecked(Quaternion::new(
            w, x, y, z,
        ))))
    }

    #[test]
    fn one_sign_of_two() {
        let h = FRAC_1_SQRT_2;
        assert_eq!(signs(h, 0.0, 0.0, -h), [-h, 0.0, 0.0, h]);
        assert_eq!(signs(0.0, -h, h, 0.0), [0.0, h, -h, 0.0]);
        assert_eq!(signs(0.0, 0.0, -1.0, 6e-17), [0.0, 0.0, 1.0, 0.0]);
        assert_eq!(signs(-1e-17, 0.0, 1.0, -0.0)[2], 1.0);
        let identity = signs(-0.0, -0.0, -0.0, -1.0);
        assert!(
            identity.iter().all(|c| c.is_sign_positive()),
            "{identity:?}"
        );
    }

    #[test]
    fn a_norm_near_one_is_made_one() {
        let q = from_xyzw([0.0, 0.0, 0.7075, 0.7075], "q").unwrap();
        assert!((q.norm() - 1.0).abs() < 1e-15);
        let q = [0.5, 0.5, 0.5, 0.5];
        assert_eq!(to_xyzw(&from_xyzw(q, "q").unwrap()), q);
    }

    #[test]
    fn other_norms_are_refused() {
        for w in [0.0, 0.998, 1.002, 1e200] {
            let error = from_xyzw([0.0, 0.0, 0.0, w], "q").unwrap_err();
            assert!(matches!(error, TransformError::NotUnit { .. }), "{error}");
        }
        for c in [f64::NAN, f64::INFINITY] {
            let error = from_xyzw([0.0, c, 0.0, 1.0], "q").unwrap_err();
            assert_eq!(error, TransformError::NotFinite { field: "q" });
        }
    }
}
