//! Robust weights, and their effect on the covariance.

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

/// Samples drawn at most in a search, degenerate ones included: a limit on the time that useless data take.
pub(crate) const MAX_DRAWS: u64 = 20_000;

/// Median of the norm of three independent standard normal numbers: the root of the median of χ² with 3 degrees of
/// freedom, 2.365 974.
pub(crate) const MEDIAN_NORM_OF_3: f64 = 1.538_172;

/// A loss for residuals of `D` components, each of standard deviation 1.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StudentT<const D: usize>;

impl<const D: usize> StudentT<D> {
    /// The squared scale of the Student t that fits Gaussian noise of variance 1 best: the c for which
    /// `E[w s²] = D c` over χ² with `D` degrees of freedom, found by quadrature. With it, residuals here are in
    /// standard deviations of Gaussian noise.
    const SQUARED_SCALE: f64 = if D == 3 { 0.8618 } else { 0.8842 };

    /// Weight of a sample whose squared residual is `squared`.
    pub(crate) fn weight(squared: f64) -> f64 {
        (FREEDOM + D as f64) / (FREEDOM + squared / Self::SQUARED_SCALE)
    }

    /// Derivative of the weight by the squared residual.
    fn slope(squared: f64) -> f64 {
        let t = FREEDOM + squared / Self::SQUARED_SCALE;
        -(FREEDOM + D as f64) / (t * t * Self::SQUARED_SCALE)
    }

    /// The variance of Gaussian noise, from Σ w r² over `n` samples; `used` samples' worth of freedom went
    /// into the unknowns.
    pub(crate) fn variance(weighted_squares: f64, components: f64, n: f64, used: f64) -> f64 {
        weighted_squares / (components * (n - used).max(1.0) * Self::SQUARED_SCALE)
    }

    /// The squared residual beyond which a sample is an outlier.
    pub(crate) fn gate() -> f64 {
        if D == 3 { GATE_3 } else { GATE_6 }
    }

    /// By what the covariance of the weighted fit exceeds that of plain least squares with known
    /// noise: `E[w² s²]/D / E[w + 2 w′ s²/D]²` over the samples (Huber 1981, Robust Statistics, section
    /// 7.6, doi 10.1002/0471725250; for spherical residuals).
    ///
    /// The fit made the residuals smaller than the noise by the freedom `used`, which is given back.
    pub(crate) fn efficiency_loss(squared: impl Iterator<Item = f64> + Clone, used: f64) -> f64 {
        let n = squared.clone().count().max(1) as f64;
        let d = D as f64;
        let terms = squared.map(|s| {
            (
                Self::weight(s).powi(2) * s,
                Self::weight(s) + 2.0 * Self::slope(s) * s / d,
            )
        });
        let (spread, curvature) = terms.fold((0.0, 0.0), |(a, b), (x, y)| (a + x, b + y));
        let (spread, curvature) = (spread / (d * (n - used).max(1.0)), curvature / n);
        spread / (curvature * curvature)
    }
}
