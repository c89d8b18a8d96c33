mod points;

use crate::boxes::validate_all;
use crate::{
    BoxFormat, Camera, CameraOptions, CloudError, ColorImage, DepthImage, PixelBox, read_boxes,
    write_boxes,
};
use pomona_files::{FileError, Malformed, Warning, WarningCode, temporary_beside};
use std::fs;
use std::path::{Path, PathBuf};

/// One RGB-D frame: colour, depth registered to it, camera, and boxes where they are known.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Frame {
    /// Name of the frame; the folder's name where it was read from one.
    pub id: String,
    /// Camera of both images.
    pub camera: Camera,
    /// Colour image.
    pub color: ColorImage,
    /// Depth image, of the same size.
    pub depth: DepthImage,
    /// Boxes of apples; `None` where no detector or person has marked any.
    pub boxes: Option<Vec<PixelBox>>,
    /// What was assumed about its files, or is doubtful about them, when it was read.
    pub warnings: Vec<Warning>,
}

const CAMERA: &[&str] = &[
    "camera.json",
    "camera.yaml",
    "camera.yml",
    "camera_info.yaml",
    "camera_info.yml",
    "camera_info.json",
    "ost.yaml",
    "intrinsic.json",
    "intrinsics.json",
];

/// The names under which [`Frame::write`] writes.
const WRITTEN: [&str; 4] = ["color.png", "depth.png", "camera.json", "boxes.xml"];

impl Frame {
    /// A frame without boxes.
    pub fn new(
        id: impl Into<String>,
        camera: Camera,
        color: ColorImage,
        depth: DepthImage,
    ) -> Self {
        Self {
            id: id.into(),
            camera,
            color,
            depth,
            boxes: None,
            warnings: Vec::new(),
        }
    }

    /// The names of the colour image in a frame's folder; the first that is there is read.
    pub const COLOR_FILES: [&str; 3] = ["color.png", "color.jpg", "color.jpeg"];

    /// The names of the file with the boxes; the first that is there is read.
    pub const BOX_FILES: [&str; 3] = ["boxes.xml", "boxes.json", "boxes.txt"];

    /// Reads a frame's folder: `color.png` or `.jpg`, `depth.png`, `camera.json` (or a ROS
    /// `camera.yaml`, `camera_info.yaml`, `ost.yaml`, or Open3D's `intrinsic.json`), and
    /// `boxes.xml`, `.json` or `.txt` where there is one. Of several names the first is read.
    /// What had to be assumed is in [`Frame::warnings`].
    ///
    /// # Errors
    ///
    /// [`CloudError::MissingFile`], [`CloudError::SizeMismatch`], [`CloudError::Box`], and
    /// the errors of reading each file.
    pub fn read(dir: impl AsRef<Path>) -> Result<Self, CloudError> {
        Self::read_with(dir, &CameraOptions::default())
    }

    /// As [`Frame::read`], with what is known about the camera beside its file.
    ///
    /// # Errors
    ///
    /// As [`Frame::read`]; [`CloudError::File`] where the options contradict the camera's file.
    pub fn read_with(dir: impl AsRef<Path>, options: &CameraOptions) -> Result<Self, CloudError> {
        let dir = dir.as_ref();
        if let Err(source) = fs::read_dir(dir) {
            return Err(FileError::read(dir, source).into());
        }
        let color = ColorImage::read(required(dir, &Self::COLOR_FILES, "color.png or color.jpg")?)?;
        let depth = DepthImage::read(required(dir, &["depth.png"], "depth.png")?)?;
        let path = required(dir, CAMERA, "camera.json (or camera.yaml, intrinsic.json)")?;
        let options = CameraOptions {
            image_size: Some([color.width, color.height]),
            ..*options
        };
        let camera = Camera::read_with(&path, &options)?;
        let mut frame = Self::new(folder_name(dir), camera.value, color, depth);
        frame.warnings = camera.warnings;
        frame.warnings.extend(other_cameras(dir, &path));
        frame.validate_as(dir)?;
        if let Some(path) = present(dir, &Self::BOX_FILES) {
            frame.boxes = Some(read_boxes(path, frame.color.width, frame.color.height)?);
        }
        Ok(frame)
    }

