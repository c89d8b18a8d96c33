//! How improbable a small number of inliers among the first data is.

/// ln n! for a whole number n that is not negative.
fn log_factorial(n: f64) -> f64 {
    /// From here on three terms of Stirling's series are exact to 10⁻⁹.
    const FEW: f64 = 8.0;
    const FACTORIALS: [f64; 8] = [1.0, 1.0, 2.0, 6.0, 24.0, 120.0, 720.0, 5040.0];
    /// ½ ln 2π.
    const HALF_LOG_TAU: f64 = 0.918_938_533_204_672_7;
    if n < FEW {
        return FACTORIALS[n as usize].ln();
    }
    let square = n * n;
    let series = (1.0 / 12.0 - (1.0 / 360.0 - 1.0 / (1260.0 * square)) / square) / n;
    (n + 0.5) * n.ln() - n + HALF_LOG_TAU + series
}

fn log_choose(n: f64, k: f64) -> f64 {
    log_factorial(n) - log_factorial(k) - log_factorial(n - k)
}

/// ln of an upper bound of the probability that of `seen` data drawn from `data`, of which `marked` are marked,
/// at most `found` are marked; all are whole numbers.
///
/// From the last to the first the terms of the hypergeometric distribution fall ever faster, each to a
/// smaller part of the one before: with ρ the first such part, their sum is at most the last one over 1 − ρ. Where
/// `found` is no less than the most probable number the bound is 1. It grows with `found` and
/// falls with `marked`.
pub(super) fn log_tail(seen: f64, found: f64, marked: f64, data: f64) -> f64 {
    let (others, missed) = (data - marked, seen - found);
    if missed > others {
        return f64::NEG_INFINITY;
    }
    let part = found * (others - missed) / ((marked - found + 1.0) * (missed + 1.0));
    // Written so that NaN gives 1 as well.
    if !((0.0..1.0).contains(&part) && found <= marked) {
        return 0.0;
    }
    let last = log_choose(marked, found) + log_choose(others, missed) - log_choose(data, seen);
    (last - (-part).ln_1p()).min(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factorials_are_those_of_their_definition() {
        let mut sum = 0.0;
        for n in 1..200 {
            sum += f64::from(n).ln();
            assert!((log_factorial(f64::from(n)) - sum).abs() < 1e-8, "{n}");
        }
        assert_eq!(log_factorial(0.0), 0.0);
    }

    #[test]
    fn the_tail_is_bounded_closely_and_never_passed() {
        for (seen, marked, data) in [
            (20, 9, 60),
            (64, 100, 500),
            (128, 700, 4000),
            (300, 80, 400),
        ] {
            let term = |found: i32| {
                let [s, f, m, d] = [seen, found, marked, data].map(f64::from);
                if seen - found > data - marked {
                    return 0.0;
                }
                (log_choose(m, f) + log_choose(d - m, s - f) - log_choose(d, s)).exp()
            };
            let mut exact = 0.0;
            for found in 0..=seen.min(marked) {
                exact += term(found);
                let [s, f, m, d] = [seen, found, marked, data].map(f64::from);
                let bound = log_tail(s, f, m, d).exp();
                assert!(
                    bound >= exact * (1.0 - 1e-7),
                    "{seen} {found}: {bound} {exact}"
                );
                if exact < 0.01 {
                    assert!(bound <= exact * 1.35, "{seen} {found}: {bound} {exact}");
                }
            }
            assert!((exact - 1.0).abs() < 1e-6, "{exact}");
        }
    }

    #[test]
    fn what_cannot_be_is_certain_not_to_be() {
        assert_eq!(log_tail(90.0, 0.0, 20.0, 100.0), f64::NEG_INFINITY);
        assert_eq!(log_tail(90.0, 50.0, 20.0, 100.0), 0.0);
        assert_eq!(log_tail(f64::NAN, 1.0, 20.0, 100.0), 0.0);
    }
}
