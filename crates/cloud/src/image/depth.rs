//! Depth images in files.

use super::depth_values::DepthValues;
use super::png;
use crate::{CloudError, DepthImage};
use pomona_files::{Malformed, write_atomically};
use std::path::Path;

impl DepthImage {
    /// Reads a PNG, TIFF or NPY of 16 bits.
    ///
    /// # Errors
    ///
    /// [`CloudError::File`], also for what is none of these, is cut short, or is
    /// not 16-bit grey: 8 bits are too few for depth, and such a file is most often a picture of it. Floating point
    /// counts in metres, and [`DepthValues`] reads it.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, CloudError> {
        let path = path.as_ref();
        match DepthValues::read(path)? {
            DepthValues::Units(image) => Ok(image),
            DepthValues::Metres { .. } => {
                let problem = "depth in floating point, where 16-bit units are asked for";
                let remedy = "put it into a frame's folder, whose camera says what it counts in";
                Err(Malformed::new("data", problem, remedy).at(path).into())
            }
        }
    }

    /// Writes a 16-bit grey PNG.
    ///
    /// # Errors
    ///
    /// [`CloudError::File`], also where there are not `width * height` readings.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<(), CloudError> {
        let path = path.as_ref();
        let bytes = png::format_depth(self).map_err(|fault| fault.at(path))?;
        write_atomically(path, &bytes)?;
        Ok(())
    }
}
