use crate::{Share, Summary};

/// What stands where nothing is known.
pub(super) const UNKNOWN: &str = "–";

/// Millimetres of metres.
pub(super) fn mm(metres: f64) -> String {
    format!("{:.2}", metres * 1000.0)
}

/// Degrees of radians.
pub(super) fn degrees(radians: f64) -> String {
    format!("{:.2}", radians.to_degrees())
}

/// Per cent of a share.
pub(super) fn percent(share: f64) -> String {
    format!("{:.1}", 100.0 * share)
}

/// A share in per cent with its interval below it.
pub(super) fn with_interval(share: &Share) -> String {
    format!(
        "{}\n{}–{}",
        percent(share.share),
        percent(share.low),
        percent(share.high)
    )
}

/// A summary's mean in the unit of `form` with its interval below it.
pub(super) fn mean_with_interval(summary: &Summary, form: fn(f64) -> String) -> String {
    let [low, high] = summary.mean_interval;
    format!("{}\n{} to {}", form(summary.mean), form(low), form(high))
}

/// What is known in its form, or the mark of the unknown.
pub(super) fn or_unknown<T>(value: Option<T>, form: impl Fn(T) -> String) -> String {
    value.map_or_else(|| UNKNOWN.to_owned(), form)
}
