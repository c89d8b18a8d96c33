//! The frames' common motions: what is known of them beforehand, and what was found.

use crate::answer::FrameShift;
use crate::joint::{JointEstimate, squared_distance};
use nalgebra::{Isometry3, Matrix3, Matrix6, UnitQuaternion, Vector3};
use pomona::{FusionConfig, RobotFromCamera};

/// Smallest standard deviation of a motion, radians and metres: keeps the prior invertible where nothing is said to sway.
const MIN_MOTION_SD: f64 = 1e-6;

/// What is known of the frames' motions before the apples are seen.
pub(crate) struct MotionPriors {
    /// Whether all poses are the same: a camera at rest, whose stated error is common to all frames.
    at_rest: bool,
    /// Covariance of each pose's stated error about the centroid.
    stated: Vec<Matrix6<f64>>,
    /// Covariance of each frame's own motion about the centroid: sway, and the pose's error where the camera moves.
    pub(crate) covariances: Vec<Matrix6<f64>>,
}

impl MotionPriors {
    pub(crate) fn new(
        poses: &[&RobotFromCamera],
        centroid: &Vector3<f64>,
        config: &FusionConfig,
    ) -> Self {
        let at_rest = poses.windows(2).all(|w| w[0] == w[1]);
        let stated: Vec<Matrix6<f64>> = poses
            .iter()
            .map(|pose| about(&pose.uncertain().covariance, centroid))
            .collect();
        let sway = sway(config);
        let covariances = stated
            .iter()
            .map(|error| {
                if at_rest {
                    sway
                } else {
                    symmetric(&(error + sway))
                }
            })
            .collect();
        Self {
            at_rest,
            stated,
            covariances,
        }
    }

    /// Covariance about the centroid of the error that all frames have in common, where the camera is at rest.
    pub(crate) fn common_pose_error(&self) -> Option<&Matrix6<f64>> {
        self.stated.first().filter(|_| self.at_rest)
    }

    /// The shift of frame `k` from the first one; `gate` bounds what is not significant.
    pub(crate) fn shift(&self, estimate: &JointEstimate<'_>, k: usize, gate: f64) -> FrameShift {
        let (by, covariance) = estimate.shift(k, 0);
        let stated: Matrix3<f64> = if self.at_rest {
            Matrix3::zeros()
        } else {
            let shift = |f: usize| self.stated[f].fixed_view::<3, 3>(3, 3).into_owned();
            shift(0) + shift(k)
        };
        FrameShift {
            by,
            sd_m: (covariance.trace() / 3.0).max(0.0).sqrt(),
            significant: squared_distance(&by, &(covariance + stated)) > gate,
        }
    }
}

/// Covariance of a motion about the origin, for the same motion about `centroid`: there it shifts by ω × centroid besides.
fn about(covariance: &Matrix6<f64>, centroid: &Vector3<f64>) -> Matrix6<f64> {
    let mut transfer = Matrix6::identity();
    transfer
        .fixed_view_mut::<3, 3>(3, 0)
        .copy_from(&-centroid.cross_matrix());
    transfer * covariance * transfer.transpose()
}

/// Covariance of the sway of a tree.
fn sway(config: &FusionConfig) -> Matrix6<f64> {
    let mut sway = Matrix6::zeros();
    for i in 0..3 {
        sway[(i, i)] = config.sway_sd_rad.max(MIN_MOTION_SD).powi(2);
        sway[(i + 3, i + 3)] = config.sway_sd_m.max(MIN_MOTION_SD).powi(2);
    }
    sway
}

fn symmetric(matrix: &Matrix6<f64>) -> Matrix6<f64> {
    (matrix + matrix.transpose()) * 0.5
}

/// Takes the estimated motion of frame `k` off: m ↦ m − (ω × (m − c) + υ), which to first order is a rotation by −ω about
/// the centroid c and a shift by −υ.
pub(crate) fn correction(estimate: &JointEstimate<'_>, k: usize) -> Isometry3<f64> {
    let motion = estimate.motion(k);
    let omega: Vector3<f64> = motion.fixed_rows::<3>(0).into();
    let shift: Vector3<f64> = motion.fixed_rows::<3>(3).into();
    let rotation = UnitQuaternion::from_scaled_axis(-omega);
    let translation = estimate.centroid - rotation * estimate.centroid - shift;
    Isometry3::from_parts(translation.into(), rotation)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turn_about_the_origin_shifts_a_distant_centroid() {
        let sd_rad = 0.01;
        let mut covariance = Matrix6::zeros();
        covariance[(2, 2)] = sd_rad * sd_rad;
        let moved = about(&covariance, &Vector3::new(2.0, 0.0, 0.0));
        // A turn about z moves what is 2 m along x by 2 m × angle along y.
        assert!((moved[(4, 4)].sqrt() - 0.02).abs() < 1e-15);
        assert_eq!(moved[(3, 3)], 0.0);
        assert_eq!(moved[(2, 2)], covariance[(2, 2)]);
    }
}
