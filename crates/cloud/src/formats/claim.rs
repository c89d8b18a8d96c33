use pomona_files::Malformed;

/// Refuses a header whose points need more bytes than the file has left, before any
/// memory is taken for them.
pub(super) fn check_claim(points: u64, bytes_each: u64, available: usize) -> Result<(), Malformed> {
    let needed = points.checked_mul(bytes_each);
    if needed.is_some_and(|needed| needed <= available as u64) {
        return Ok(());
    }
    let needed = needed.map_or_else(|| "more than 2^64".to_owned(), |n| n.to_string());
    let problem = format!(
        "the header claims {points} points, {needed} bytes at least, but {available} follow it"
    );
    Err(Malformed::new(
        "header",
        problem,
        "write the cloud again; this file is cut short or damaged",
    ))
}
