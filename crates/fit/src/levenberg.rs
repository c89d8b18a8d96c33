//! Nonlinear least squares over the few parameters of a shape.

use crate::RadiusPrior;
use crate::chart::Chart;
use nalgebra::{Cholesky, Const, Point3, SMatrix, SVector};

const MAX_STEPS: usize = 60;

/// Damping beyond which no step is left to take.
const MAX_DAMPING: f64 = 1e12;

/// What is minimised: Σ wᵢ dᵢ² over points with weights, plus the square of the
/// radius's deviation from its prior.
///
/// With a prior the weights are 1/σ² of each point.
#[derive(Clone, Copy)]
pub(crate) struct Objective<I> {
    pub(crate) points: I,
    pub(crate) prior: Option<RadiusPrior>,
}

impl<I: Iterator<Item = (Point3<f64>, f64)> + Clone> Objective<I> {
    pub(crate) fn value<C: Chart<N, R>, const N: usize, const R: usize>(
        &self,
        shape: &C::Shape,
    ) -> f64 {
        let points = self.points.clone();
        let sum: f64 = points
            .map(|(p, weight)| weight * C::squared_distance(shape, &p))
            .sum();
        sum + self
            .prior
            .map_or(0.0, |prior| prior.deviation(C::radius(shape)).powi(2))
    }

    /// `JᵀJ` and `−Jᵀf`.
    fn normal_equations<C: Chart<N, R>, const N: usize, const R: usize>(
        &self,
        chart: &C,
        shape: &C::Shape,
    ) -> (SMatrix<f64, N, N>, SVector<f64, N>) {
        let mut normal = SMatrix::zeros();
        let mut descent = SVector::zeros();
        for (p, weight) in self.points.clone() {
            let (residuals, rows) = chart.rows(&p);
            for (residual, row) in residuals.iter().zip(&rows) {
                let weighted = row * weight;
                normal += weighted * row.transpose();
                descent -= weighted * *residual;
            }
        }
        if let (Some(k), Some(prior)) = (C::RADIUS, self.prior) {
            normal[(k, k)] += prior.sigma().powi(-2);
            descent[k] -= prior.deviation(C::radius(shape)) / prior.sigma();
        }
        (normal, descent)
    }

    /// The shape of the least objective near `start`, by Levenberg–Marquardt (Marquardt 1963,
    /// doi 10.1137/0111030) with the parameters scaled to a unit diagonal; the objective never
    /// grows from one step to the next.
    ///
    /// `None` where the objective of `start` is not finite.
    pub(crate) fn minimize<C: Chart<N, R>, const N: usize, const R: usize>(
        &self,
        start: &C::Shape,
    ) -> Option<C::Shape> {
        let mut shape = *start;
        let mut objective = self.value::<C, N, R>(&shape);
        if !objective.is_finite() {
            return None;
        }
        let mut damping = 1e-6;
        for _ in 0..MAX_STEPS {
            let chart = C::at(&shape);
            let (normal, descent) = self.normal_equations(&chart, &shape);
            let mut improved = None;
            while damping < MAX_DAMPING {
                let step = Damped::new(&normal, damping).map(|d| d.solve(&descent));
                if let Some(step) = step
                    && let Some(candidate) = chart.stepped(&step)
                {
                    let value = self.value::<C, N, R>(&candidate);
                    if value <= objective {
                        improved = Some((candidate, value, step.dot(&descent)));
                        break;
                    }
                }
                damping *= 10.0;
            }
            let Some((candidate, value, decrement)) = improved else {
                break;
            };
            let stalled = value >= objective;
            shape = candidate;
            objective = value;
            damping = (damping / 10.0).max(1e-12);
            // The decrement is the squared step measured in standard deviations of the parameters.
            if stalled || decrement <= 1e-18 * objective {
                break;
            }
        }
        Some(shape)
    }
}

/// `JᵀJ` scaled to a unit diagonal and damped, factored.
pub(crate) struct Damped<const N: usize> {
    scale: SVector<f64, N>,
    factor: Cholesky<f64, Const<N>>,
}

impl<const N: usize> Damped<N> {
    /// `None` where the matrix is not finite or not positive definite.
    pub(crate) fn new(normal: &SMatrix<f64, N, N>, damping: f64) -> Option<Self> {
        let scale = normal.diagonal().map(|d| {
            let root = d.sqrt();
            if root > 0.0 { 1.0 / root } else { 0.0 }
        });
        let mut scaled = *normal;
        for i in 0..N {
            for j in 0..N {
                scaled[(i, j)] *= scale[i] * scale[j];
            }
            scaled[(i, i)] = 1.0 + damping;
        }
        let factor = scaled.cholesky()?;
        Some(Self { scale, factor })
    }

    pub(crate) fn solve(&self, rhs: &SVector<f64, N>) -> SVector<f64, N> {
        let scaled = rhs.component_mul(&self.scale);
        self.factor.solve(&scaled).component_mul(&self.scale)
    }
}
