use nalgebra::{Unit, Vector3};

/// Two unit vectors u, v that make a right-handed frame (u, v, d) with the direction d.
///
/// With s the sign of d's z and a = −1/(s + z): u = (1 + s x² a, s x y a, −s x) and
/// v = (x y a, s + y² a, −y), which takes one division and no root (Duff et al. 2017, "Building
/// an orthonormal basis, revisited", JCGT 6(1)). Tangent steps of directions and offsets across
/// an axis are measured along these two throughout the project.
#[inline]
pub fn across(direction: &Unit<Vector3<f64>>) -> [Vector3<f64>; 2] {
    let d = direction;
    let sign = 1.0_f64.copysign(d.z);
    let a = -1.0 / (sign + d.z);
    let b = d.x * d.y * a;
    [
        Vector3::new(1.0 + sign * d.x * d.x * a, sign * b, -sign * d.x),
        Vector3::new(b, sign + d.y * d.y * a, -d.y),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn is_a_right_handed_frame(d in prop::array::uniform3(-1.0..1.0f64)) {
            let d = Vector3::from(d);
            prop_assume!(d.norm() > 1e-3);
            let d = Unit::new_normalize(d);
            let [u, v] = across(&d);
            prop_assert!((u.norm() - 1.0).abs() < 1e-14 && (v.norm() - 1.0).abs() < 1e-14);
            prop_assert!(u.dot(&d).abs() < 1e-14 && u.dot(&v).abs() < 1e-14);
            prop_assert!((u.cross(&v) - d.into_inner()).norm() < 1e-14);
        }
    }
}
