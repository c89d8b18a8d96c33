//! Depth images of any format.

use super::depth_values::DepthValues;
use super::{npy, png, tiff};
use crate::CloudError;
use std::path::Path;

impl DepthValues {
    /// Reads a PNG of 16 bits, or a TIFF or NPY of 16 bits or in floating point, recognised by content.
    ///
    /// # Errors
    ///
    /// [`CloudError::File`], also for what is none of these, is cut short, or has more than 16 bits in use.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, CloudError> {
        let path = path.as_ref();
        let bytes = pomona_files::read(path)?;
        let parsed = if tiff::is(&bytes) {
            tiff::parse(&bytes)
        } else if npy::is(&bytes) {
            npy::parse(&bytes)
        } else {
            png::parse_depth(&bytes).map(Self::Units)
        };
        Ok(parsed.map_err(|fault| fault.at(path))?)
    }
}
