use crate::{CloudError, file, image};
use std::path::Path;

/// An 8-bit RGB image, rows from the top.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ColorImage {
    /// Width in pixels.
    pub width: usize,
    /// Height in pixels.
    pub height: usize,
    /// `width * height` pixels, row by row.
    pub pixels: Vec<[u8; 3]>,
}

impl ColorImage {
    /// An image of one colour.
    pub fn filled(width: usize, height: usize, color: [u8; 3]) -> Self {
        Self {
            width,
            height,
            pixels: vec![color; width * height],
        }
    }

    /// The pixel at column `u` of row `v`; `None` outside the image.
    pub fn get(&self, u: usize, v: usize) -> Option<[u8; 3]> {
        let index = (u < self.width && v < self.height).then(|| v * self.width + u)?;
        self.pixels.get(index).copied()
    }

    /// Reads a PNG or a JPEG, recognised by content.
    ///
    /// Grey, palette and 16-bit PNGs become 8-bit RGB; an alpha channel is dropped.
    /// A JPEG's EXIF orientation is not applied: depth would not follow it.
    ///
    /// # Errors
    ///
    /// [`CloudError::Read`]; [`CloudError::Malformed`] for what is neither, or is cut short.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, CloudError> {
        let path = path.as_ref();
        let bytes = file::read_bytes(path)?;
        image::parse_color(&bytes).map_err(|fault| fault.at(path))
    }

    /// Width and height of a PNG or a JPEG in pixels, from its header alone.
    ///
    /// # Errors
    ///
    /// As [`ColorImage::read`]; what is wrong behind the header is not seen.
    pub fn read_size(path: impl AsRef<Path>) -> Result<(usize, usize), CloudError> {
        let path = path.as_ref();
        let bytes = file::read_bytes(path)?;
        image::parse_size(&bytes).map_err(|fault| fault.at(path))
    }

    /// Writes an 8-bit RGB PNG.
    ///
    /// # Errors
    ///
    /// [`CloudError::Write`]; [`CloudError::Malformed`] where there are not `width * height` pixels.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<(), CloudError> {
        let path = path.as_ref();
        let bytes = image::png::format_color(self).map_err(|fault| fault.at(path))?;
        file::write_atomically(path, &bytes)
    }
}
