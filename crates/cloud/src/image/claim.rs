use pomona_files::Malformed;

/// Refuses a picture whose header claims more than `per_byte` times the file's size,
/// before anything of that size is allocated.
pub(super) fn check_claim(
    width: usize,
    height: usize,
    bytes: &[u8],
    per_byte: usize,
) -> Result<(), Malformed> {
    let limit = bytes.len().saturating_mul(per_byte);
    let claim = width.checked_mul(height);
    if width == 0 || height == 0 || claim.is_none_or(|pixels| pixels > limit) {
        let problem = format!(
            "the header claims {width}x{height} pixels, which {} bytes cannot hold",
            bytes.len()
        );
        return Err(Malformed::new(
            "header",
            problem,
            "write the picture again; this file is damaged",
        ));
    }
    Ok(())
}
