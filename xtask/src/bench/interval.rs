//! Medians, means, and how sure they are.

/// The middle value, or the mean of the two in the middle; NaN for none.
pub(super) fn median(values: &[f64]) -> f64 {
    let mut values = values.to_vec();
    values.sort_by(f64::total_cmp);
    let n = values.len();
    match n {
        0 => f64::NAN,
        _ if n % 2 == 1 => values[n / 2],
        _ => f64::midpoint(values[n / 2 - 1], values[n / 2]),
    }
}

/// NaN for none.
pub(super) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// The 95 % interval of a statistic, by bootstrap: 2000 draws with replacement, the same ones every time.
///
/// Efron and Tibshirani 1993, "An Introduction to the Bootstrap", chapter 13.
pub(super) fn interval(values: &[f64], statistic: fn(&[f64]) -> f64) -> [f64; 2] {
    const DRAWS: usize = 2000;
    if values.is_empty() {
        return [f64::NAN; 2];
    }
    let mut state = 0_u64;
    let mut draws: Vec<f64> = (0..DRAWS)
        .map(|_| {
            let draw: Vec<f64> = (0..values.len())
                .map(|_| values[(splitmix(&mut state) % values.len() as u64) as usize])
                .collect();
            statistic(&draw)
        })
        .collect();
    draws.sort_by(f64::total_cmp);
    [draws[DRAWS / 40], draws[DRAWS - 1 - DRAWS / 40]]
}

/// The generator splitmix64 (Steele, Lea and Flood 2014, doi 10.1145/2714064.2660195).
fn splitmix(state: &mut u64) -> u64 {
    *state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let mut z = *state;
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_middle() {
        assert_eq!(median(&[3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(&[4.0, 1.0, 2.0, 3.0]), 2.5);
        assert!(median(&[]).is_nan());
    }

    #[test]
    fn the_interval_is_that_of_the_normal_mean() {
        // The numbers 0..100: standard error of the mean 2.89, so 49.5 ± 5.66.
        let values: Vec<f64> = (0..100).map(f64::from).collect();
        let [low, high] = interval(&values, mean);
        assert!(
            (low - 43.8).abs() < 0.6 && (high - 55.2).abs() < 0.6,
            "{low} {high}"
        );
        assert_eq!(interval(&[2.0; 5], median), [2.0, 2.0]);
    }
}
