//! Weights that fall with the residual, and what they do to the covariance.

/// Degrees of freedom of the noise model: a Student t instead of a Gaussian, whose heavier tails
/// keep a sample that is somewhat off from pulling the answer.
///
/// Source: Lange, Little and Taylor 1989, "Robust statistical modeling using the t distribution",
/// doi 10.1080/01621459.1989.10478852. Large enough to lose a few per cent at most
/// where the noise is Gaussian after all.
const FREEDOM: f64 = 10.0;

/// Probability that a good sample lies beyond the gate: a thousandth.
/// Quantiles of χ² with 3 and 6 degrees of freedom.
const GATE_3: f64 = 16.27;
const GATE_6: f64 = 22.46;

/// A loss for residuals of `D` components, each of standard deviation 1.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StudentT<const D: usize>;

impl<const D: usize> StudentT<D> {
    /// Weight of a sample whose squared residual is `squared`.
    pub(crate) fn weight(squared: f64) -> f64 {
        (FREEDOM + D as f64) / (FREEDOM + squared)
    }

    /// Derivative of the weight by the squared residual.
    fn slope(squared: f64) -> f64 {
        -(FREEDOM + D as f64) / (FREEDOM + squared).powi(2)
    }

    /// The squared residual beyond which a sample is no longer believed.
    pub(crate) fn gate() -> f64 {
        if D == 3 { GATE_3 } else { GATE_6 }
    }

    /// By what the covariance of the weighted fit exceeds that of plain least squares:
    /// `E[w² s²]/D / E[w + 2 w′ s²/D]²` over the samples (Huber 1981, Robust Statistics, section
    /// 7.6, doi 10.1002/0471725250; for spherical residuals).
    pub(crate) fn efficiency_loss(squared: impl Iterator<Item = f64> + Clone) -> f64 {
        let n = squared.clone().count().max(1) as f64;
        let d = D as f64;
        let spread: f64 = squared
            .clone()
            .map(|s| Self::weight(s).powi(2) * s / d)
            .sum::<f64>()
            / n;
        let curvature: f64 = squared
            .map(|s| Self::weight(s) + 2.0 * Self::slope(s) * s / d)
            .sum::<f64>()
            / n;
        spread / (curvature * curvature)
    }
}

/// Median of numbers; NaN where there are none.
pub(crate) fn median(mut numbers: Vec<f64>) -> f64 {
    if numbers.is_empty() {
        return f64::NAN;
    }
    numbers.sort_by(f64::total_cmp);
    let n = numbers.len();
    f64::midpoint(numbers[(n - 1) / 2], numbers[n / 2])
}
