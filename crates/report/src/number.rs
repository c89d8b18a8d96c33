//! Numbers as cells of a table.

use pomona_statistics::{Proportion, Summary};

/// The cell of an unknown number.
pub const UNKNOWN: &str = "–";

/// Metres as millimetres.
pub fn mm(metres: f64) -> String {
    format!("{:.2}", metres * 1000.0)
}

/// Radians as degrees.
pub fn degrees(radians: f64) -> String {
    format!("{:.2}", radians.to_degrees())
}

/// A share as per cent.
pub fn percent(share: f64) -> String {
    format!("{:.1}", 100.0 * share)
}

/// A proportion as per cent with its interval below it.
pub fn with_interval(share: &Proportion) -> String {
    format!(
        "{}\n{}–{}",
        percent(share.share),
        percent(share.low),
        percent(share.high)
    )
}

/// The mean of a summary with its interval below it, each written by `form`.
pub fn mean_with_interval(summary: &Summary, form: fn(f64) -> String) -> String {
    let [low, high] = summary.mean_interval;
    format!("{}\n{} to {}", form(summary.mean), form(low), form(high))
}

/// The value written by `form`, or [`UNKNOWN`].
pub fn or_unknown<T>(value: Option<T>, form: impl Fn(T) -> String) -> String {
    value.map_or_else(|| UNKNOWN.to_owned(), form)
}
