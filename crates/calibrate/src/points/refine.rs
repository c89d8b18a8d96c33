//! Refinement of a similarity with a robust loss.

use super::estimator::PointPairs;
use super::search::LEAST_POINTS;
use super::similarity::Similarity;
use crate::Options;
use crate::quality::{LeftOut, shift_at};
use crate::robust::{MEDIAN_NORM_OF_3, StudentT};
use nalgebra::{Matrix3, Matrix3x6, Matrix6, Vector3};
use pomona_statistics::median;
use pomona_transforms::twist;

/// Lower bound of the estimated noise, m.
const FLOOR_M: f64 = 1e-6;

/// Samples whose degrees of freedom the six unknowns use up.
const USED: f64 = 2.0;

const MAX_ROUNDS: usize = 50;

/// Relative change of the noise at which the rounds end.
const CONVERGED: f64 = 1e-9;

/// Components of a residual.
const COMPONENTS: f64 = 3.0;

type Loss = StudentT<3>;

/// A model with its noise, weights and covariance.
pub(super) struct Fit {
    pub(super) model: Similarity,
    /// Standard deviation of one component.
    pub(super) sigma_m: f64,
    /// 0 for those that are rejected.
    pub(super) weights: Vec<f64>,
    pub(super) covariance: Matrix6<f64>,
}

impl Fit {
    pub(super) fn kept(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.weights.len()).filter(|&i| self.weights[i] > 0.0)
    }
}

/// Refines with the weights of a Student t, and decides anew which samples belong to the model.
pub(super) fn refine(pairs: &PointPairs, inliers: &[usize], start: &Similarity) -> Option<Fit> {
    let n = pairs.camera.len();
    let residuals =
        |model: &Similarity| -> Vec<f64> { (0..n).map(|i| pairs.residual(model, i)).collect() };
    let mut model = *start;
    let mut kept: Vec<usize> = inliers.to_vec();
    let of_inliers = residuals(&model);
    let mut of_kept: Vec<f64> = kept.iter().map(|&i| of_inliers[i]).collect();
    let middle = median(&mut of_kept)?;
    let mut sigma_m = (middle / MEDIAN_NORM_OF_3).max(FLOOR_M);
    for _ in 0..MAX_ROUNDS {
        let r = residuals(&model);
        let weights: Vec<f64> = kept
            .iter()
            .map(|&i| Loss::weight((r[i] / sigma_m).powi(2)))
            .collect();
        let next = pairs.fit_to(&kept, Some(&weights))?;
        let r = residuals(&next);
        let squares: f64 = kept
            .iter()
            .zip(&weights)
            .map(|(&i, w)| w * r[i] * r[i])
            .sum();
        let variance = Loss::variance(squares, COMPONENTS, kept.len() as f64, USED);
        let next_sigma = variance.sqrt().max(FLOOR_M);
        let gate = Loss::gate().sqrt() * next_sigma;
        let gated: Vec<usize> = (0..n).filter(|&i| r[i] <= gate).collect();
        let gated = if gated.len() >= LEAST_POINTS {
            gated
        } else {
            kept.clone()
        };
        let settled = gated == kept && (next_sigma / sigma_m).ln().abs() < CONVERGED;
        (model, sigma_m, kept) = (next, next_sigma, gated);
        if settled {
            break;
        }
    }
    // Once more with the final inliers, so that the report belongs to the model.
    let r = residuals(&model);
    let last: Vec<f64> = kept
        .iter()
        .map(|&i| Loss::weight((r[i] / sigma_m).powi(2)))
        .collect();
    let model = pairs.fit_to(&kept, Some(&last))?;
    let r = residuals(&model);
    let mut weights = vec![0.0; n];
    let mut normal = Matrix6::zeros();
    for &i in &kept {
        weights[i] = Loss::weight((r[i] / sigma_m).powi(2));
        let j = derivatives(&model.apply(&pairs.camera[i]).coords);
        normal += j.transpose() * j;
    }
    let loss = Loss::efficiency_loss(kept.iter().map(|&i| (r[i] / sigma_m).powi(2)), USED);
    let inverse = normal.cholesky()?.inverse();
    Some(Fit {
        model,
        sigma_m,
        weights,
        covariance: (inverse + inverse.transpose()) * (0.5 * loss * sigma_m * sigma_m),
    })
}

/// Of a place by a left perturbation, rotation first: `[−[p]× I]`.
fn derivatives(place: &Vector3<f64>) -> Matrix3x6<f64> {
    let mut j = Matrix3x6::zeros();
    j.fixed_view_mut::<3, 3>(0, 0)
        .copy_from(&-twist::skew(place));
    j.fixed_view_mut::<3, 3>(0, 3)
        .copy_from(&Matrix3::identity());
    j
}

/// The fit without sample `i`; `None` where the rest does not determine it.
pub(super) fn left_out(
    pairs: &PointPairs,
    fit: &Fit,
    i: usize,
    options: &Options,
) -> Option<LeftOut> {
    let others: Vec<usize> = fit.kept().filter(|&k| k != i).collect();
    let weights: Vec<f64> = others.iter().map(|&k| fit.weights[k]).collect();
    let model = pairs.fit_to(&others, Some(&weights))?;
    Some(LeftOut {
        translation_m: pairs.residual(&model, i),
        rotation_rad: None,
        shift_at_fruit_m: shift_at(
            &model.isometry,
            &fit.model.isometry,
            options.fruit_distance_m,
        ),
    })
}
