//! Quantiles, means, intervals and the chi-square distribution.
//!
//! ```
//! use pomona_statistics::{Proportion, Summary, median, quantile};
//!
//! let mut errors = [0.4, 2.5, 1.1, 0.9];
//! assert_eq!(median(&mut errors), Some(1.0));
//! assert_eq!(quantile(&mut errors, 0.75), Some(1.4500000000000002));
//! assert_eq!(median(&mut []), None);
//!
//! // Each value belongs to a case; intervals resample whole cases.
//! let summary = Summary::of(&[(0, 0.4), (0, 2.5), (1, 1.1), (2, 0.9)]).unwrap();
//! assert_eq!((summary.count, summary.median), (4, 1.0));
//!
//! // 81 of 263, with Wilson's interval.
//! let share = Proportion::new(81, 263);
//! assert!(share.low > 0.25 && share.high < 0.37);
//! ```
//!
//! # Concepts
//!
//! - **Quantiles** are named after their definition, since several are in use and differ for small samples.
//!   [`quantile`] interpolates (type 7 of Hyndman and Fan, what R, NumPy and Julia give); [`lower_quantile`],
//!   [`nearest_quantile`] and [`inverse_cdf`] give one of the values. They select in place, without sorting and
//!   without allocating.
//! - [`Summary`], [`MeanSd`] and [`Proportion`] are what tables print, with 95 % intervals.
//! - **Bootstrap**: [`cluster_mean_interval`] resamples whole cases; [`draw_counts`] and [`percentile_interval`]
//!   serve statistics other than means.
//! - [`chi_square_survival`] and [`chi_square_critical`] bound squared Mahalanobis distances.
//!
//! Empty input gives `None`. NaN is ordered of [`f64::total_cmp`]: positive NaN is above all numbers.
//!
//! # Not here
//!
//! Robust estimation (`pomona-ransac`), least squares (`pomona-fit`). `pomona-ransac` has a median of its own, since it
//! depends on `rand_core` alone.
//!
//! # References
//!
//! Hyndman and Fan 1996, "Sample Quantiles in Statistical Packages", The American Statistician 50(4), 361–365.

mod bootstrap;
mod chi_square;
mod proportion;
mod quantile;
mod summary;

pub use bootstrap::{
    RESAMPLES, bootstrap_interval, cluster_mean_interval, draw_counts, percentile_interval,
    uniform_below,
};
pub use chi_square::{chi_square_critical, chi_square_survival};
pub use proportion::Proportion;
pub use quantile::{
    TotalOrder, inverse_cdf, lower_median, lower_quantile, median, nearest_quantile, quantile,
    quantile_of_sorted, upper_median,
};
pub use summary::{MeanSd, Summary};
