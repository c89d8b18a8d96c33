use crate::FrameTag;
use nalgebra::{Unit, Vector3};
use std::fmt;
use std::marker::PhantomData;
use std::ops::Neg;

/// A unit vector in the frame `F`.
///
/// A direction has no position and cannot be used as one:
///
/// ```compile_fail,E0308
/// use nalgebra::Vector3;
/// use pomona_transforms::{CameraFrame, Direction, RobotFrame, Transform};
///
/// fn turn(robot_from_camera: Transform<RobotFrame, CameraFrame>) {
///     let up = Direction::<CameraFrame>::new(-Vector3::y()).unwrap();
///     robot_from_camera.position(&up);
/// }
/// ```
pub struct Direction<F: FrameTag> {
    unit: Unit<Vector3<f64>>,
    frame: PhantomData<fn() -> F>,
}

impl<F: FrameTag> Direction<F> {
    /// The direction of `vector`, whatever its length; `None` where it has none or is not finite.
    pub fn new(vector: Vector3<f64>) -> Option<Self> {
        let scale = vector.amax();
        if scale == 0.0 || !vector.iter().all(|c| c.is_finite()) {
            return None;
        }
        // Scaled first: squares of tiny or huge components would leave the range of f64.
        Some(Self::from_unit(Unit::new_normalize(vector / scale)))
    }

    /// The direction of a unit vector.
    pub fn from_unit(unit: Unit<Vector3<f64>>) -> Self {
        Self {
            unit,
            frame: PhantomData,
        }
    }

    /// Its components; their norm is 1.
    pub fn vector(&self) -> Vector3<f64> {
        self.unit.into_inner()
    }

    /// The same, with the norm known to the type.
    pub fn unit(&self) -> Unit<Vector3<f64>> {
        self.unit
    }

    /// Angle to another direction, in `0..=π` radians.
    ///
    /// atan2(‖a × b‖, a · b) keeps its digits near 0 and π, where the arc cosine loses half.
    pub fn angle_to(&self, other: &Self) -> f64 {
        self.unit
            .cross(&other.unit)
            .norm()
            .atan2(self.unit.dot(&other.unit))
    }
}

/// The opposite direction.
impl<F: FrameTag> Neg for Direction<F> {
    type Output = Self;

    fn neg(self) -> Self {
        Self::from_unit(-self.unit)
    }
}

// By hand: derived, these would ask the tag for what it has no use for.
impl<F: FrameTag> Clone for Direction<F> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<F: FrameTag> Copy for Direction<F> {}

impl<F: FrameTag> PartialEq for Direction<F> {
    fn eq(&self, other: &Self) -> bool {
        self.unit == other.unit
    }
}

impl<F: FrameTag> fmt::Debug for Direction<F> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y, z]: [f64; 3] = self.vector().into();
        write!(f, "Direction<{}>({x:?}, {y:?}, {z:?})", F::NAME)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::CameraFrame;
    use std::f64::consts::{FRAC_PI_2, PI};

    fn direction(x: f64, y: f64, z: f64) -> Option<Direction<CameraFrame>> {
        Direction::new(Vector3::new(x, y, z))
    }

    #[test]
    fn refuses_what_points_nowhere() {
        assert!(direction(0.0, -0.0, 0.0).is_none());
        assert!(direction(f64::NAN, 0.0, 1.0).is_none());
        assert!(direction(f64::INFINITY, 0.0, 1.0).is_none());
        for length in [1e-308, 1e-3, 1e308] {
            let d = direction(length, -length, 0.0).unwrap();
            assert!(
                (d.vector() - Vector3::new(0.5_f64.sqrt(), -0.5_f64.sqrt(), 0.0)).norm() < 1e-15
            );
        }
    }

    #[test]
    fn angles_between_directions() {
        let x = direction(2.0, 0.0, 0.0).unwrap();
        assert_eq!(x.angle_to(&x), 0.0);
        assert_eq!(x.angle_to(&-x), PI);
        assert_eq!(x.angle_to(&direction(0.0, 0.0, 3.0).unwrap()), FRAC_PI_2);
        assert!((x.angle_to(&direction(1.0, 1e-9, 0.0).unwrap()) - 1e-9).abs() < 1e-20);
    }
}
