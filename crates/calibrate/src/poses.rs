//! Calibration from pose pairs.

mod board_scale;
mod cause;
mod daniilidis;
mod estimator;
mod motions;
mod park;
mod refine;
mod shah;
mod system;

pub use estimator::PoseSolver;
pub use motions::MotionSpread;

use crate::quality::{LeaveOneOut, LeftOut, Quality, SampleQuality, rejection, shift_at, spread};
use crate::robust::MAX_DRAWS;
use crate::{CalibrateError, Options, PoseSample};
use estimator::PosePairs;
use nalgebra::{Isometry3, Matrix6};
use pomona_files::{Warning, WarningCode};
use pomona_ransac::{FixedCount, LeastSquares, Msac, Ransac};
use pomona_transforms::{
    CameraFrame, FlangeFrame, FrameTag, Position, RobotFrame, TargetFrame, Transform,
    UncertainTransform,
};
use rand_core::Rng;
use refine::{Fit, LEAST_POSES};
use system::{PosePair, PoseSolution, Scale};

/// With fewer samples than this, a wrong one may go unnoticed.
const SAFE_POSES: usize = 8;

/// Where the camera is, from poses of a target; with `Carrier` what the camera is fixed to and `Other`
/// what the target is.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct PoseCalibration<Carrier: FrameTag, Other: FrameTag> {
    /// The answer, `carrier_from_camera`, with its covariance.
    pub camera: UncertainTransform<Carrier, CameraFrame>,
    /// What was found beside it, `other_from_target`, with its covariance.
    pub target: UncertainTransform<Other, TargetFrame>,
    /// The minimal solver whose model was refined.
    pub solver: PoseSolver,
    /// How far the robot turned among the inlier samples.
    pub motions: MotionSpread,
    /// Residuals, rejections and leave-one-out errors.
    pub quality: Quality,
}

/// A fixed camera and a target on the flange: `robot_from_camera`, from
/// A X = X B (X the camera's place, A the robot's motions and B those of the target).
///
/// Park's and Daniilidis's solvers each propose models from samples of three in a robust search; the better
/// outcome is refined jointly with the target's place on SE(3) with a robust loss. The answer depends on
/// the samples and on numbers taken from `rng`.
///
/// # Errors
///
/// [`CalibrateError`]: too few samples, numbers that cannot be, motions that do not determine the
/// answer, no consensus.
pub fn calibrate_eye_to_hand<R: Rng + ?Sized>(
    samples: &[PoseSample],
    options: &Options,
    rng: &mut R,
) -> Result<PoseCalibration<RobotFrame, FlangeFrame>, CalibrateError> {
    calibrate(
        samples,
        options,
        &[PoseSolver::Park, PoseSolver::Daniilidis],
        |s| s.robot_from_flange.isometry(),
        rng,
    )
}

/// A camera on the flange and a fixed target: `flange_from_camera`.
///
/// It is [`calibrate_eye_to_hand`] seen from the flange; all else is the same.
///
/// # Errors
///
/// As [`calibrate_eye_to_hand`].
pub fn calibrate_eye_in_hand<R: Rng + ?Sized>(
    samples: &[PoseSample],
    options: &Options,
    rng: &mut R,
) -> Result<PoseCalibration<FlangeFrame, RobotFrame>, CalibrateError> {
    calibrate(
        samples,
        options,
        &[PoseSolver::Park, PoseSolver::Daniilidis],
        |s| s.robot_from_flange.isometry().inverse(),
        rng,
    )
}

/// A fixed camera and a target on the flange, by A X = Z B: both unknowns at once from the
/// poses themselves, by Shah's solver in the search and the same joint refinement.
///
/// # Errors
///
/// As [`calibrate_eye_to_hand`].
pub fn calibrate_robot_world<R: Rng + ?Sized>(
    samples: &[PoseSample],
    options: &Options,
    rng: &mut R,
) -> Result<PoseCalibration<RobotFrame, FlangeFrame>, CalibrateError> {
    calibrate(
        samples,
        options,
        &[PoseSolver::Shah],
        |s| s.robot_from_flange.isometry(),
        rng,
    )
}

