//! Medians, means, and how sure they are; NaN for no values.

/// The middle value, or the mean of the two in the middle.
pub(super) fn median(values: &[f64]) -> f64 {
    pomona_statistics::median(&mut values.to_vec()).unwrap_or(f64::NAN)
}

/// The arithmetic mean.
pub(super) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// The 95 % bootstrap interval of a statistic.
pub(super) fn interval(values: &[f64], statistic: fn(&[f64]) -> f64) -> [f64; 2] {
    let statistic = |resample: &mut [f64]| statistic(resample);
    pomona_statistics::bootstrap_interval(values, statistic).unwrap_or([f64::NAN; 2])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_nothing_there_is_no_number() {
        assert!(median(&[]).is_nan() && mean(&[]).is_nan());
        assert!(interval(&[], mean)[0].is_nan());
        assert_eq!(median(&[4.0, 1.0, 2.0, 3.0]), 2.5);
    }
}
