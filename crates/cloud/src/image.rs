//! Image files as bytes: PNG in and out, JPEG in.

mod jpeg;
pub(crate) mod png;

use crate::ColorImage;
use crate::error::Fault;

pub(crate) fn parse_color(bytes: &[u8]) -> Result<ColorImage, Fault> {
    if bytes.starts_with(PNG) {
        png::parse_color(bytes)
    } else if bytes.starts_with(JPEG) {
        jpeg::parse(bytes)
    } else {
        Err(neither())
    }
}

/// Width and height that the header states.
pub(crate) fn parse_size(bytes: &[u8]) -> Result<(usize, usize), Fault> {
    if bytes.starts_with(PNG) {
        png::parse_size(bytes)
    } else if bytes.starts_with(JPEG) {
        jpeg::parse_size(bytes)
    } else {
        Err(neither())
    }
}

const PNG: &[u8] = b"\x89PNG";
const JPEG: &[u8] = b"\xff\xd8";

fn neither() -> Fault {
    Fault::new(
        "byte 0",
        "neither a PNG nor a JPEG",
        "convert the picture to one of them",
    )
}

/// Refuses a picture whose header claims more than `per_byte` times the file's size,
/// before anything of that size is allocated.
fn check_claim(width: usize, height: usize, bytes: &[u8], per_byte: usize) -> Result<(), Fault> {
    let limit = bytes.len().saturating_mul(per_byte);
    let claim = width.checked_mul(height);
    if width == 0 || height == 0 || claim.is_none_or(|pixels| pixels > limit) {
        let problem = format!(
            "the header claims {width}x{height} pixels, which {} bytes cannot hold",
            bytes.len()
        );
        return Err(Fault::new(
            "header",
            problem,
            "write the picture again; this file is damaged",
        ));
    }
    Ok(())
}

#[cfg(test)]
mod tests;
