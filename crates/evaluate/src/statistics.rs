use rand_chacha::ChaCha8Rng;
use rand_core::{Rng, SeedableRng};
use serde::{Deserialize, Serialize};

/// Resamples of a bootstrap interval: enough for its ends to stand still in the second digit.
pub(crate) const RESAMPLES: usize = 2000;

/// Two-sided 95 % quantile of the normal distribution.
const NORMAL_95: f64 = 1.959_963_984_540_054;

/// What a set of values looks like, in the values' own unit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// How many values.
    pub count: usize,
    /// Arithmetic mean.
    pub mean: f64,
    /// 95 % percentile bootstrap interval of the mean; whole cases are drawn, not single apples.
    pub mean_interval: [f64; 2],
    /// Sample standard deviation (n − 1); 0 for a single value.
    pub sd: f64,
    /// Median.
    pub median: f64,
    /// 95th percentile.
    pub p95: f64,
    /// Smallest value.
    pub min: f64,
    /// Largest value.
    pub max: f64,
}

impl Summary {
    /// Summarises values that each belong to a case; `None` where there are none.
    ///
    /// Apples of one frame share its noise, its light and its camera error, so the interval
    /// resamples cases (cluster bootstrap; Davison and Hinkley 1997, section 3.8).
    /// Values of one case must stand together.
    pub fn of(values: &[(usize, f64)]) -> Option<Self> {
        let plain: Vec<f64> = values.iter().map(|&(_, v)| v).collect();
        let spread = Spread::of(&plain)?;
        let mut sorted = plain;
        sorted.sort_by(f64::total_cmp);
        Some(Self {
            count: sorted.len(),
            mean: spread.mean,
            mean_interval: bootstrap_mean(values),
            sd: spread.sd,
            median: quantile(&sorted, 0.5),
            p95: quantile(&sorted, 0.95),
            min: sorted[0],
            max: sorted[sorted.len() - 1],
        })
    }
}

/// Mean and standard deviation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Spread {
    /// Arithmetic mean.
    pub mean: f64,
    /// Sample standard deviation (n − 1); 0 for a single value.
    pub sd: f64,
}

impl Spread {
    /// Mean and standard deviation of `values`; `None` where there are none.
    pub fn of(values: &[f64]) -> Option<Self> {
        if values.is_empty() {
            return None;
        }
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let squares: f64 = values.iter().map(|v| (v - mean).powi(2)).sum();
        let sd = if values.len() > 1 {
            (squares / (n - 1.0)).sqrt()
        } else {
            0.0
        };
        Some(Self { mean, sd })
    }
}

/// A share of a whole with its 95 % Wilson interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Share {
    /// How many.
    pub count: usize,
    /// Of how many.
    pub of: usize,
    /// `count / of`; 0 where `of` is 0.
    pub share: f64,
    /// Lower end of the interval.
    pub low: f64,
    /// Upper end of the interval.
    pub high: f64,
}

impl Share {
    /// `count` of `of`, with the score interval of Wilson (1927), J. Am. Stat. Assoc. 22, 209–212.
    pub fn new(count: usize, of: usize) -> Self {
        if of == 0 {
            return Self {
                count,
                of,
                share: 0.0,
                low: 0.0,
                high: 1.0,
            };
        }
        let (n, z2) = (of as f64, NORMAL_95 * NORMAL_95);
        let p = count as f64 / n;
        let middle = (p + z2 / (2.0 * n)) / (1.0 + z2 / n);
        let half = NORMAL_95 / (1.0 + z2 / n) * (p * (1.0 - p) / n + z2 / (4.0 * n * n)).sqrt();
        // At 0 and at 1 the closed form gives the bound itself, but for rounding.
        let low = if count == 0 {
            0.0
        } else {
            (middle - half).max(0.0)
        };
        let high = if count == of {
            1.0
        } else {
            (middle + half).min(1.0)
        };
        Self {
            count,
            of,
            share: p,
            low,
            high,
        }
    }

