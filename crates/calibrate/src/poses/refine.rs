//! Joint refinement of both unknowns on SE(3) × SE(3).

use super::system::{Matrix12, PosePair, PoseResidual, PoseSolution, Scale, normal_equations};
use crate::robust::{MEDIAN_NORM_OF_3, StudentT};
use pomona_statistics::median;

/// Three poses determine the unknowns; a fourth tells whether one of them is wrong.
pub(crate) const LEAST_POSES: usize = 4;

const MAX_STEPS: usize = 50;
const MAX_ROUNDS: usize = 30;
/// Factor on the diagonal of the normal matrix: at the start, its bounds, and the factors by which it falls and rises.
const FIRST_DAMPING: f64 = 1e-9;
const MIN_DAMPING: f64 = 1e-12;
const MAX_DAMPING: f64 = 1e10;
const DAMPING_FALL: f64 = 0.1;
const DAMPING_RISE: f64 = 10.0;

/// Predicted relative decrease of the objective at which the steps end.
const CONVERGED_STEP: f64 = 1e-14;

/// Relative change of the noise at which the rounds end.
const CONVERGED_NOISE: f64 = 1e-6;

/// Components of each part of an offset, rotation and translation.
const COMPONENTS: f64 = 3.0;

/// Samples whose degrees of freedom the twelve unknowns use up.
const USED: f64 = 2.0;

/// Lower bound of the estimated noise, so that exact samples do not make each other outliers.
const FLOOR: Scale = Scale {
    rotation_rad: 1e-5,
    translation_m: 1e-6,
};

/// Six components of an offset.
type Loss = StudentT<6>;

/// The model of the least weighted squares near `start`, by Levenberg–Marquardt (Marquardt 1963,
/// doi 10.1137/0111030) with steps on the manifold; `None` where the samples do not determine
/// it or are not finite.
pub(crate) fn least_squares(
    pairs: &[PosePair],
    weights: &[f64],
    start: &PoseSolution,
    scale: &Scale,
) -> Option<PoseSolution> {
    let mut model = *start;
    let (mut normal, mut descent, mut objective) = normal_equations(pairs, weights, &model, scale);
    let mut damping = FIRST_DAMPING;
    for _ in 0..MAX_STEPS {
        if !objective.is_finite() {
            return None;
        }
        let mut improved = false;
        while damping < MAX_DAMPING {
            let mut damped = normal;
            for i in 0..12 {
                damped[(i, i)] *= 1.0 + damping;
            }
            if let Some(factor) = damped.cholesky() {
                let step = factor.solve(&descent);
                let candidate = model.stepped(&step);
                let (n, d, o) = normal_equations(pairs, weights, &candidate, scale);
                if o <= objective {
                    let converged =
                        step.dot(&descent) <= CONVERGED_STEP * objective || o >= objective;
                    (model, normal, descent, objective) = (candidate, n, d, o);
                    damping = (damping * DAMPING_FALL).max(MIN_DAMPING);
                    if converged {
                        return model.is_finite().then_some(model);
                    }
                    improved = true;
                    break;
                }
            }
            damping *= DAMPING_RISE;
        }
        if !improved {
            break;
        }
    }
    // A normal matrix that cannot be factored belongs to samples that do not determine the answer.
    normal.cholesky()?;
    model.is_finite().then_some(model)
}

/// A model with its noise, weights and covariance.
#[derive(Clone, Debug)]
pub(crate) struct Fit {
    pub(crate) model: PoseSolution,
    /// Standard deviations of one component of an offset.
    pub(crate) noise: Scale,
    /// Weight of each sample; 0 for those that are rejected.
    pub(crate) weights: Vec<f64>,
    /// Squared offset of each sample in units of the noise: χ² with 6 degrees of freedom for a good one.
    pub(crate) squared: Vec<f64>,
    /// Covariance of left perturbations of both unknowns, rotation first.
    pub(crate) covariance: Matrix12,
}

impl Fit {
    pub(crate) fn kept(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.weights.len()).filter(|&i| self.weights[i] > 0.0)
    }
}

