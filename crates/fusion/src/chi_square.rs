//! Bounds of squared Mahalanobis distances.

use std::f64::consts::PI;

/// The value that a chi-square of two degrees of freedom exceeds with probability `rate`.
pub(crate) fn bound_2(rate: f64) -> f64 {
    -2.0 * rate.ln()
}

/// The same for three degrees of freedom.
pub(crate) fn bound_3(rate: f64) -> f64 {
    let (mut low, mut high) = (0.0, 1000.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if tail_3(middle) > rate {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

/// P(χ²₃ > x) = erfc(√(x/2)) + √(2x/π) e^(−x/2).
fn tail_3(x: f64) -> f64 {
    erfc((0.5 * x).sqrt()) + (2.0 * x / PI).sqrt() * (-0.5 * x).exp()
}

/// Complementary error function for x ≥ 0, relative error below 1.2e-7.
///
/// Source: Press et al., Numerical Recipes, 2nd edition, section 6.2, `erfcc`.
fn erfc(x: f64) -> f64 {
    const C: [f64; 10] = [
        -1.265_512_23,
        1.000_023_68,
        0.374_091_96,
        0.096_784_18,
        -0.186_288_06,
        0.278_868_07,
        -1.135_203_98,
        1.488_515_87,
        -0.822_152_23,
        0.170_872_77,
    ];
    let t = 1.0 / (1.0 + 0.5 * x);
    let sum = C.iter().rev().fold(0.0, |sum, c| sum * t + c);
    t * (-x * x + sum).exp()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_are_those_of_the_tables() {
        assert!((bound_2(0.05) - 5.991_5).abs() < 1e-3);
        assert!((bound_3(0.05) - 7.814_7).abs() < 1e-3);
        assert!((bound_3(0.001) - 16.266_2).abs() < 1e-3);
    }
}
