use crate::units::AngleUnit;
use nalgebra::{Quaternion, Unit, UnitQuaternion, Vector3};
use std::str::FromStr;

/// How a file writes rotations, as the numbers stand in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum RotationForm {
    /// A quaternion, x y z w.
    QuaternionXyzw,
    /// A quaternion, w x y z.
    QuaternionWxyz,
    /// The axis of the rotation times its angle: Universal Robots' `rx ry rz`, OpenCV's `rvec`.
    RotationVector,
    /// Three angles about axes.
    Euler(EulerAngles),
}

/// Three rotations about coordinate axes, in the order of the numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EulerAngles {
    /// 0, 1, 2 for x, y, z.
    axes: [usize; 3],
    /// Whether each turns about the axes as the ones before have left them, or about fixed axes.
    moving: bool,
}

impl EulerAngles {
    /// KUKA's A, B, C: about z, then the new y, then the new x.
    pub(crate) const KUKA: Self = Self {
        axes: [2, 1, 0],
        moving: true,
    };
    /// Roll, pitch, yaw about the fixed axes x, y, z, also called W, P, R by FANUC.
    pub(crate) const ROLL_PITCH_YAW: Self = Self {
        axes: [0, 1, 2],
        moving: false,
    };
}

impl RotationForm {
    /// How many numbers it takes.
    pub(crate) fn count(self) -> usize {
        match self {
            Self::QuaternionXyzw | Self::QuaternionWxyz => 4,
            Self::RotationVector | Self::Euler(_) => 3,
        }
    }

    /// The rotation of these numbers; `None` for a quaternion whose norm is not 1 within 1e-3. Too few numbers count as 0.
    pub(crate) fn rotation(self, numbers: &[f64], unit: AngleUnit) -> Option<UnitQuaternion<f64>> {
        let n = |i: usize| numbers.get(i).copied().unwrap_or(0.0);
        let angle = |i: usize| unit.radians(n(i));
        let unit_quaternion = |w: f64, x: f64, y: f64, z: f64| {
            let q = Quaternion::new(w, x, y, z);
            let is_unit = (q.norm() - 1.0).abs() <= 1e-3;
            is_unit.then(|| UnitQuaternion::new_normalize(q))
        };
        match self {
            Self::QuaternionXyzw => unit_quaternion(n(3), n(0), n(1), n(2)),
            Self::QuaternionWxyz => unit_quaternion(n(0), n(1), n(2), n(3)),
            Self::RotationVector => {
                let vector = Vector3::new(angle(0), angle(1), angle(2));
                Some(UnitQuaternion::from_scaled_axis(vector))
            }
            Self::Euler(EulerAngles { axes, moving }) => {
                let about = |i: usize| {
                    let axis = Unit::new_unchecked(Vector3::ith(axes[i], 1.0));
                    UnitQuaternion::from_axis_angle(&axis, angle(i))
                };
                Some(if moving {
                    about(0) * about(1) * about(2)
                } else {
                    about(2) * about(1) * about(0)
                })
            }
        }
    }
}

impl FromStr for RotationForm {
    type Err = String;

    /// A name (`quaternion-xyzw`, `quaternion-wxyz`, `rotation-vector`, `kuka`, `rpy`), or the axes of three angles:
    /// capitals for axes that move with the rotations before (`ZYX`), small letters for fixed ones (`xyz`).
    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "quaternion-xyzw" => return Ok(Self::QuaternionXyzw),
            "quaternion-wxyz" => return Ok(Self::QuaternionWxyz),
            "rotation-vector" => return Ok(Self::RotationVector),
            "kuka" => return Ok(Self::Euler(EulerAngles::KUKA)),
            "rpy" => return Ok(Self::Euler(EulerAngles::ROLL_PITCH_YAW)),
            _ => {}
        }
        let axis = |letter: u8| match letter.to_ascii_lowercase() {
            b'x' => Some(0),
            b'y' => Some(1),
            b'z' => Some(2),
            _ => None,
        };
        let moving = text.bytes().all(|b| b.is_ascii_uppercase());
        let fixed = text.bytes().all(|b| b.is_ascii_lowercase());
        if let [a, b, c] = text.as_bytes()
            && let (Some(a), Some(b), Some(c)) = (axis(*a), axis(*b), axis(*c))
            && a != b
            && b != c
            && (moving || fixed)
        {
            let axes = [a, b, c];
            return Ok(Self::Euler(EulerAngles { axes, moving }));
        }
        Err(format!(
            "`{text}` is no form of rotations: quaternion-xyzw, quaternion-wxyz, rotation-vector, kuka, rpy, or the axes of \
             three angles such as ZYX (about moving axes) or xyz (about fixed axes)"
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rotation(form: &str, numbers: &[f64]) -> UnitQuaternion<f64> {
        let form: RotationForm = form.parse().unwrap();
        form.rotation(numbers, AngleUnit::Degrees).unwrap()
    }

    #[test]
    fn the_forms_agree_about_one_rotation() {
        // 90° about z, then 30° about the new y.
        let expected = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), 90_f64.to_radians())
            * UnitQuaternion::from_axis_angle(&Vector3::y_axis(), 30_f64.to_radians());
        let [x, y, z, w]: [f64; 4] = expected.coords.into();
        let vector = expected.scaled_axis().map(f64::to_degrees);
        for (form, numbers) in [
            ("kuka", vec![90.0, 30.0, 0.0]),
            ("ZYX", vec![90.0, 30.0, 0.0]),
            ("rpy", vec![0.0, 30.0, 90.0]),
            ("xyz", vec![0.0, 30.0, 90.0]),
            ("ZYZ", vec![90.0, 30.0, 0.0]),
            ("quaternion-xyzw", vec![x, y, z, w]),
            ("quaternion-wxyz", vec![w, x, y, z]),
            ("rotation-vector", vector.as_slice().to_vec()),
        ] {
            let angle = rotation(form, &numbers).angle_to(&expected);
            assert!(angle < 1e-9, "{form}: {angle}");
        }
    }

    #[test]
    fn other_names_are_refused() {
        for name in ["", "xy", "Zyx", "XXY", "abc", "euler", "xyzx", "wxyz"] {
            assert!(name.parse::<RotationForm>().is_err(), "{name}");
        }
        let form = RotationForm::QuaternionXyzw;
        assert_eq!(
            form.rotation(&[1.0, 1.0, 0.0, 0.0], AngleUnit::Radians),
            None
        );
    }
}