/// A published solver alone on all samples alike, for a fixed camera: no search, no refinement,
/// nothing rejected. For comparisons; `None` where the samples do not determine an answer.
pub fn solve_without_robustness(
    samples: &[PoseSample],
    solver: PoseSolver,
) -> Option<Transform<RobotFrame, CameraFrame>> {
    let pairs: Vec<PosePair> = samples
        .iter()
        .map(|s| PosePair {
            carrier: s.robot_from_flange.isometry(),
            seen: s.camera_from_target.isometry(),
        })
        .collect();
    let model = solver.solve(&pairs)?;
    Transform::from_isometry(&model.camera).ok()
}

fn calibrate<Carrier: FrameTag, Other: FrameTag, R: Rng + ?Sized>(
    samples: &[PoseSample],
    options: &Options,
    solvers: &[PoseSolver],
    carrier_from_other: impl Fn(&PoseSample) -> Isometry3<f64>,
    rng: &mut R,
) -> Result<PoseCalibration<Carrier, Other>, CalibrateError> {
    options.check()?;
    crate::samples::check_poses(samples, LEAST_POSES)?;
    let paired = |samples: &[PoseSample]| -> Vec<PosePair> {
        let pair = |s: &PoseSample| PosePair {
            carrier: carrier_from_other(s),
            seen: s.camera_from_target.isometry(),
        };
        samples.iter().map(pair).collect()
    };
    let pairs = paired(samples);
    motions::check(&pairs)?;
    let tolerance = Scale {
        rotation_rad: options.rotation_tolerance_rad,
        translation_m: options.translation_tolerance_m,
    };
    let found = search(&pairs, solvers, tolerance, options, rng);
    let (solver, model, inliers) = match found {
        Ok(found) => found,
        Err(_) if agrees_inverted(&pairs, solvers, tolerance, options, rng) => {
            return Err(CalibrateError::Inverted);
        }
        Err(error) => {
            let agree = |corrected: &[PoseSample]| {
                search(&paired(corrected), solvers, tolerance, options, rng).is_ok()
            };
            return Err(cause::cause(samples, agree).unwrap_or(error));
        }
    };
    let kept: Vec<PosePair> = inliers.iter().map(|&i| pairs[i]).collect();
    motions::check(&kept)?;
    let fit = refine::robust(&pairs, &inliers, &model).ok_or(CalibrateError::Undetermined)?;
    let kept: Vec<PosePair> = fit.kept().map(|i| pairs[i]).collect();
    let motions = motions::check(&kept)?;

    let block = |at: usize| -> Matrix6<f64> { fit.covariance.fixed_view::<6, 6>(at, at).into() };
    let camera = uncertain(&fit.model.camera, &block(0))?;
    let target = uncertain(&fit.model.target, &block(6))?;
    let quality = quality(samples, &pairs, &fit, options, &camera);
    Ok(PoseCalibration {
        camera,
        target,
        solver,
        motions,
        quality,
    })
}

fn uncertain<To: FrameTag, From: FrameTag>(
    isometry: &Isometry3<f64>,
    covariance: &Matrix6<f64>,
) -> Result<UncertainTransform<To, From>, CalibrateError> {
    let transform = Transform::from_isometry(isometry).map_err(|_| CalibrateError::Undetermined)?;
    UncertainTransform::new(transform, *covariance).map_err(|_| CalibrateError::Undetermined)
}

/// The consensus of most samples, over all solvers.
fn search<R: Rng + ?Sized>(
    pairs: &[PosePair],
    solvers: &[PoseSolver],
    tolerance: Scale,
    options: &Options,
    rng: &mut R,
) -> Result<(PoseSolver, PoseSolution, Vec<usize>), CalibrateError> {
    let needed = LEAST_POSES.max(pairs.len() / 2 + 1);
    let engine = Ransac::new(Msac::within(1.0))
        .local_optimization(LeastSquares::default())
        .stopping(FixedCount::new(u64::from(options.hypotheses)).max_draws(MAX_DRAWS));
    let mut best: Option<(f64, PoseSolver, PoseSolution, Vec<usize>)> = None;
    for &solver in solvers {
        let estimator = PosePairs {
            pairs,
            solver,
            tolerance,
        };
        // Without a model of one solver there may be one of the other.
        let Ok(report) = engine.run(&estimator, rng) else {
            continue;
        };
        if best.as_ref().is_none_or(|b| report.score > b.0) {
            best = Some((report.score, solver, report.model, report.inliers));
        }
    }
    let (_, solver, model, inliers) = best.ok_or(CalibrateError::Undetermined)?;
    if inliers.len() < needed {
        return Err(CalibrateError::NoConsensus {
            agreeing: inliers.len(),
            samples: pairs.len(),
            tolerance: format!(
                "{:.1} mm and {:.1} degrees",
                tolerance.translation_m * 1e3,
                tolerance.rotation_rad.to_degrees()
            ),
        });
    }
    Ok((solver, model, inliers))
}

