use crate::quantile::quantile_of_sorted;
use rand_chacha::ChaCha8Rng;
use rand_core::{Rng, SeedableRng};

/// Resamples of a bootstrap interval: enough for its ends to be stable in the second digit.
pub const RESAMPLES: usize = 2000;

/// Tail on either side of a 95 % interval.
const TAIL_95: f64 = 0.025;

/// A uniform number below `n`, which is from 1 to 2³²; the bias of the product is under n / 2³².
pub fn uniform_below<R: Rng + ?Sized>(rng: &mut R, n: usize) -> usize {
    ((u64::from(rng.next_u32()) * n as u64) >> 32) as usize
}

/// Draws as many things as `counts` has places, with replacement, and counts how often each was drawn.
pub fn draw_counts<R: Rng + ?Sized>(rng: &mut R, counts: &mut [u64]) {
    counts.fill(0);
    for _ in 0..counts.len() {
        counts[uniform_below(rng, counts.len())] += 1;
    }
}

/// The 95 % percentile interval of the statistics of resamples: their 2.5 % and 97.5 % quantiles (type 7).
///
/// Efron and Tibshirani 1993, "An Introduction to the Bootstrap", chapter 13. Sorts `resampled`; `None` for none.
pub fn percentile_interval(resampled: &mut [f64]) -> Option<[f64; 2]> {
    resampled.sort_unstable_by(f64::total_cmp);
    let low = quantile_of_sorted(resampled, TAIL_95)?;
    let high = quantile_of_sorted(resampled, 1.0 - TAIL_95)?;
    Some([low, high])
}

/// The 95 % percentile bootstrap interval of `statistic`, which may reorder the resample it is given; `None` for no
/// values.
///
/// The draws are seeded by a constant: the same values give the same interval.
pub fn bootstrap_interval(
    values: &[f64],
    mut statistic: impl FnMut(&mut [f64]) -> f64,
) -> Option<[f64; 2]> {
    if values.is_empty() {
        return None;
    }
    let mut rng = ChaCha8Rng::seed_from_u64(0);
    let mut resample = vec![0.0; values.len()];
    let mut resampled: Vec<f64> = (0..RESAMPLES)
        .map(|_| {
            resample.fill_with(|| values[uniform_below(&mut rng, values.len())]);
            statistic(&mut resample)
        })
        .collect();
    percentile_interval(&mut resampled)
}

/// The 95 % percentile bootstrap interval of the mean of values that each belong to a case; `None` for no values.
///
/// Values of one case share its noise, so whole cases are resampled (cluster bootstrap; Davison and Hinkley 1997,
/// "Bootstrap Methods and their Application", section 3.8). They must stand together. The draws are seeded by a
/// constant: the same values give the same interval.
pub fn cluster_mean_interval(values: &[(usize, f64)]) -> Option<[f64; 2]> {
    let cases: Vec<(f64, f64)> = values
        .chunk_by(|a, b| a.0 == b.0)
        .map(|of_case| (of_case.iter().map(|v| v.1).sum(), of_case.len() as f64))
        .collect();
    if cases.is_empty() {
        return None;
    }
    let mut rng = ChaCha8Rng::seed_from_u64(0);
    let mut means: Vec<f64> = (0..RESAMPLES)
        .map(|_| {
            let (mut sum, mut count) = (0.0, 0.0);
            for _ in 0..cases.len() {
                let (s, n) = cases[uniform_below(&mut rng, cases.len())];
                sum += s;
                count += n;
            }
            sum / count
        })
        .collect();
    percentile_interval(&mut means)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quantile::median;
    use proptest::prelude::*;

    #[test]
    fn cases_are_resampled_and_not_values() {
        // Ten equal values in each of two cases: by values the interval would be narrow.
        let values: Vec<_> = (0..20)
            .map(|i| (i / 10, f64::from(u8::from(i >= 10))))
            .collect();
        assert_eq!(cluster_mean_interval(&values), Some([0.0, 1.0]));
        assert_eq!(
            cluster_mean_interval(&values),
            cluster_mean_interval(&values)
        );
        assert_eq!(cluster_mean_interval(&[]), None);
    }

    #[test]
    fn the_interval_is_that_of_the_normal_mean() {
        // The numbers 0..100: standard error of the mean 2.89, so 49.5 ± 5.66.
        let values: Vec<f64> = (0..100).map(f64::from).collect();
        let mean = |values: &mut [f64]| values.iter().sum::<f64>() / values.len() as f64;
        let [low, high] = bootstrap_interval(&values, mean).unwrap();
        assert!(
            (low - 43.8).abs() < 0.6 && (high - 55.2).abs() < 0.6,
            "{low} {high}"
        );
        let middle = |values: &mut [f64]| median(values).unwrap();
        assert_eq!(bootstrap_interval(&[2.0; 5], middle), Some([2.0, 2.0]));
        assert_eq!(bootstrap_interval(&[], mean), None);
    }

    #[test]
    fn every_place_is_drawn_about_equally_often() {
        let mut rng = ChaCha8Rng::seed_from_u64(3);
        let mut counts = [0; 5];
        let mut sums = [0; 5];
        for _ in 0..10_000 {
            draw_counts(&mut rng, &mut counts);
            assert_eq!(counts.iter().sum::<u64>(), 5);
            for (sum, count) in sums.iter_mut().zip(counts) {
                *sum += count;
            }
        }
        // 50 000 draws of probability 1/5: standard deviation 89.
        assert!(
            sums.iter().all(|&s| (9_600..10_400).contains(&s)),
            "{sums:?}"
        );
    }

    proptest! {
        #[test]
        fn a_mean_lies_within_the_range_and_shifts_with_the_values(
            values in prop::collection::vec((0..4_usize, -10.0..10.0_f64), 1..20), shift in -5.0..5.0_f64,
        ) {
            let [low, high] = cluster_mean_interval(&values).unwrap();
            let (least, most) = values.iter().fold((f64::MAX, f64::MIN), |(l, m), v| (l.min(v.1), m.max(v.1)));
            prop_assert!(least - 1e-9 <= low && low <= high && high <= most + 1e-9);
            let moved: Vec<_> = values.iter().map(|&(case, v)| (case, v + shift)).collect();
            let [l, h] = cluster_mean_interval(&moved).unwrap();
            prop_assert!((l - low - shift).abs() < 1e-9 && (h - high - shift).abs() < 1e-9);
        }
    }
}
