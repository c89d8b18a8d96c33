use pomona_statistics::{Proportion, Summary};
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// The bounds of the shares that section 3 of the paper states, radians.
const BOUND_10_DEG: f64 = 10.0 * PI / 180.0;
const BOUND_20_DEG: f64 = 20.0 * PI / 180.0;
const BOUND_50_DEG: f64 = 50.0 * PI / 180.0;

/// Angle errors and the shares that the paper states.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct AngleErrors {
    /// The errors.
    pub error: Summary,
    /// Of the answers, those at most 10° off.
    pub within_10_deg: Proportion,
    /// Of the answers, those at most 20° off.
    pub within_20_deg: Proportion,
    /// Of the answers, those 50° off or more.
    pub at_least_50_deg: Proportion,
}

impl AngleErrors {
    /// The statistics of angle errors, each with its case; `None` where there are none.
    pub(crate) fn of(errors: &[(usize, f64)]) -> Option<Self> {
        let plain: Vec<f64> = errors.iter().map(|&(_, e)| e).collect();
        Some(Self {
            error: Summary::of(errors)?,
            within_10_deg: Proportion::of(&plain, |e| e <= BOUND_10_DEG),
            within_20_deg: Proportion::of(&plain, |e| e <= BOUND_20_DEG),
            at_least_50_deg: Proportion::of(&plain, |e| e >= BOUND_50_DEG),
        })
    }
}