/// Refines a model of the `inliers` with a robust loss, estimates the noise, and decides anew which samples
/// belong to it.
///
/// Weights and noise are those of a Student t, found in turns with the model; a sample beyond the gate of
/// a thousandth is left out, and taken in again where it comes back.
pub(crate) fn robust(pairs: &[PosePair], inliers: &[usize], start: &PoseSolution) -> Option<Fit> {
    let mut model = *start;
    let mut kept: Vec<bool> = (0..pairs.len()).map(|i| inliers.contains(&i)).collect();
    let mut noise = first_noise(pairs, &kept, &model)?;
    for _ in 0..MAX_ROUNDS {
        let squared: Vec<f64> = pairs
            .iter()
            .map(|p| model.offset(p).squared(&noise))
            .collect();
        let weights = weigh(&squared, &kept);
        let next = least_squares(pairs, &weights, &model, &noise)?;
        let next_noise = noise_of(pairs, &weights, &next);
        let gated: Vec<bool> = pairs
            .iter()
            .map(|p| next.offset(p).squared(&next_noise) <= Loss::gate())
            .collect();
        // Never fewer than a model needs, however odd the noise.
        let enough = gated.iter().filter(|k| **k).count() >= LEAST_POSES;
        let gated = if enough { gated } else { kept.clone() };
        let settled = gated == kept && close(&noise, &next_noise);
        (model, noise, kept) = (next, next_noise, gated);
        if settled {
            break;
        }
    }
    // Once more with the final inliers, so that the report belongs to the model.
    let squared: Vec<f64> = pairs
        .iter()
        .map(|p| model.offset(p).squared(&noise))
        .collect();
    let model = least_squares(pairs, &weigh(&squared, &kept), &model, &noise)?;
    finish(pairs, model, noise, &kept)
}

fn finish(pairs: &[PosePair], model: PoseSolution, noise: Scale, kept: &[bool]) -> Option<Fit> {
    let squared: Vec<f64> = pairs
        .iter()
        .map(|p| model.offset(p).squared(&noise))
        .collect();
    let weights = weigh(&squared, kept);
    let ones: Vec<f64> = kept.iter().map(|k| f64::from(u8::from(*k))).collect();
    let (normal, ..) = normal_equations(pairs, &ones, &model, &noise);
    let inverse = normal.cholesky()?.inverse();
    let of_kept = squared.iter().zip(kept).filter(|(_, k)| **k);
    let loss = Loss::efficiency_loss(of_kept.map(|(s, _)| *s), USED);
    Some(Fit {
        model,
        noise,
        weights,
        squared,
        covariance: (inverse + inverse.transpose()) * (0.5 * loss),
    })
}

fn weigh(squared: &[f64], kept: &[bool]) -> Vec<f64> {
    let pairs = squared.iter().zip(kept);
    pairs
        .map(|(s, k)| if *k { Loss::weight(*s) } else { 0.0 })
        .collect()
}

fn close(a: &Scale, b: &Scale) -> bool {
    (a.rotation_rad / b.rotation_rad).ln().abs() < CONVERGED_NOISE
        && (a.translation_m / b.translation_m).ln().abs() < CONVERGED_NOISE
}

/// The noise by medians, before anything is weighted.
fn first_noise(pairs: &[PosePair], kept: &[bool], model: &PoseSolution) -> Option<Scale> {
    let size = |part: fn(&PoseResidual) -> f64| {
        let offsets = pairs.iter().zip(kept).filter(|(_, k)| **k);
        let mut sizes: Vec<f64> = offsets.map(|(p, _)| part(&model.offset(p))).collect();
        Some(median(&mut sizes)? / MEDIAN_NORM_OF_3)
    };
    Some(Scale {
        rotation_rad: size(|o| o.rotation.norm())?.max(FLOOR.rotation_rad),
        translation_m: size(|o| o.translation.norm())?.max(FLOOR.translation_m),
    })
}

/// The noise by weighted squares.
fn noise_of(pairs: &[PosePair], weights: &[f64], model: &PoseSolution) -> Scale {
    let n = weights.iter().filter(|w| **w > 0.0).count() as f64;
    let (mut rotation, mut translation) = (0.0, 0.0);
    for (pair, weight) in pairs.iter().zip(weights) {
        let offset = model.offset(pair);
        rotation += weight * offset.rotation.norm_squared();
        translation += weight * offset.translation.norm_squared();
    }
    let sigma = |squares| Loss::variance(squares, COMPONENTS, n, USED).sqrt();
    Scale {
        rotation_rad: sigma(rotation).max(FLOOR.rotation_rad),
        translation_m: sigma(translation).max(FLOOR.translation_m),
    }
}