    /// Writes a frame's folder, boxes as VOC. A new folder appears whole or not at all.
    ///
    /// # Errors
    ///
    /// As [`Frame::validate`]; [`CloudError::File`], also where the folder holds
    /// a file that would then be read as a part of this frame.
    pub fn write(&self, dir: impl AsRef<Path>) -> Result<(), CloudError> {
        let dir = dir.as_ref();
        self.validate_as(dir)?;
        if dir.exists() {
            let kept = if self.boxes.is_some() {
                &WRITTEN[..]
            } else {
                &WRITTEN[..3]
            };
            let names = Self::COLOR_FILES
                .iter()
                .chain(CAMERA)
                .chain(&Self::BOX_FILES);
            if let Some(name) = names
                .filter(|n| !kept.contains(n))
                .find(|n| dir.join(n).exists())
            {
                let message = "it belongs to another frame; choose a new folder or remove it";
                let source = std::io::Error::new(std::io::ErrorKind::AlreadyExists, message);
                return Err(FileError::write(dir.join(name), source).into());
            }
            return self.write_files(dir);
        }
        let temporary = temporary_beside(dir);
        let renamed = fs::create_dir(&temporary)
            .map_err(|source| FileError::write(dir, source).into())
            .and_then(|()| self.write_files(&temporary))
            .and_then(|()| {
                fs::rename(&temporary, dir).map_err(|source| FileError::write(dir, source).into())
            });
        if renamed.is_err() {
            // The first error is the one to report.
            let _ = fs::remove_dir_all(&temporary);
        }
        renamed
    }

    fn write_files(&self, dir: &Path) -> Result<(), CloudError> {
        let [color, depth, camera, boxes] = WRITTEN.map(|name| dir.join(name));
        self.color.write(color)?;
        self.depth.write(depth)?;
        self.camera.write(camera)?;
        if let Some(list) = &self.boxes {
            write_boxes(
                boxes,
                list,
                self.color.width,
                self.color.height,
                BoxFormat::Voc,
            )?;
        }
        Ok(())
    }

    /// Checks what reading a frame checks: one size for camera, colour and depth, all pixels
    /// there, a camera that can be computed with, boxes that hold pixels.
    ///
    /// # Errors
    ///
    /// [`CloudError::SizeMismatch`], [`CloudError::File`], [`CloudError::Camera`],
    /// [`CloudError::Box`]; the path in them is the frame's id.
    pub fn validate(&self) -> Result<(), CloudError> {
        self.validate_as(Path::new(&self.id))
    }

    pub(crate) fn validate_as(&self, path: &Path) -> Result<(), CloudError> {
        let (color, depth) = (
            (self.color.width, self.color.height),
            (self.depth.width, self.depth.height),
        );
        let camera = (self.camera.width, self.camera.height);
        let mismatch =
            |first: &str, first_size, second: &str, second_size| CloudError::SizeMismatch {
                path: path.to_owned(),
                first: first.to_owned(),
                first_size,
                second: second.to_owned(),
                second_size,
            };
        if color != depth {
            return Err(mismatch(
                "the colour image",
                color,
                "the depth image",
                depth,
            ));
        }
        if camera != color {
            return Err(mismatch("the camera", camera, "the colour image", color));
        }
        for (place, count) in [
            ("colour image", self.color.pixels.len()),
            ("depth image", self.depth.readings.len()),
        ] {
            if color.0.checked_mul(color.1) != Some(count) {
                let problem = format!("{count} pixels for a size of {}x{}", color.0, color.1);
                let fault = Malformed::new(place, problem, "give width * height pixels");
                return Err(fault.at(path).into());
            }
        }
        self.camera
            .validate()
            .map_err(|source| CloudError::Camera {
                path: path.to_owned(),
                source,
            })?;
        validate_all(
            path,
            self.boxes.as_deref().unwrap_or_default(),
            color.0,
            color.1,
        )
    }
}

fn present(dir: &Path, names: &[&str]) -> Option<PathBuf> {
    names
        .iter()
        .map(|name| dir.join(name))
        .find(|path| path.exists())
}

/// Cameras beside the one that is read.
fn other_cameras(dir: &Path, read: &Path) -> Option<Warning> {
    let others = CAMERA.iter().filter(|name| {
        let path = dir.join(name);
        path != read && path.exists()
    });
    let others: Vec<&str> = others.copied().collect();
    let name = read.file_name()?.to_string_lossy();
    let message = format!(
        "{name}: the camera of this file is taken, and not that of {} beside it; leave one of them",
        others.join(", ")
    );
    let warning = Warning::new(WarningCode::OtherCamerasIgnored, message);
    (!others.is_empty()).then_some(warning)
}

fn required(dir: &Path, names: &[&str], expected: &'static str) -> Result<PathBuf, CloudError> {
    present(dir, names).ok_or_else(|| CloudError::MissingFile {
        path: dir.to_owned(),
        expected,
    })
}

/// The folder's own name, also where the path is `.` or ends in `..`.
pub(crate) fn folder_name(dir: &Path) -> String {
    let name = dir.file_name().map(ToOwned::to_owned);
    let name = name.or_else(|| dir.canonicalize().ok()?.file_name().map(ToOwned::to_owned));
    name.unwrap_or_default().to_string_lossy().into_owned()
}

#[cfg(test)]
mod tests;