    /// The share of `values` that `holds` is true for.
    pub fn of(values: &[f64], holds: impl Fn(f64) -> bool) -> Self {
        Self::new(values.iter().filter(|&&v| holds(v)).count(), values.len())
    }
}

/// Quantile of ascending values, linear between neighbours (type 7 of Hyndman and Fan 1996).
///
/// # Panics
///
/// Where `sorted` is empty.
pub(crate) fn quantile(sorted: &[f64], q: f64) -> f64 {
    let place = q * (sorted.len() - 1) as f64;
    let (low, high) = (place.floor() as usize, place.ceil() as usize);
    sorted[low] + (sorted[high] - sorted[low]) * (place - low as f64)
}

/// 95 % percentile bootstrap interval of the mean, drawing whole cases.
///
/// The draws are seeded by a constant: the same values give the same interval.
pub(crate) fn bootstrap_mean(values: &[(usize, f64)]) -> [f64; 2] {
    let clusters: Vec<(f64, f64)> = values
        .chunk_by(|a, b| a.0 == b.0)
        .map(|of_case| (of_case.iter().map(|v| v.1).sum(), of_case.len() as f64))
        .collect();
    if clusters.is_empty() {
        return [0.0; 2];
    }
    let mut rng = ChaCha8Rng::seed_from_u64(0);
    let mut means: Vec<f64> = (0..RESAMPLES)
        .map(|_| {
            let (mut sum, mut count) = (0.0, 0.0);
            for _ in 0..clusters.len() {
                let (s, n) = clusters[below(&mut rng, clusters.len())];
                sum += s;
                count += n;
            }
            sum / count
        })
        .collect();
    means.sort_by(f64::total_cmp);
    [quantile(&means, 0.025), quantile(&means, 0.975)]
}

/// A number below `n`, n under 2³²; the bias of the product form is under n / 2³².
pub(crate) fn below(rng: &mut ChaCha8Rng, n: usize) -> usize {
    ((u64::from(rng.next_u32()) * n as u64) >> 32) as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(a: f64, b: f64) -> bool {
        (a - b).abs() < 1e-4
    }

    #[test]
    fn known_summary() {
        // R: x <- c(2, 4, 4, 4, 5, 5, 7, 9); mean 5, sd 2.13809, quantile(x, .95) 8.3.
        let values: Vec<_> = [2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0]
            .into_iter()
            .enumerate()
            .collect();
        let s = Summary::of(&values).unwrap();
        assert!(close(s.mean, 5.0) && close(s.sd, 2.138_09) && close(s.median, 4.5));
        assert!(close(s.p95, 8.3) && s.min == 2.0 && s.max == 9.0);
        assert!(s.mean_interval[0] > 3.0 && s.mean_interval[1] < 7.0);
        assert!(s.mean_interval[0] < 5.0 && s.mean_interval[1] > 5.0);
        assert_eq!(Summary::of(&[]), None);
    }

    #[test]
    fn wilson_intervals_as_published() {
        // Newcombe 1998, Stat. Med. 17, table I, method 3: 81/263, 15/148, 0/20, 1/29.
        for (count, of, low, high) in [
            (81, 263, 0.2553, 0.3662),
            (15, 148, 0.0624, 0.1605),
            (0, 20, 0.0, 0.1611),
            (1, 29, 0.0061, 0.1718),
        ] {
            let share = Share::new(count, of);
            assert!(
                close(share.low, low) && close(share.high, high),
                "{share:?}"
            );
        }
        assert_eq!(Share::new(7, 7).high, 1.0);
        assert_eq!(Share::new(0, 0).share, 0.0);
    }

    #[test]
    fn the_bootstrap_draws_cases_not_apples() {
        // Ten equal values in each of two cases: by apples the interval would be narrow.
        let values: Vec<_> = (0..20)
            .map(|i| (i / 10, f64::from(u8::from(i >= 10))))
            .collect();
        assert_eq!(bootstrap_mean(&values), [0.0, 1.0]);
        assert_eq!(bootstrap_mean(&values), bootstrap_mean(&values));
    }
}
