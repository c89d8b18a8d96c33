//! What the pages of detectors and segmenters share: the colours of curves, and figures with intervals as cells.

use crate::resampling::Estimate;
use pomona_report::number::{or_unknown, percent};
use pomona_report::plot::{BLUE, GREEN, ORANGE, RED, Rgb, VIOLET};

/// Colours of the curves, in turn.
pub(crate) const COLORS: [(Rgb, &str); 5] = [
    (RED, "red"),
    (BLUE, "blue"),
    (GREEN, "green"),
    (ORANGE, "orange"),
    (VIOLET, "violet"),
];

/// A share in percent, and its interval below it.
pub(crate) fn estimate(estimate: Option<Estimate>) -> String {
    or_unknown(estimate, |e| {
        format!(
            "{}\n{}–{}",
            percent(e.value),
            percent(e.low),
            percent(e.high)
        )
    })
}

/// A difference of shares in percent, and its interval below it.
pub(crate) fn difference(estimate: &Estimate) -> String {
    let [value, low, high] = [estimate.value, estimate.low, estimate.high].map(|v| 100.0 * v);
    format!("{value:+.1}\n{low:+.1} to {high:+.1}")
}