/// Whether the samples agree with one side inverted.
///
/// C Q = X M gives C⁻¹ X = Q M⁻¹: inverting one side is the same as inverting the other, and inverting both
/// exchanges the two unknowns, which no residual shows.
fn agrees_inverted<R: Rng + ?Sized>(
    pairs: &[PosePair],
    solvers: &[PoseSolver],
    tolerance: Scale,
    options: &Options,
    rng: &mut R,
) -> bool {
    let inverted = pairs.iter().map(|p| PosePair {
        carrier: p.carrier.inverse(),
        seen: p.seen,
    });
    let inverted: Vec<PosePair> = inverted.collect();
    search(&inverted, solvers, tolerance, options, rng).is_ok()
}

fn quality<Carrier: FrameTag>(
    samples: &[PoseSample],
    pairs: &[PosePair],
    fit: &Fit,
    options: &Options,
    camera: &UncertainTransform<Carrier, CameraFrame>,
) -> Quality {
    let rows: Vec<SampleQuality> = (0..pairs.len())
        .map(|i| {
            let offset = fit.model.offset(&pairs[i]);
            let (place, sigmas) = (offset.translation.norm(), fit.squared[i].sqrt());
            let kept = fit.weights[i] > 0.0;
            SampleQuality {
                id: samples[i].id.clone(),
                translation_m: place,
                rotation_rad: Some(offset.rotation.norm()),
                sigmas,
                weight: fit.weights[i],
                rejected: (!kept).then(|| {
                    rejection(
                        place,
                        Some(offset.rotation),
                        sigmas,
                        options.translation_tolerance_m,
                    )
                }),
                left_out: kept.then(|| left_out(pairs, fit, i, options)).flatten(),
            }
        })
        .collect();
    let used = fit.kept().count();
    let mut warnings = Vec::new();
    if used < SAFE_POSES {
        let message = format!(
            "only {used} poses are used: too few to be sure that none of them is wrong; take {SAFE_POSES} or more"
        );
        warnings.push(Warning::new(WarningCode::FewSamples, message));
    }
    if samples.len() - used > samples.len() / 4 {
        let message = format!(
            "{} of {} poses are rejected: look for a common cause before trusting the rest",
            samples.len() - used,
            samples.len()
        );
        warnings.push(Warning::new(WarningCode::ManyRejected, message));
    }
    warnings.extend(board_scale::doubt(pairs, fit));
    let at_fruit =
        camera.position(&Position::new(crate::quality::fruit(options.fruit_distance_m)).into());
    let leave_one_out = LeaveOneOut::of(&rows);
    Quality {
        leave_one_out,
        samples: rows,
        noise_translation_m: fit.noise.translation_m,
        noise_rotation_rad: Some(fit.noise.rotation_rad),
        fruit_distance_m: options.fruit_distance_m,
        sigma_at_fruit_m: spread(&at_fruit.covariance_m2),
        sigma_rotation_rad: spread(&camera.rotation_covariance_rad2()),
        warnings,
    }
}

/// The fit without sample `i`; `None` where the rest does not determine it.
fn left_out(pairs: &[PosePair], fit: &Fit, i: usize, options: &Options) -> Option<LeftOut> {
    let mut weights = fit.weights.clone();
    weights[i] = 0.0;
    let model = refine::least_squares(pairs, &weights, &fit.model, &fit.noise)?;
    let offset = model.offset(&pairs[i]);
    Some(LeftOut {
        translation_m: offset.translation.norm(),
        rotation_rad: Some(offset.rotation.norm()),
        shift_at_fruit_m: shift_at(&model.camera, &fit.model.camera, options.fruit_distance_m),
    })
}
