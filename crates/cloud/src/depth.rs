use crate::{CloudError, file, image};
use std::path::Path;

/// A depth image registered to the colour image: z in units of [`crate::Camera::depth_scale`]; 0 is 'no reading'.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DepthImage {
    /// Width in pixels.
    pub width: usize,
    /// Height in pixels.
    pub height: usize,
    /// `width * height` readings, row by row.
    pub readings: Vec<u16>,
}

impl DepthImage {
    /// An image without any reading.
    pub fn empty(width: usize, height: usize) -> Self {
        Self {
            width,
            height,
            readings: vec![0; width * height],
        }
    }

    /// The reading at column `u` of row `v`; `None` outside the image and where there is no reading.
    pub fn get(&self, u: usize, v: usize) -> Option<u16> {
        let index = (u < self.width && v < self.height).then(|| v * self.width + u)?;
        self.readings
            .get(index)
            .copied()
            .filter(|&reading| reading != 0)
    }

    /// How many pixels have a reading.
    pub fn reading_count(&self) -> usize {
        self.readings
            .iter()
            .filter(|&&reading| reading != 0)
            .count()
    }

    /// Reads a 16-bit grey PNG.
    ///
    /// # Errors
    ///
    /// [`CloudError::Read`]; [`CloudError::Malformed`] for what is no PNG, is cut short, or is
    /// not 16-bit grey: 8 bits are too few for depth, and such a file is most often a picture of it.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, CloudError> {
        let path = path.as_ref();
        let bytes = file::read_bytes(path)?;
        image::png::parse_depth(&bytes).map_err(|fault| fault.at(path))
    }

    /// Writes a 16-bit grey PNG.
    ///
    /// # Errors
    ///
    /// [`CloudError::Write`]; [`CloudError::Malformed`] where there are not `width * height` readings.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<(), CloudError> {
        let path = path.as_ref();
        let bytes = image::png::format_depth(self).map_err(|fault| fault.at(path))?;
        file::write_atomically(path, &bytes)
    }
}
