use crate::{Direction, FrameTag, Position, TransformError, matrix, quaternion};
use nalgebra::{Isometry3, Matrix4, Translation3, Unit, UnitQuaternion, Vector3};
use std::fmt;
use std::marker::PhantomData;
use std::ops::Mul;

/// A rigid transform that takes what is known in `From` into `To`: a rotation, then a
/// translation in metres.
///
/// Name its values destination first, `robot_from_camera`; then the inner names of a product
/// agree, as its types must:
///
/// ```
/// use pomona_transforms::{CameraFrame, FrameTag, RobotFrame, Transform};
///
/// enum PlatformFrame {}
/// impl FrameTag for PlatformFrame {
///     const NAME: &'static str = "platform";
/// }
///
/// fn chain(
///     platform_from_robot: Transform<PlatformFrame, RobotFrame>,
///     robot_from_camera: Transform<RobotFrame, CameraFrame>,
/// ) -> Transform<PlatformFrame, CameraFrame> {
///     platform_from_robot * robot_from_camera
/// }
/// ```
///
/// The other order does not compile:
///
/// ```compile_fail,E0308
/// use pomona_transforms::{CameraFrame, FrameTag, RobotFrame, Transform};
///
/// enum PlatformFrame {}
/// impl FrameTag for PlatformFrame {
///     const NAME: &'static str = "platform";
/// }
///
/// fn chain(
///     platform_from_robot: Transform<PlatformFrame, RobotFrame>,
///     robot_from_camera: Transform<RobotFrame, CameraFrame>,
/// ) {
///     let _ = robot_from_camera * platform_from_robot;
/// }
/// ```
///
/// Nor does an inverse left out:
///
/// ```compile_fail,E0308
/// use pomona_transforms::{CameraFrame, RobotFrame, Transform};
///
/// fn invert(
///     robot_from_camera: Transform<RobotFrame, CameraFrame>,
/// ) -> Transform<CameraFrame, RobotFrame> {
///     robot_from_camera
/// }
/// ```
///
/// Nor a position of another frame, such as one that has been transformed already:
///
/// ```compile_fail,E0308
/// use pomona_transforms::{CameraFrame, Position, RobotFrame, Transform};
///
/// fn twice(robot_from_camera: Transform<RobotFrame, CameraFrame>, apple: Position<CameraFrame>) {
///     let apple = robot_from_camera.position(&apple);
///     robot_from_camera.position(&apple);
/// }
/// ```
pub struct Transform<To: FrameTag, From: FrameTag> {
    isometry: Isometry3<f64>,
    frames: PhantomData<fn(From) -> To>,
}

impl<To: FrameTag, From: FrameTag> Transform<To, From> {
    /// The transform with this translation and rotation, normalised where the quaternion's norm
    /// is 1 within 1e-3.
    ///
    /// # Errors
    ///
    /// [`TransformError::NotFinite`], [`TransformError::NotUnit`].
    pub fn from_quaternion(
        translation_m: [f64; 3],
        quaternion_xyzw: [f64; 4],
    ) -> Result<Self, TransformError> {
        if !translation_m.iter().all(|c| c.is_finite()) {
            return Err(TransformError::NotFinite {
                field: "translation_m",
            });
        }
        let rotation = quaternion::from_xyzw(quaternion_xyzw, "quaternion_xyzw")?;
        Ok(Self::trusted(Isometry3::from_parts(
            Translation3::from(translation_m),
            rotation,
        )))
    }

    /// The transform of a homogeneous matrix; its rotation is the one nearest to the
    /// upper left 3×3 part, which must be one within 1e-3 (largest |σ − 1| of its singular
    /// values σ).
    ///
    /// # Errors
    ///
    /// [`TransformError::NotFinite`], [`TransformError::LastRow`],
    /// [`TransformError::NotOrthonormal`], [`TransformError::LeftHanded`].
    pub fn from_matrix(matrix: &Matrix4<f64>) -> Result<Self, TransformError> {
        matrix::to_isometry(matrix, "matrix").map(Self::trusted)
    }

    /// The transform of an isometry.
    ///
    /// # Errors
    ///
    /// [`TransformError::NotFinite`], [`TransformError::NotUnit`].
    pub fn from_isometry(isometry: &Isometry3<f64>) -> Result<Self, TransformError> {
        Self::from_quaternion(
            isometry.translation.vector.into(),
            quaternion::to_xyzw(&isometry.rotation),
        )
    }

    pub(crate) fn at(isometry: Isometry3<f64>) -> Self {
        Self::trusted(isometry)
    }

    fn trusted(isometry: Isometry3<f64>) -> Self {
        Self {
            isometry,
            frames: PhantomData,
        }
    }

    /// A position in `To`: rotated and translated.
    pub fn position(&self, position: &Position<From>) -> Position<To> {
        Position::new(self.isometry.transform_point(&position.point()))
    }

