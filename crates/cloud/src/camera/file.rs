use super::options::CameraOptions;
use super::{Camera, json, yaml};
use crate::CloudError;
use pomona_files::{Malformed, WithWarnings, write_atomically};
use std::path::Path;

impl Camera {
    /// Reads a camera: the project's JSON, Open3D's intrinsic JSON, the intrinsics of `RealSense` as JSON, a ROS
    /// `CameraInfo` in YAML or JSON, the file of ROS' `camera_calibration`, OpenCV's `FileStorage` or Kalibr's camchain
    /// in YAML, recognised by extension and content.
    ///
    /// Where the file does not say how depth is stored, a unit is one millimetre, and where it describes raw and
    /// rectified images, the images are raw; [`Camera::read_with`] tells what was assumed.
    ///
    /// # Errors
    ///
    /// [`CloudError::File`], [`CloudError::Camera`].
    pub fn read(path: impl AsRef<Path>) -> Result<Self, CloudError> {
        Ok(Self::read_with(path, &CameraOptions::default())?.value)
    }

    /// As [`Camera::read`], with what is known beside the file, and with what had to be assumed all the same.
    ///
    /// # Errors
    ///
    /// [`CloudError::File`], also where the options contradict the file; [`CloudError::Camera`].
    pub fn read_with(
        path: impl AsRef<Path>,
        options: &CameraOptions,
    ) -> Result<WithWarnings<Self>, CloudError> {
        let path = path.as_ref();
        let bytes = pomona_files::read(path)?;
        let camera = Self::parse(path, &bytes, options).map_err(|fault| fault.at(path))?;
        camera
            .value
            .validate()
            .map_err(|source| CloudError::Camera {
                path: path.to_owned(),
                source,
            })?;
        Ok(camera.in_file(path))
    }

    /// Writes the project's JSON.
    ///
    /// # Errors
    ///
    /// [`CloudError::Camera`] for a camera that could not be read back, [`CloudError::File`].
    pub fn write(&self, path: impl AsRef<Path>) -> Result<(), CloudError> {
        let path = path.as_ref();
        self.validate().map_err(|source| CloudError::Camera {
            path: path.to_owned(),
            source,
        })?;
        write_atomically(path, json::format(self).as_bytes())?;
        Ok(())
    }

    pub(super) fn parse(
        path: &Path,
        bytes: &[u8],
        options: &CameraOptions,
    ) -> Result<WithWarnings<Self>, Malformed> {
        let text = std::str::from_utf8(bytes).map_err(|e| {
            let place = format!("byte {}", e.valid_up_to());
            Malformed::new(
                place,
                "not UTF-8 text",
                "give the camera as JSON or YAML text",
            )
        })?;
        // Windows' editors begin a text with a byte order mark.
        let text = text.trim_start_matches('\u{feff}');
        let extension = path.extension().unwrap_or_default().to_ascii_lowercase();
        if extension == "yaml" || extension == "yml" {
            yaml::parse(text, options)
        } else {
            json::parse(text, options)
        }
    }
}
