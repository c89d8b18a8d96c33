use super::{Camera, json, ros};
use crate::CloudError;
use pomona_files::{Malformed, WithWarnings, write_atomically};
use std::path::Path;

impl Camera {
    /// Reads a camera: the project's JSON, Open3D's intrinsic JSON, or a ROS
    /// `CameraInfo` in YAML, recognised by extension and content.
    ///
    /// ROS and Open3D files do not say how depth is stored; then a depth unit is
    /// one millimetre, the default of both. [`Camera::read_with_warnings`] tells what was assumed.
    ///
    /// # Errors
    ///
    /// [`CloudError::File`], [`CloudError::Camera`].
    pub fn read(path: impl AsRef<Path>) -> Result<Self, CloudError> {
        Ok(Self::read_with_warnings(path)?.value)
    }

    /// As [`Camera::read`], with what the file leaves open and had to be assumed.
    ///
    /// # Errors
    ///
    /// [`CloudError::File`], [`CloudError::Camera`].
    pub fn read_with_warnings(path: impl AsRef<Path>) -> Result<WithWarnings<Self>, CloudError> {
        let path = path.as_ref();
        let bytes = pomona_files::read(path)?;
        let camera = Self::parse(path, &bytes).map_err(|fault| fault.at(path))?;
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

    pub(super) fn parse(path: &Path, bytes: &[u8]) -> Result<WithWarnings<Self>, Malformed> {
        let text = std::str::from_utf8(bytes).map_err(|e| {
            let place = format!("byte {}", e.valid_up_to());
            Malformed::new(
                place,
                "not UTF-8 text",
                "give the camera as JSON or YAML text",
            )
        })?;
        let extension = path.extension().unwrap_or_default().to_ascii_lowercase();
        if extension == "yaml" || extension == "yml" {
            ros::parse(text)
        } else {
            json::parse(text)
        }
    }
}
