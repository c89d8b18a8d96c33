//! What the residuals of the inliers tell of the noise.

use crate::{Covariance, Estimator, Linearization, Scorer};

/// Noise and covariance of a model, from the residuals of its inliers.
pub(crate) fn uncertainty<E: Estimator, S: Scorer<E>>(
    estimator: &E,
    scorer: &S,
    model: &E::Model,
    inliers: &[usize],
) -> (Option<f64>, Option<Covariance>) {
    if E::PARAMETERS == 0 || inliers.is_empty() {
        return (None, None);
    }
    let threshold = scorer.threshold(model);
    let mut rows = Linearization::new(E::PARAMETERS);
    for &datum in inliers {
        let own = scorer.threshold_of(model, datum);
        let weight = scorer.weight_of(datum);
        // A threshold of zero or infinity divides by itself as well.
        rows.set_weight(if own == threshold {
            weight
        } else {
            weight * (threshold / own).powi(2)
        });
        estimator.linearize(model, datum, &mut rows);
    }
    let Some(spread) = rows.sigma() else {
        return (None, None);
    };
    let components = rows.rows() as f64 / inliers.len() as f64;
    let sigma = untruncated(spread, threshold, components);
    // The condition that the model solves is flatter than that of untruncated data: see `Report`.
    let of_model = if spread > 0.0 {
        sigma * sigma / spread
    } else {
        0.0
    };
    (Some(sigma), rows.covariance(of_model))
}

/// Share of a Gaussian's variance that is left when vectors of `components` entries longer than
/// `cut` standard deviations are taken out.
///
/// It is P(k/2 + 1, x)/P(k/2, x) of the regularised incomplete gamma function with x = cut²/2, and by
/// the series of P (DLMF 8.7.1) equal to 1 − 1/S with S = 1 + x/(s+1) + x²/((s+1)(s+2)) + ..., s = k/2.
fn variance_left(cut: f64, components: f64) -> f64 {
    let x = cut * cut / 2.0;
    let (mut sum, mut term, mut divisor) = (1.0, 1.0, components / 2.0 + 1.0);
    while term > 1e-17 * sum {
        term *= x / divisor;
        sum += term;
        divisor += 1.0;
    }
    1.0 - 1.0 / sum
}

/// The σ of Gaussian vectors of `components` entries, of which those no longer than `threshold` are
/// seen, and have the standard deviation `spread` in each entry; at most the threshold.
fn untruncated(spread: f64, threshold: f64, components: f64) -> f64 {
    // Beyond six σ less than 1e-6 of the variance is lost.
    if !(spread * 6.0 > threshold) {
        return spread;
    }
    if !(spread * spread < threshold * threshold * variance_left(1.0, components)) {
        return threshold;
    }
    // What is seen grows with σ: a bracket of at most six to one, halved to a millionth.
    let (mut low, mut high) = (spread, threshold);
    for _ in 0..22 {
        let sigma = f64::midpoint(low, high);
        let seen = sigma * variance_left(threshold / sigma, components).sqrt();
        if seen < spread {
            low = sigma;
        } else {
            high = sigma;
        }
    }
    f64::midpoint(low, high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_truncation_leaves_is_the_textbooks() {
        // One component: 1 − 2aφ(a)/(2Φ(a) − 1).
        let one = 1.0 - 2.0 * 0.241_970_724_519_143_37 / 0.682_689_492_137_085_9;
        assert!((variance_left(1.0, 1.0) - one).abs() < 1e-12);
        // Two: 1 − x/(eˣ − 1) with x = a²/2.
        let two = 1.0 - 2.0 / (2.0_f64.exp() - 1.0);
        assert!((variance_left(2.0, 2.0) - two).abs() < 1e-12);
        assert!((variance_left(6.0, 1.0) - 1.0).abs() < 1e-6);
        // Evenly filled: a²/(k + 2).
        assert!((variance_left(1e-3, 3.0) - 1e-6 / 5.0).abs() < 1e-12);
    }

    #[test]
    fn the_noise_before_truncation_comes_back() {
        for components in [1.0, 1.5, 2.0, 3.0] {
            for cut in [1.1, 2.0, 3.0, 5.0, 8.0] {
                let spread = 0.2 * variance_left(cut, components).sqrt();
                let sigma = untruncated(spread, 0.2 * cut, components);
                assert!((sigma - 0.2).abs() < 1e-5, "{components} {cut} {sigma}");
            }
        }
        assert_eq!(untruncated(0.2, f64::INFINITY, 1.0), 0.2);
        assert_eq!(untruncated(0.5, 0.6, 1.0), 0.6);
        assert_eq!(untruncated(0.0, 0.0, 1.0), 0.0);
    }
}
