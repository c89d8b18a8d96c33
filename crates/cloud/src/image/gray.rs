//! Images of one channel in files.

use super::png;
use crate::{CloudError, GrayImage};
use pomona_files::write_atomically;
use std::path::Path;

impl GrayImage {
    /// Reads a grey PNG of 1 to 8 bits, black to white as 0 to 255.
    ///
    /// # Errors
    ///
    /// [`CloudError::File`], also for what is no PNG, is cut short, or has colours: those of a coloured mask have a
    /// meaning that only its program knows.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, CloudError> {
        let path = path.as_ref();
        let bytes = pomona_files::read(path)?;
        Ok(png::parse_gray(&bytes).map_err(|fault| fault.at(path))?)
    }

    /// Writes an 8-bit grey PNG.
    ///
    /// # Errors
    ///
    /// [`CloudError::File`], also where there are not `width * height` values.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<(), CloudError> {
        let path = path.as_ref();
        let bytes = png::format_gray(self).map_err(|fault| fault.at(path))?;
        write_atomically(path, &bytes)?;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{ColorImage, DepthImage};

    #[test]
    fn a_mask_comes_back_as_it_was() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("mask.png");
        let mask = GrayImage {
            width: 3,
            height: 2,
            values: vec![0, 1, 127, 128, 254, 255],
        };
        mask.write(&path).unwrap();
        assert_eq!(GrayImage::read(&path).unwrap(), mask);
        assert_eq!((mask.get(2, 1), mask.get(3, 0)), (Some(255), None));
    }

    #[test]
    fn what_is_no_mask_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("mask.png");
        let message = || GrayImage::read(&path).unwrap_err().to_string();
        ColorImage::filled(4, 3, [9, 9, 9]).write(&path).unwrap();
        assert!(message().contains("mask.png") && message().contains("8-bit Rgb"));
        DepthImage::empty(4, 3).write(&path).unwrap();
        assert!(message().contains("16-bit Grayscale"));
        std::fs::write(&path, b"no picture").unwrap();
        assert!(message().contains("mask.png"));
        let short = GrayImage {
            width: 3,
            height: 2,
            values: vec![0; 5],
        };
        assert!(
            short
                .write(&path)
                .unwrap_err()
                .to_string()
                .contains("5 pixels")
        );
    }
}
