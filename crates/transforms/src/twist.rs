//! Exponential and logarithm of rigid transforms, and the adjoint.

use nalgebra::{Isometry3, Matrix3, Matrix6, Translation3, UnitQuaternion, Vector3, Vector6};

/// Below this angle, in radians, series replace quotients that lose their digits.
const SMALL_RAD: f64 = 1e-4;

/// The matrix `[v]×` with `[v]× u = v × u`.
pub fn skew(v: &Vector3<f64>) -> Matrix3<f64> {
    v.cross_matrix()
}

/// The rigid transform of a twist ξ = (ω, υ), rotation vector in radians first, then
/// translation part in metres: Exp(ξ) = [exp ω, J(ω) υ] with the left Jacobian J.
///
/// Source: Barfoot and Furgale 2014, "Associating uncertainty with three-dimensional poses",
/// IEEE Trans. Robotics 30(3), Eq. 5–8, doi 10.1109/TRO.2014.2298059 (there υ stands first).
pub fn exp(twist: &Vector6<f64>) -> Isometry3<f64> {
    let omega: Vector3<f64> = twist.fixed_rows::<3>(0).into();
    let upsilon: Vector3<f64> = twist.fixed_rows::<3>(3).into();
    Isometry3::from_parts(
        Translation3::from(left_jacobian(&omega) * upsilon),
        UnitQuaternion::from_scaled_axis(omega),
    )
}

/// The twist of a rigid transform, the inverse of [`exp`]; its rotation vector is at most π long.
pub fn log(isometry: &Isometry3<f64>) -> Vector6<f64> {
    let omega = rotation_vector(&isometry.rotation);
    let upsilon = left_jacobian_inverse(&omega) * isometry.translation.vector;
    Vector6::new(omega.x, omega.y, omega.z, upsilon.x, upsilon.y, upsilon.z)
}

/// Axis times angle of a rotation, in radians, at most π long.
///
/// From the half angle by atan2, which keeps its digits at small angles and at π.
pub fn rotation_vector(rotation: &UnitQuaternion<f64>) -> Vector3<f64> {
    let sign = if rotation.w < 0.0 { -1.0 } else { 1.0 };
    let imaginary = rotation.imag() * sign;
    let sine = imaginary.norm();
    if sine == 0.0 {
        return Vector3::zeros();
    }
    imaginary * (2.0 * sine.atan2(rotation.w * sign) / sine)
}

/// The adjoint of a rigid transform for twists with the rotation first:
/// T Exp(ξ) T⁻¹ = Exp(Ad ξ), `Ad = [R 0; [t]× R  R]` (Barfoot and Furgale 2014, Eq. 10).
pub fn adjoint(isometry: &Isometry3<f64>) -> Matrix6<f64> {
    let r = isometry.rotation.to_rotation_matrix().into_inner();
    let mut ad = Matrix6::zeros();
    ad.fixed_view_mut::<3, 3>(0, 0).copy_from(&r);
    ad.fixed_view_mut::<3, 3>(3, 3).copy_from(&r);
    ad.fixed_view_mut::<3, 3>(3, 0)
        .copy_from(&(skew(&isometry.translation.vector) * r));
    ad
}

/// J(ω) with exp(ω + δ) ≈ exp(J δ) exp(ω) (Barfoot and Furgale 2014, Eq. 8).
pub fn left_jacobian(omega: &Vector3<f64>) -> Matrix3<f64> {
    let angle = omega.norm();
    let k = skew(omega);
    let (a, b) = if angle < SMALL_RAD {
        let squared = angle * angle;
        (0.5 - squared / 24.0, 1.0 / 6.0 - squared / 120.0)
    } else {
        (
            (1.0 - angle.cos()) / (angle * angle),
            (angle - angle.sin()) / angle.powi(3),
        )
    };
    Matrix3::identity() + k * a + k * k * b
}

/// The inverse of [`left_jacobian`], for rotation vectors of less than 2π.
pub fn left_jacobian_inverse(omega: &Vector3<f64>) -> Matrix3<f64> {
    let angle = omega.norm();
    let k = skew(omega);
    let b = if angle < SMALL_RAD {
        1.0 / 12.0 + angle * angle / 720.0
    } else {
        let half = 0.5 * angle;
        (1.0 - half * half.cos() / half.sin()) / (angle * angle)
    };
    Matrix3::identity() - k * 0.5 + k * k * b
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_logarithm_undoes_the_exponential(
            axis in prop::array::uniform3(-1.0..1.0f64),
            angle in prop_oneof![0.0..3.1f64, 1e-9..1e-3f64],
            upsilon in prop::array::uniform3(-2.0..2.0f64),
        ) {
            let axis = Vector3::from(axis);
            prop_assume!(axis.norm() > 1e-3);
            let omega = axis.normalize() * angle;
            let twist = Vector6::new(omega.x, omega.y, omega.z, upsilon[0], upsilon[1], upsilon[2]);
            prop_assert!((log(&exp(&twist)) - twist).amax() < 1e-11);
            let both = left_jacobian(&omega) * left_jacobian_inverse(&omega);
            prop_assert!((both - Matrix3::identity()).amax() < 1e-11);
        }

        #[test]
        fn the_adjoint_moves_a_twist_to_the_other_side(
            t in prop::array::uniform6(-1.0..1.0f64),
            xi in prop::array::uniform6(-1.0..1.0f64),
        ) {
            let t = exp(&Vector6::from(t));
            let xi = Vector6::from(xi);
            let left = exp(&(adjoint(&t) * xi)) * t;
            let right = t * exp(&xi);
            prop_assert!((left.to_homogeneous() - right.to_homogeneous()).amax() < 1e-12);
        }

        #[test]
        fn the_left_jacobian_is_the_derivative(
            omega in prop::array::uniform3(-1.5..1.5f64),
            delta in prop::array::uniform3(-1.0..1.0f64),
        ) {
            let (omega, delta) = (Vector3::from(omega), Vector3::from(delta) * 1e-6);
            let turned = UnitQuaternion::from_scaled_axis(omega + delta);
            let expected = turned * UnitQuaternion::from_scaled_axis(omega).inverse();
            let found = left_jacobian(&omega) * delta;
            prop_assert!((rotation_vector(&expected) - found).amax() < 1e-11);
        }
    }
}
