use std::f64::consts::PI;

/// Halvings of the interval in which a critical value is sought: enough for the last digit.
const HALVINGS: usize = 64;

/// The probability that a chi-square of `degrees` degrees of freedom exceeds `x`.
///
/// Abramowitz and Stegun 1964, 26.4.4 and 26.4.5: finite sums, with the complementary error function for odd
/// degrees. 1 for `x ≤ 0`; without degrees of freedom a chi-square is 0, and so is the probability for `x > 0`.
pub fn chi_square_survival(x: f64, degrees: u32) -> f64 {
    if x <= 0.0 {
        return 1.0;
    }
    let half = 0.5 * x;
    // Q(x | k + 2) = Q(x | k) + (x/2)^(k/2) e^(−x/2) / Γ(k/2 + 1); the first term, and k, of the sum.
    let (mut survival, mut term, mut k) = if degrees % 2 == 1 {
        let term = (2.0 * x / PI).sqrt() * (-half).exp();
        (libm::erfc(half.sqrt()), term, 1)
    } else {
        (0.0, (-half).exp(), 0)
    };
    while k < degrees {
        survival += term;
        k += 2;
        term *= half / (0.5 * f64::from(k));
    }
    survival
}

/// The critical value that a chi-square of `degrees` degrees of freedom exceeds with probability `rate`.
///
/// Infinite for a rate of 0, and 0 for a rate of 1 and more. NaN for a rate that is negative or NaN.
pub fn chi_square_critical(rate: f64, degrees: u32) -> f64 {
    if !(rate >= 0.0) {
        return f64::NAN;
    }
    if rate == 0.0 || rate >= 1.0 {
        return if rate == 0.0 { f64::INFINITY } else { 0.0 };
    }
    if degrees == 2 {
        return -2.0 * rate.ln();
    }
    let mut high = 1.0;
    while chi_square_survival(high, degrees) > rate {
        high *= 2.0;
    }
    let mut low = 0.0;
    for _ in 0..HALVINGS {
        let middle = f64::midpoint(low, high);
        if chi_square_survival(middle, degrees) > rate {
            low = middle;
        } else {
            high = middle;
        }
    }
    f64::midpoint(low, high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn critical_values_are_those_of_the_tables() {
        // Abramowitz and Stegun 1964, table 26.8.
        for (rate, degrees, value) in [
            (0.5, 1, 0.454_937),
            (0.05, 1, 3.841_46),
            (0.05, 2, 5.991_47),
            (0.001, 2, 13.815_5),
            (0.5, 3, 2.365_97),
            (0.05, 3, 7.814_73),
            (0.001, 3, 16.266_2),
            (0.05, 4, 9.487_73),
            (0.005, 6, 18.547_6),
            (0.05, 10, 18.307_0),
            (0.99, 10, 2.558_21),
        ] {
            let found = chi_square_critical(rate, degrees);
            assert!(
                (found - value).abs() < 1e-5 * value.max(10.0),
                "{degrees} at {rate}: {found}"
            );
        }
    }

    #[test]
    fn rates_at_the_ends() {
        for degrees in 1..5 {
            assert_eq!(chi_square_critical(1.0, degrees), 0.0);
            assert!(chi_square_critical(f64::NAN, degrees).is_nan());
            assert!(chi_square_critical(-0.1, degrees).is_nan());
            assert_eq!(chi_square_critical(0.0, degrees), f64::INFINITY);
            assert_eq!(chi_square_survival(-1.0, degrees), 1.0);
        }
        assert_eq!(chi_square_survival(1.0, 0), 0.0);
    }

    proptest! {
        #[test]
        fn the_survival_at_a_critical_value_is_its_rate(rate in 1e-6..1.0_f64, degrees in 1..12_u32) {
            let found = chi_square_survival(chi_square_critical(rate, degrees), degrees);
            prop_assert!((found - rate).abs() < 1e-9);
        }

        #[test]
        fn the_slope_of_the_survival_is_the_density(x in 0.1..30.0_f64, half in 1..6_u32) {
            // x^(k/2 − 1) e^(−x/2) / (2^(k/2) Γ(k/2)) for k = 2 half, whose Γ is a factorial.
            let factorial: f64 = (1..half).map(f64::from).product();
            let density = (0.5 * x).powi(half as i32 - 1) * (-0.5 * x).exp() / (2.0 * factorial);
            let step = 1e-5;
            let survival = |x| chi_square_survival(x, 2 * half);
            let slope = (survival(x - step) - survival(x + step)) / (2.0 * step);
            prop_assert!((slope - density).abs() < 1e-6);
        }
    }
}
