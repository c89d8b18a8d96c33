//! Colour images in files.

use super::{jpeg, png};
use crate::{CloudError, ColorImage};
use pomona_files::{Malformed, write_atomically};
use std::path::Path;

impl ColorImage {
    /// Reads a PNG or a JPEG, recognised by content.
    ///
    /// Grey, palette and 16-bit PNGs become 8-bit RGB; an alpha channel is dropped.
    /// The orientation in EXIF data is not applied, since depth would not follow it; see
    /// [`ColorImage::turned_by_exif`].
    ///
    /// # Errors
    ///
    /// [`CloudError::File`], also for what is neither, or is cut short.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, CloudError> {
        let path = path.as_ref();
        let bytes = pomona_files::read(path)?;
        Ok(parse_color(&bytes).map_err(|fault| fault.at(path))?)
    }

    /// Width and height of a PNG or a JPEG in pixels, from its header alone.
    ///
    /// # Errors
    ///
    /// As [`ColorImage::read`]; what is wrong behind the header is not seen.
    pub fn read_size(path: impl AsRef<Path>) -> Result<(usize, usize), CloudError> {
        let path = path.as_ref();
        let bytes = pomona_files::read(path)?;
        Ok(parse_size(&bytes).map_err(|fault| fault.at(path))?)
    }

    /// Writes an 8-bit RGB PNG.
    ///
    /// # Errors
    ///
    /// [`CloudError::File`], also where there are not `width * height` pixels.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<(), CloudError> {
        let path = path.as_ref();
        let bytes = png::format_color(self).map_err(|fault| fault.at(path))?;
        write_atomically(path, &bytes)?;
        Ok(())
    }
}

pub(super) fn parse_color(bytes: &[u8]) -> Result<ColorImage, Malformed> {
    if png::is(bytes) {
        png::parse_color(bytes)
    } else if jpeg::is(bytes) {
        jpeg::parse(bytes)
    } else {
        Err(neither())
    }
}

/// Width and height that the header states.
pub(super) fn parse_size(bytes: &[u8]) -> Result<(usize, usize), Malformed> {
    if png::is(bytes) {
        png::parse_size(bytes)
    } else if jpeg::is(bytes) {
        jpeg::parse_size(bytes)
    } else {
        Err(neither())
    }
}

fn neither() -> Malformed {
    Malformed::new(
        "byte 0",
        "neither a PNG nor a JPEG",
        "convert the picture to one of them",
    )
}