    /// A direction in `To`: rotated only.
    pub fn direction(&self, direction: &Direction<From>) -> Direction<To> {
        let rotated = self.isometry.rotation.transform_vector(&direction.vector());
        Direction::from_unit(Unit::new_unchecked(rotated))
    }

    /// The transform back.
    #[must_use]
    pub fn inverse(&self) -> Transform<From, To> {
        Transform::trusted(self.isometry.inverse())
    }

    /// The position of `From`'s origin in `To`, in metres.
    pub fn translation_m(&self) -> Vector3<f64> {
        self.isometry.translation.vector
    }

    /// The orientation of `From`'s axes in `To`.
    pub fn rotation(&self) -> UnitQuaternion<f64> {
        self.isometry.rotation
    }

    /// The rotation as x y z w with w ≥ 0; for a half turn, with w = 0, the first component that
    /// is not 0 is positive.
    pub fn quaternion_xyzw(&self) -> [f64; 4] {
        quaternion::canonical_xyzw(&self.isometry.rotation)
    }

    /// Rotation and translation without their frames.
    pub fn isometry(&self) -> Isometry3<f64> {
        self.isometry
    }

    /// The homogeneous matrix.
    pub fn matrix(&self) -> Matrix4<f64> {
        self.isometry.to_homogeneous()
    }
}

impl<F: FrameTag> Transform<F, F> {
    /// The transform of a frame into itself that changes nothing.
    ///
    /// There is no identity between two different frames: that they coincide must be stated with numbers.
    pub fn identity() -> Self {
        Self::trusted(Isometry3::identity())
    }
}

/// First the right one, then the left one, as for matrices.
impl<A: FrameTag, B: FrameTag, C: FrameTag> Mul<Transform<B, C>> for Transform<A, B> {
    type Output = Transform<A, C>;

    fn mul(self, right: Transform<B, C>) -> Transform<A, C> {
        Transform::trusted(self.isometry * right.isometry)
    }
}

// By hand: derived implementations would require the same traits of the frame tags.
impl<To: FrameTag, From: FrameTag> Clone for Transform<To, From> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<To: FrameTag, From: FrameTag> Copy for Transform<To, From> {}

/// The two quaternions of a rotation, q and −q, are equal.
impl<To: FrameTag, From: FrameTag> PartialEq for Transform<To, From> {
    fn eq(&self, other: &Self) -> bool {
        self.isometry == other.isometry
    }
}

impl<To: FrameTag, From: FrameTag> fmt::Debug for Transform<To, From> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let translation_m: [f64; 3] = self.translation_m().into();
        f.debug_struct(&format!("{}_from_{}", To::NAME, From::NAME))
            .field("translation_m", &translation_m)
            .field("quaternion_xyzw", &self.quaternion_xyzw())
            .finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{CameraFrame, RobotFrame};
    use nalgebra::Point3;

    type RobotFromCamera = Transform<RobotFrame, CameraFrame>;

    #[test]
    fn a_quarter_turn_by_hand() {
        let h = 0.5_f64.sqrt();
        let turn = RobotFromCamera::from_quaternion([1.0, 2.0, 3.0], [0.0, 0.0, h, h]).unwrap();
        let p = turn.position(&Position::new(Point3::new(1.0, 0.0, 0.0)));
        assert!((p.point() - Point3::new(1.0, 3.0, 3.0)).norm() < 1e-15);
        let d = turn.direction(&Direction::new(Vector3::x()).unwrap());
        assert!((d.vector() - Vector3::y()).norm() < 1e-15);
        let same = RobotFromCamera::from_matrix(&Matrix4::new(
            0.0, -1.0, 0.0, 1.0, 1.0, 0.0, 0.0, 2.0, 0.0, 0.0, 1.0, 3.0, 0.0, 0.0, 0.0, 1.0,
        ))
        .unwrap();
        assert!((same.matrix() - turn.matrix()).amax() < 1e-15);
    }

    #[test]
    fn an_isometry_is_checked() {
        let mut isometry = Isometry3::translation(1.0, 2.0, 3.0);
        let transform = RobotFromCamera::from_isometry(&isometry).unwrap();
        assert_eq!(transform.isometry(), isometry);
        isometry.translation.vector.y = f64::NAN;
        assert!(RobotFromCamera::from_isometry(&isometry).is_err());
    }

    #[test]
    fn is_shown_with_its_frames() {
        let q = RobotFromCamera::from_quaternion([1.0, 0.0, 0.0], [0.0, 0.0, 0.0, -1.0]).unwrap();
        let shown = format!("{q:?}");
        assert!(shown.starts_with("robot_from_camera {"), "{shown}");
        assert!(shown.contains("[0.0, 0.0, 0.0, 1.0]"), "{shown}");
    }
}
