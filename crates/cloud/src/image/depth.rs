//! Depth images in files.

use super::png;
use crate::{CloudError, DepthImage};
use pomona_files::write_atomically;
use std::path::Path;

impl DepthImage {
    /// Reads a 16-bit grey PNG.
    ///
    /// # Errors
    ///
    /// [`CloudError::File`], also for what is no PNG, is cut short, or is
    /// not 16-bit grey: 8 bits are too few for depth, and such a file is most often a picture of it.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, CloudError> {
        let path = path.as_ref();
        let bytes = pomona_files::read(path)?;
        Ok(png::parse_depth(&bytes).map_err(|fault| fault.at(path))?)
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
