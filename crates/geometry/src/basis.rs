use nalgebra::{Unit, Vector3};

/// Two unit vectors u, v that make a right-handed frame (u, v, d) with the direction d.
///
/// u = d × a / ‖d × a‖ with a the coordinate axis to which d is least parallel (the first of
/// equals), and v = d × u. Tangent steps of directions and offsets across
/// an axis are measured along these two throughout the project.
pub fn across(direction: &Unit<Vector3<f64>>) -> [Vector3<f64>; 2] {
    let u = direction
        .cross(&Vector3::ith(direction.iamin(), 1.0))
        .normalize();
    [u, direction.cross(&u)]
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
