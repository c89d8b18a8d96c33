//! Calibration from point pairs.

mod diagnosis;
mod estimator;
mod refine;
mod search;
mod similarity;

use crate::quality::{LeaveOneOut, Quality, SampleQuality, fruit, rejection, spread};
use crate::samples::{check_point_lengths, check_points};
use crate::{CalibrateError, Options, PointSample};
use estimator::PointPairs;
use pomona_files::{Warning, WarningCode};
use pomona_transforms::{CameraFrame, Position, RobotFrame, Transform, UncertainTransform};
use rand_core::Rng;
use refine::{Fit, left_out, refine};
use search::{LEAST_POINTS, needed, search};

/// With fewer samples than this, a wrong one may go unnoticed.
const SAFE_POINTS: usize = 6;

/// Pose of a fixed camera, from points that it measured and the robot touched.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct PointCalibration {
    /// The answer, `robot_from_camera`, with its covariance.
    pub camera: UncertainTransform<RobotFrame, CameraFrame>,
    /// Distances in the robot's frame over those in the camera's, of the inlier samples: 1 but for errors.
    pub scale: f64,
    /// Residuals, rejections and leave-one-out errors.
    pub quality: Quality,
}

/// `robot_from_camera` from point pairs.
///
/// Kabsch's fit proposes models from samples of three in a robust search; the outcome is refined with a robust
/// loss over all that belong to it. A reflection, points on a line, and a scale that is not 1 are
/// recognised and named. The answer depends on the samples and on numbers taken from `rng`.
///
/// # Errors
///
/// [`CalibrateError`]: too few samples, numbers that cannot be, [`Scale`](CalibrateError::Scale) (more than
/// 2 % from 1), [`Mirrored`](CalibrateError::Mirrored), [`Collinear`](CalibrateError::Collinear), no consensus.
pub fn calibrate_points<R: Rng + ?Sized>(
    samples: &[PointSample],
    options: &Options,
    rng: &mut R,
) -> Result<PointCalibration, CalibrateError> {
    options.check()?;
    check_points(samples, LEAST_POINTS)?;
    let pairs = PointPairs {
        camera: samples.iter().map(|s| s.camera.point()).collect(),
        robot: samples.iter().map(|s| s.robot.point()).collect(),
        free_scale: false,
    };
    diagnosis::check_line(&pairs.robot, 0.0)?;
    diagnosis::check_line(&pairs.camera, 0.0)?;
    let found = search(&pairs, options.translation_tolerance_m, options, rng);
    let agreeing = found.as_ref().map_or(0, |(_, inliers)| inliers.len());
    let Some((model, inliers)) = found.filter(|_| agreeing >= needed(samples.len())) else {
        if let Some(explained) = diagnosis::explain(&pairs, options, rng) {
            return Err(explained);
        }
        check_point_lengths(samples)?;
        return Err(CalibrateError::NoConsensus {
            agreeing,
            samples: samples.len(),
            tolerance: format!("{:.1} mm", options.translation_tolerance_m * 1e3),
        });
    };
    check_point_lengths(samples)?;
    let fit = refine(&pairs, &inliers, &model).ok_or(CalibrateError::Undetermined)?;
    let kept: Vec<usize> = fit.kept().collect();
    let of_kept =
        |points: &[nalgebra::Point3<f64>]| -> Vec<_> { kept.iter().map(|&i| points[i]).collect() };
    diagnosis::check_line(&of_kept(&pairs.robot), fit.sigma_m)?;
    let scale = scale(&pairs, &fit, &kept)?;

    let transform =
        Transform::from_isometry(&fit.model.isometry).map_err(|_| CalibrateError::Undetermined)?;
    let camera = UncertainTransform::new(transform, fit.covariance)
        .map_err(|_| CalibrateError::Undetermined)?;
    let quality = quality(samples, &pairs, &fit, scale, options, &camera);
    Ok(PointCalibration {
        camera,
        scale: scale.value,
        quality,
    })
}

/// A scale differs from 1 significantly where it is off by more standard deviations than this.
const SIGNIFICANT_SIGMAS: f64 = 4.0;

#[derive(Clone, Copy)]
struct ScaleFound {
    value: f64,
    sigma: f64,
}

/// The scale of the inlier samples; refused where it differs significantly from 1.
fn scale(pairs: &PointPairs, fit: &Fit, kept: &[usize]) -> Result<ScaleFound, CalibrateError> {
    let free = PointPairs {
        free_scale: true,
        ..pairs.clone()
    };
    let value = free
        .fit_to(kept, None)
        .ok_or(CalibrateError::Undetermined)?
        .scale;
    let n = kept.len() as f64;
    let mean = kept
        .iter()
        .map(|&i| pairs.camera[i].coords)
        .sum::<nalgebra::Vector3<f64>>()
        / n;
    let squares: f64 = kept
        .iter()
        .map(|&i| (pairs.camera[i].coords - mean).norm_squared())
        .sum();
    let sigma = fit.sigma_m / squares.sqrt();
    let off = (value - 1.0).abs();
    if off > diagnosis::SCALE_TOLERANCE && off > SIGNIFICANT_SIGMAS * sigma {
        return Err(diagnosis::wrong_scale(value));
    }
    Ok(ScaleFound { value, sigma })
}

fn quality(
    samples: &[PointSample],
    pairs: &PointPairs,
    fit: &Fit,
    scale: ScaleFound,
    options: &Options,
    camera: &UncertainTransform<RobotFrame, CameraFrame>,
) -> Quality {
    let rows: Vec<SampleQuality> = samples
        .iter()
        .enumerate()
        .map(|(i, sample)| {
            let place = pairs.residual(&fit.model, i);
            let sigmas = place / fit.sigma_m;
            let kept = fit.weights[i] > 0.0;
            SampleQuality {
                id: sample.id.clone(),
                translation_m: place,
                rotation_rad: None,
                sigmas,
                weight: fit.weights[i],
                rejected: (!kept)
                    .then(|| rejection(place, None, sigmas, options.translation_tolerance_m)),
                left_out: kept.then(|| left_out(pairs, fit, i, options)).flatten(),
            }
        })
        .collect();
    let used = fit.kept().count();
    let mut warnings = Vec::new();
    if used < SAFE_POINTS {
        let message = format!(
            "only {used} points are used: too few to be sure that none of them is wrong; take {SAFE_POINTS} or more"
        );
        warnings.push(Warning::new(WarningCode::FewSamples, message));
    }
    if samples.len() - used > samples.len() / 4 {
        let message = format!(
            "{} of {} points are rejected: look for a common cause before trusting the rest",
            samples.len() - used,
            samples.len()
        );
        warnings.push(Warning::new(WarningCode::ManyRejected, message));
    }
    if (scale.value - 1.0).abs() > 4.0 * scale.sigma.max(1e-9) && (scale.value - 1.0).abs() > 1e-3 {
        let message = format!(
            "distances in the robot's frame are {:.2} % of the camera's: check the camera's depth scale and intrinsics",
            scale.value * 100.0
        );
        warnings.push(Warning::new(WarningCode::CameraScale, message));
    }
    let at_fruit = camera.position(&Position::new(fruit(options.fruit_distance_m)).into());
    Quality {
        leave_one_out: LeaveOneOut::of(&rows),
        samples: rows,
        noise_translation_m: fit.sigma_m,
        noise_rotation_rad: None,
        fruit_distance_m: options.fruit_distance_m,
        sigma_at_fruit_m: spread(&at_fruit.covariance_m2),
        sigma_rotation_rad: spread(&camera.rotation_covariance_rad2()),
        warnings,
    }
}
