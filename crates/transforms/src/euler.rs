use nalgebra::{Quaternion, UnitQuaternion};

/// Where the axes x and z coincide within this angle, in radians, the turn about z is 0.
const GIMBAL_RAD: f64 = 1e-12;

/// A rotation as three angles in radians: R = Rz(rz) · Ry(ry) · Rx(rx).
///
/// Read as turns about the fixed axes it is x first, then y, then z; read as turns about the
/// axes that move along it is Z, then Y, then X, hence the name (yaw, pitch, roll). Each turn is
/// right-handed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EulerZyx {
    /// Turn about x, in radians; −π to π where it comes from a rotation.
    pub rx: f64,
    /// Turn about y, in radians; −π/2 to π/2 where it comes from a rotation.
    pub ry: f64,
    /// Turn about z, in radians; −π to π where it comes from a rotation.
    pub rz: f64,
}

impl EulerZyx {
    /// The rotation of these angles.
    ///
    /// It is the product of the three quaternions (cos α/2, sin α/2 · axis); NaN stays NaN.
    pub fn rotation(&self) -> UnitQuaternion<f64> {
        let (sin_x, cos_x) = (0.5 * self.rx).sin_cos();
        let (sin_y, cos_y) = (0.5 * self.ry).sin_cos();
        let (sin_z, cos_z) = (0.5 * self.rz).sin_cos();
        UnitQuaternion::new_unchecked(Quaternion::new(
            cos_z * cos_y * cos_x + sin_z * sin_y * sin_x,
            cos_z * cos_y * sin_x - sin_z * sin_y * cos_x,
            cos_z * sin_y * cos_x + sin_z * cos_y * sin_x,
            sin_z * cos_y * cos_x - cos_z * sin_y * sin_x,
        ))
    }

    /// The angles of a rotation, with ry in −π/2 to π/2.
    ///
    /// At ry = ±π/2 only rz − rx or rz + rx is determined; then rz is 0. The angles give the
    /// rotation back everywhere: rx is taken after the turns about z and y have been undone, not
    /// from entries of the matrix that vanish there (Shoemake 1994, "Euler angle conversion",
    /// Graphics Gems IV, III.5, treats the same case by a branch).
    pub fn from_rotation(rotation: &UnitQuaternion<f64>) -> Self {
        let m = rotation.to_rotation_matrix();
        let cos_y = m[(0, 0)].hypot(m[(1, 0)]);
        let ry = (-m[(2, 0)]).atan2(cos_y);
        let rz = if cos_y > GIMBAL_RAD {
            m[(1, 0)].atan2(m[(0, 0)])
        } else {
            0.0
        };
        // Rz(−rz) · R = Ry(ry) · Rx(rx), whose middle row is 0, cos rx, −sin rx.
        let (sin_z, cos_z) = rz.sin_cos();
        let sin_x = sin_z * m[(0, 2)] - cos_z * m[(1, 2)];
        let cos_x = cos_z * m[(1, 1)] - sin_z * m[(0, 1)];
        Self {
            rx: sin_x.atan2(cos_x),
            ry,
            rz,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix3, Vector3};
    use proptest::prelude::*;
    use std::f64::consts::{FRAC_PI_2, PI};

    /// The definition, written out.
    fn product(e: &EulerZyx) -> Matrix3<f64> {
        let (sx, cx) = e.rx.sin_cos();
        let (sy, cy) = e.ry.sin_cos();
        let (sz, cz) = e.rz.sin_cos();
        Matrix3::new(cz, -sz, 0.0, sz, cz, 0.0, 0.0, 0.0, 1.0)
            * Matrix3::new(cy, 0.0, sy, 0.0, 1.0, 0.0, -sy, 0.0, cy)
            * Matrix3::new(1.0, 0.0, 0.0, 0.0, cx, -sx, 0.0, sx, cx)
    }

    #[test]
    fn z_is_the_last_of_the_fixed_axes() {
        let e = EulerZyx {
            rx: 0.0,
            ry: FRAC_PI_2,
            rz: FRAC_PI_2,
        };
        assert!((e.rotation() * Vector3::x() + Vector3::z()).norm() < 1e-15);
        assert!((e.rotation() * Vector3::z() - Vector3::y()).norm() < 1e-15);
    }

    #[test]
    fn at_the_gimbal_z_is_zero() {
        for ry in [FRAC_PI_2, -FRAC_PI_2] {
            let locked = EulerZyx {
                rx: 0.3,
                ry,
                rz: 1.1,
            };
            let e = EulerZyx::from_rotation(&locked.rotation());
            assert_eq!(e.rz, 0.0);
            assert!((product(&e) - product(&locked)).amax() < 1e-12);
        }
    }

    proptest! {
        #[test]
        fn angles_come_back(rx in -PI..PI, ry in -1.57..1.57f64, rz in -PI..PI) {
            let e = EulerZyx { rx, ry, rz };
            let rotation = e.rotation();
            let matrix = rotation.to_rotation_matrix().into_inner();
            prop_assert!((matrix - product(&e)).amax() < 1e-14);
            let back = EulerZyx::from_rotation(&rotation);
            for (a, b) in [(back.rx, rx), (back.ry, ry), (back.rz, rz)] {
                prop_assert!((a - b).abs() < 1e-11, "{back:?}");
            }
        }

        #[test]
        fn near_the_gimbal_the_rotation_comes_back(
            rx in -PI..PI, rz in -PI..PI, exponent in -16.0..-1.0f64, up in any::<bool>(),
        ) {
            let ry = FRAC_PI_2 - 10.0_f64.powf(exponent);
            let e = EulerZyx { rx, ry: if up { -ry } else { ry }, rz };
            let back = EulerZyx::from_rotation(&e.rotation());
            prop_assert!((product(&back) - product(&e)).amax() < 4e-12);
        }
    }
}
