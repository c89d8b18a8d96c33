//! Why point pairs do not fit.

use super::estimator::PointPairs;
use super::search::{needed, search};
use crate::{CalibrateError, Options};
use nalgebra::{Matrix3, Point3, Vector3};
use rand_core::Rng;
use std::ops::Range;

/// Scales this close to 1 are a camera's error of depth, not a mistake.
pub(crate) const SCALE_TOLERANCE: f64 = 0.02;

/// Points this close to a line, as a share of their length along it, do not fix the turn about it.
const LINE: f64 = 0.02;

/// Points whose extent across a line exceeds the noise by this factor are not on it.
const LINE_SIGMAS: f64 = 3.0;

/// Ratio of the extents from which the robot's points are taken to be in millimetres.
const MILLIMETRES_RATIO: f64 = 100.0;

/// Scales outside of this range come from points that nearly coincide.
const PLAUSIBLE_SCALES: Range<f64> = 1e-4..1e4;

/// Largest natural logarithm of the ratio at which a scale is recognised as that of a unit.
const UNIT_TOLERANCE: f64 = 0.1;

/// Metres in an inch.
const INCH_M: f64 = 0.0254;

/// Refuses points on a line; `sigma_m` is their noise, or 0.
pub(crate) fn check_line(points: &[Point3<f64>], sigma_m: f64) -> Result<(), CalibrateError> {
    let n = points.len() as f64;
    let mean: Vector3<f64> = points.iter().map(|p| p.coords).sum::<Vector3<f64>>() / n;
    let scatter: Matrix3<f64> = points
        .iter()
        .map(|p| (p.coords - mean) * (p.coords - mean).transpose())
        .sum();
    let mut extents: Vec<f64> = scatter
        .symmetric_eigenvalues()
        .iter()
        .map(|e| (e.max(0.0) / n).sqrt())
        .collect();
    extents.sort_by(f64::total_cmp);
    let (along, across) = (extents[2], extents[1].hypot(extents[0]));
    if across > LINE * along && across > LINE_SIGMAS * sigma_m {
        return Ok(());
    }
    Err(CalibrateError::Collinear {
        across_mm: across * 1e3,
    })
}

/// What is wrong where the points find no rigid consensus, or one with another scale.
///
/// The similarity is sought with the scale left free, then after a reflection. The tolerance is that of the
/// robot's frame, and where this is in millimetres so is the tolerance.
pub(crate) fn explain<R: Rng + ?Sized>(
    pairs: &PointPairs,
    options: &Options,
    rng: &mut R,
) -> Option<CalibrateError> {
    let extent = |points: &[Point3<f64>]| {
        let mean = points.iter().map(|p| p.coords).sum::<Vector3<f64>>() / points.len() as f64;
        let squares = points.iter().map(|p| (p.coords - mean).norm_squared());
        (squares.sum::<f64>() / points.len() as f64).sqrt()
    };
    let ratio = extent(&pairs.robot) / extent(&pairs.camera);
    let unit = if ratio > MILLIMETRES_RATIO { 1e3 } else { 1.0 };
    let tolerance_m = options.translation_tolerance_m * unit;

    let mirrored = search(&pairs.mirrored(), tolerance_m, options, rng);
    if mirrored.is_some_and(|(_, inliers)| inliers.len() >= needed(pairs.robot.len())) {
        return Some(CalibrateError::Mirrored);
    }
    let free = PointPairs {
        free_scale: true,
        ..pairs.clone()
    };
    let reversed = free.mirrored();
    let upright = search(&free, tolerance_m, options, rng);
    let mirrored = search(&reversed, tolerance_m, options, rng);
    let (model, inliers) = [upright, mirrored]
        .into_iter()
        .flatten()
        .max_by_key(|(_, inliers)| inliers.len())?;
    let plausible = PLAUSIBLE_SCALES.contains(&model.scale);
    (plausible && inliers.len() >= needed(pairs.robot.len())).then(|| wrong_scale(model.scale))
}

pub(crate) fn wrong_scale(scale: f64) -> CalibrateError {
    let near = |target: f64| (scale / target).ln().abs() < UNIT_TOLERANCE;
    let cause = if near(1000.0) {
        "the robot's points look like millimetres taken for metres; divide them by 1000"
    } else if near(0.001) {
        "the camera's points look like millimetres taken for metres; divide them by 1000"
    } else if near(INCH_M) || near(1.0 / INCH_M) {
        "one of the two looks like inches; give metres"
    } else {
        "check the units of both, the camera's depth scale and its intrinsics"
    };
    CalibrateError::Scale { scale, cause }
}
