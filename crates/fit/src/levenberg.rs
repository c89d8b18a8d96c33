//! Nonlinear least squares over the few parameters of a shape.

use crate::RadiusPrior;
use crate::chart::Chart;
use nalgebra::{Cholesky, Const, Point3, SMatrix, SVector};

const MAX_STEPS: usize = 200;

/// Damping beyond which no step is left to take.
const MAX_DAMPING: f64 = 1e12;

/// How far from zero a condition may be and still count as fulfilled.
const FULFILLED: f64 = 1e-11;

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
    /// With a `condition` the least objective is sought among the shapes for which it is zero: each step
    /// solves the equations with a Lagrange multiplier (Nocedal and Wright 2006, section 18.1,
    /// doi 10.1007/978-0-387-40065-5) and is brought back to the condition by Newton's method
    /// before it is judged.
    ///
    /// `None` where the objective of `start` is not finite, and where no shape
    /// near `start` fulfils the condition.
    pub(crate) fn minimize<C: Chart<N, R>, const N: usize, const R: usize>(
        &self,
        start: &C::Shape,
        condition: Option<&Condition<'_, C::Shape>>,
    ) -> Option<C::Shape> {
        let mut shape = *start;
        if let Some(condition) = condition {
            let (normal, _) = self.normal_equations(&C::at(&shape), &shape);
            let damped = Damped::new(&normal, 1e-6)?;
            shape = damped.fulfil::<C, R>(condition, shape)?;
        }
        let mut objective = self.value::<C, N, R>(&shape);
        if !objective.is_finite() {
            return None;
        }
        let mut damping = 1e-6;
        for _ in 0..MAX_STEPS {
            let chart = C::at(&shape);
            let (normal, descent) = self.normal_equations(&chart, &shape);
            let curved = condition.and_then(|c| curved::<C, N, R>(&normal, &descent, &chart, c));
            let mut improved = None;
            while damping < MAX_DAMPING {
                let tried = curved
                    .and_then(|curved| Damped::new(&curved, damping))
                    .or_else(|| Damped::new(&normal, damping))
                    .and_then(|d| d.step::<C, R>(&chart, &shape, &descent, condition));
                if let Some((candidate, decrement)) = tried {
                    let value = self.value::<C, N, R>(&candidate);
                    if value <= objective {
                        improved = Some((candidate, value, decrement));
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

/// `JᵀJ` with the condition's second derivatives, times its multiplier, added: without them steps along a bent
/// condition are too long, and the search creeps. `None` where that leaves a diagonal entry not positive.
fn curved<C: Chart<N, R>, const N: usize, const R: usize>(
    normal: &SMatrix<f64, N, N>,
    descent: &SVector<f64, N>,
    chart: &C,
    condition: &Condition<'_, C::Shape>,
) -> Option<SMatrix<f64, N, N>> {
    let damped = Damped::new(normal, 1e-12)?;
    let across = damped.gradient::<C, R>(chart, condition);
    let way = damped.solve(&across);
    let multiplier = across.dot(&damped.solve(descent)) / across.dot(&way);
    let largest = damped.scale.amax();
    let h = damped.scale.map(|scale| 1e-4 * scale / largest);
    let at = |i: usize, j: usize, a: f64, b: f64| {
        let mut step = SVector::<f64, N>::zeros();
        step[i] += a * h[i];
        step[j] += b * h[j];
        chart.stepped(&step).map(|shape| condition(&shape))
    };
    let mut curved = *normal;
    for i in 0..N {
        for j in 0..=i {
            let mixed = at(i, j, 1.0, 1.0)? - at(i, j, 1.0, -1.0)? - at(i, j, -1.0, 1.0)?
                + at(i, j, -1.0, -1.0)?;
            let second = multiplier * mixed / (4.0 * h[i] * h[j]);
            curved[(i, j)] += second;
            if i != j {
                curved[(j, i)] += second;
            }
        }
    }
    let valid = curved.iter().all(|c| c.is_finite()) && (0..N).all(|i| curved[(i, i)] > 0.0);
    valid.then_some(curved)
}

/// What has to be zero.
pub(crate) type Condition<'a, S> = dyn Fn(&S) -> f64 + 'a;

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

    /// The shape one step from `shape`, and the decrease of half the objective foreseen, twice.
    fn step<C: Chart<N, R>, const R: usize>(
        &self,
        chart: &C,
        shape: &C::Shape,
        descent: &SVector<f64, N>,
        condition: Option<&Condition<'_, C::Shape>>,
    ) -> Option<(C::Shape, f64)> {
        let free = self.solve(descent);
        let Some(condition) = condition else {
            return Some((chart.stepped(&free)?, free.dot(descent)));
        };
        let across = self.gradient(chart, condition);
        let way = self.solve(&across);
        let value = condition(shape);
        let step = free - way * ((across.dot(&free) + value) / across.dot(&way));
        let candidate = chart.stepped(&step)?;
        let candidate = self.fulfil::<C, R>(condition, candidate)?;
        Some((candidate, step.dot(descent).abs()))
    }

    /// The shape near `shape` for which `condition` is at most [`FULFILLED`] from zero.
    fn fulfil<C: Chart<N, R>, const R: usize>(
        &self,
        condition: &Condition<'_, C::Shape>,
        mut shape: C::Shape,
    ) -> Option<C::Shape> {
        let mut value = condition(&shape);
        for _ in 0..30 {
            if value == 0.0 {
                break;
            }
            let chart = C::at(&shape);
            let across = self.gradient(&chart, condition);
            let way = self.solve(&across);
            let Some(next) = chart.stepped(&(way * (-value / across.dot(&way)))) else {
                break;
            };
            let at_next = condition(&next);
            // Written so that NaN ends it as well.
            if !(at_next.abs() < value.abs()) {
                break;
            }
            (shape, value) = (next, at_next);
        }
        (value.abs() <= FULFILLED).then_some(shape)
    }

    /// Derivatives of `condition` by the parameters, by central differences.
    fn gradient<C: Chart<N, R>, const R: usize>(
        &self,
        chart: &C,
        condition: &Condition<'_, C::Shape>,
    ) -> SVector<f64, N> {
        let largest = self.scale.amax();
        SVector::from_fn(|k, _| {
            // About a millionth of a radian, and of the points' extent where the parameter is a length.
            let h = 1e-6 * self.scale[k] / largest;
            let mut step = SVector::zeros();
            step[k] = h;
            match (chart.stepped(&step), chart.stepped(&-step)) {
                (Some(a), Some(b)) if h > 0.0 => (condition(&a) - condition(&b)) / (2.0 * h),
                _ => 0.0,
            }
        })
    }
}
