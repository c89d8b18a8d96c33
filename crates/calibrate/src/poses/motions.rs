//! Relative motions A X = X B, and whether they determine X.

use super::system::PosePair;
use crate::CalibrateError;
use nalgebra::{Isometry3, Matrix3, Vector3};
use pomona_transforms::twist;

/// Rotations smaller than this, in radians, tell less than the noise of a marker's pose: 3°.
pub(crate) const LEAST_ROTATION_RAD: f64 = 0.052_359_877_559_829_89;

/// What moved between two samples, on the robot's side and on the camera's.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Motion {
    /// A = Cⱼ Cᵢ⁻¹.
    pub(crate) carrier: Isometry3<f64>,
    /// B = Mⱼ Mᵢ⁻¹.
    pub(crate) seen: Isometry3<f64>,
}

/// The motions between all pairs of samples: A X = X B, free of where the target is.
pub(crate) fn between(pairs: &[PosePair]) -> Vec<Motion> {
    let mut motions = Vec::new();
    for (j, b) in pairs.iter().enumerate() {
        for a in &pairs[..j] {
            motions.push(Motion {
                carrier: b.carrier * a.carrier.inverse(),
                seen: b.seen * a.seen.inverse(),
            });
        }
    }
    motions
}

/// How far the robot turned among samples.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct MotionSpread {
    /// Largest rotation between two samples, rad.
    pub largest_rad: f64,
    /// Largest part of a rotation between two samples that is not about the main axis, rad: 0 where
    /// the robot turned about a single axis.
    pub across_rad: f64,
}

/// The spread of rotations of the robot, as it told them itself.
pub(crate) fn spread(pairs: &[PosePair]) -> MotionSpread {
    let turns: Vec<Vector3<f64>> = between(pairs)
        .iter()
        .map(|m| twist::rotation_vector(&m.carrier.rotation))
        .collect();
    let scatter: Matrix3<f64> = turns.iter().map(|w| w * w.transpose()).sum();
    let eigen = scatter.symmetric_eigen();
    let main = eigen.eigenvectors.column(eigen.eigenvalues.imax());
    MotionSpread {
        largest_rad: turns.iter().map(Vector3::norm).fold(0.0, f64::max),
        across_rad: turns
            .iter()
            .map(|w| (w - main * main.dot(w)).norm())
            .fold(0.0, f64::max),
    }
}

/// Refuses motions from which X does not follow: rotations that are all small, or all about one axis
/// (Tsai and Lenz 1989, doi 10.1109/70.34770, section IV: two rotations about axes that differ).
pub(crate) fn check(pairs: &[PosePair]) -> Result<MotionSpread, CalibrateError> {
    let spread = spread(pairs);
    if !(spread.largest_rad >= LEAST_ROTATION_RAD) {
        return Err(CalibrateError::MotionsTooSmall {
            largest_deg: spread.largest_rad.to_degrees(),
        });
    }
    if !(spread.across_rad >= LEAST_ROTATION_RAD) {
        return Err(CalibrateError::OneAxis {
            across_deg: spread.across_rad.to_degrees(),
        });
    }
    Ok(spread)
}
