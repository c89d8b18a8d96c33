use crate::{FrameTag, Transform};
use nalgebra::Matrix3;
use std::fmt;
use std::marker::PhantomData;

/// Covariance of a position's error in the axes of `F`, in m².
///
/// ```
/// use nalgebra::Matrix3;
/// use pomona_transforms::{CameraFrame, PositionCovariance};
///
/// let covariance = PositionCovariance::<CameraFrame>::new(Matrix3::from_diagonal_element(3e-6));
/// assert_eq!(covariance.sd_m(), 3e-6_f64.sqrt());
/// ```
pub struct PositionCovariance<F: FrameTag> {
    matrix_m2: Matrix3<f64>,
    frame: PhantomData<fn() -> F>,
}

impl<F: FrameTag> PositionCovariance<F> {
    /// The covariance with these entries, m². They are taken as they are.
    pub fn new(matrix_m2: Matrix3<f64>) -> Self {
        Self {
            matrix_m2,
            frame: PhantomData,
        }
    }

    /// Its entries, m².
    pub fn matrix_m2(&self) -> Matrix3<f64> {
        self.matrix_m2
    }

    /// Root mean square of the standard deviations along the axes, metres; 0 where the trace is negative.
    pub fn sd_m(&self) -> f64 {
        (self.matrix_m2.trace() / 3.0).max(0.0).sqrt()
    }

    /// The same in the axes of `To`: R Σ Rᵀ. The error of the transform is not in it; see
    /// [`UncertainTransform::position`](crate::UncertainTransform::position).
    #[must_use]
    pub fn rotated<To: FrameTag>(&self, transform: &Transform<To, F>) -> PositionCovariance<To> {
        let rotation = transform.rotation().to_rotation_matrix().into_inner();
        let turned = rotation * self.matrix_m2 * rotation.transpose();
        PositionCovariance::new((turned + turned.transpose()) * 0.5)
    }
}

// By hand: derived, these would ask the tag for what it has no use for.
impl<F: FrameTag> Clone for PositionCovariance<F> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<F: FrameTag> Copy for PositionCovariance<F> {}

impl<F: FrameTag> PartialEq for PositionCovariance<F> {
    fn eq(&self, other: &Self) -> bool {
        self.matrix_m2 == other.matrix_m2
    }
}

impl<F: FrameTag> fmt::Debug for PositionCovariance<F> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let rows: [[f64; 3]; 3] = self.matrix_m2.transpose().into();
        write!(f, "PositionCovariance<{}>({rows:?})", F::NAME)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{CameraFrame, RobotFrame};

    #[test]
    fn a_quarter_turn_swaps_the_variances() {
        let half = 0.5_f64.sqrt();
        let about_z = Transform::<RobotFrame, CameraFrame>::from_quaternion(
            [1.0, 2.0, 3.0],
            [0.0, 0.0, half, half],
        )
        .unwrap();
        let diagonal = |x, y, z| Matrix3::from_diagonal(&nalgebra::Vector3::new(x, y, z));
        let turned = PositionCovariance::new(diagonal(1e-6, 4e-6, 9e-6)).rotated(&about_z);
        assert!((turned.matrix_m2() - diagonal(4e-6, 1e-6, 9e-6)).amax() < 1e-18);
        assert!((turned.sd_m() - (14e-6_f64 / 3.0).sqrt()).abs() < 1e-12);
    }
}
