use crate::bootstrap::cluster_mean_interval;
use crate::quantile::quantile_of_sorted;
use serde::{Deserialize, Serialize};

/// Mean and standard deviation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct MeanSd {
    /// Arithmetic mean.
    pub mean: f64,
    /// Sample standard deviation (n − 1); 0 for a single value.
    pub sd: f64,
}

impl MeanSd {
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

/// The distribution of a sample in a few numbers, in the values' own unit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Summary {
    /// Number of values.
    pub count: usize,
    /// Arithmetic mean.
    pub mean: f64,
    /// 95 % percentile bootstrap interval of the mean; whole cases are resampled, not single values.
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
    /// Values of one case must stand together; the interval of the mean is that of [`cluster_mean_interval`].
    /// Median and percentile are quantiles of type 7.
    pub fn of(values: &[(usize, f64)]) -> Option<Self> {
        let mut sorted: Vec<f64> = values.iter().map(|&(_, v)| v).collect();
        let MeanSd { mean, sd } = MeanSd::of(&sorted)?;
        sorted.sort_by(f64::total_cmp);
        Some(Self {
            count: sorted.len(),
            mean,
            mean_interval: cluster_mean_interval(values)?,
            sd,
            median: quantile_of_sorted(&sorted, 0.5)?,
            p95: quantile_of_sorted(&sorted, 0.95)?,
            min: *sorted.first()?,
            max: *sorted.last()?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

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
        assert_eq!(MeanSd::of(&[]), None);
        assert_eq!(MeanSd::of(&[3.0]), Some(MeanSd { mean: 3.0, sd: 0.0 }));
    }

    proptest! {
        #[test]
        fn the_sd_is_that_of_the_differences_of_pairs(values in prop::collection::vec(-1e3..1e3_f64, 2..20)) {
            // Σᵢⱼ (xᵢ − xⱼ)² = 2 n (n − 1) s².
            let pairs: f64 = values.iter().flat_map(|a| values.iter().map(move |b| (a - b).powi(2))).sum();
            let n = values.len() as f64;
            let s = MeanSd::of(&values).unwrap();
            prop_assert!((pairs - 2.0 * n * (n - 1.0) * s.sd * s.sd).abs() <= 1e-9 * (1.0 + pairs));
        }
    }
}
