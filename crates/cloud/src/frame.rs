mod points;

use crate::boxes::validate_all;
use crate::folder::{COLOR_FILES, folder_name};
use crate::{
    BoxChoice, BoxFormat, BoxImage, Camera, CameraOptions, CloudError, ColorImage, DepthImage,
    DepthValues, PixelBox, read_boxes, write_boxes,
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

/// Where the boxes of a frame are read from.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum BoxSource {
    /// The box file in its folder, where there is one.
    #[default]
    Own,
    /// This file.
    File(PathBuf),
    /// Nowhere: the frame has no boxes, whatever lies in its folder.
    Nowhere,
}

/// What is known about a frame beside the files of its folder.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct FrameOptions {
    /// About its camera; the size of the images is theirs.
    pub camera: CameraOptions,
    /// Where its boxes are read from.
    pub boxes: BoxSource,
    /// Which boxes of that file are meant.
    pub choice: BoxChoice,
}

impl FrameOptions {
    /// For a camera as `options` have it, with the boxes that `choice` takes from `boxes`.
    pub fn new(camera: CameraOptions, boxes: BoxSource, choice: BoxChoice) -> Self {
        Self {
            camera,
            boxes,
            choice,
        }
    }
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

    /// The names of the colour image in a frame's folder; the first that is there is read, here and below, and capitals
    /// do not matter.
    pub const COLOR_FILES: [&str; 6] = COLOR_FILES;

    /// The names of the depth image.
    pub const DEPTH_FILES: [&str; 4] = ["depth.png", "depth.tiff", "depth.tif", "depth.npy"];

    /// The names of the file with the boxes.
    pub const BOX_FILES: [&str; 3] = ["boxes.xml", "boxes.json", "boxes.txt"];

    /// The colour image in a frame's folder, where there is one.
    pub fn color_file(dir: impl AsRef<Path>) -> Option<PathBuf> {
        present(dir.as_ref(), &Self::COLOR_FILES)
    }

    /// The depth image in a frame's folder, where there is one.
    pub fn depth_file(dir: impl AsRef<Path>) -> Option<PathBuf> {
        present(dir.as_ref(), &Self::DEPTH_FILES)
    }

    /// The box file in a frame's folder, where there is one.
    pub fn box_file(dir: impl AsRef<Path>) -> Option<PathBuf> {
        present(dir.as_ref(), &Self::BOX_FILES)
    }

    /// Reads a frame's folder: `color.png` or `.jpg` (or `rgb`), `depth.png`, `.tiff` or `.npy`, `camera.json` (or a ROS
    /// `camera.yaml`, `camera_info.yaml`, `ost.yaml`, or Open3D's `intrinsic.json`), and
    /// `boxes.xml`, `.json` or `.txt` where there is one. Of several names the first is read. Depth in floating point,
    /// which is in metres unless the camera states another unit, is rounded to 16 bits.
    ///
    /// Of a box file with several classes the apples are taken, as [`BoxChoice`] has it by default.
    /// What had to be assumed is in [`Frame::warnings`].
    ///
    /// # Errors
    ///
    /// [`CloudError::MissingFile`], [`CloudError::SizeMismatch`], [`CloudError::Box`], and
    /// the errors of reading each file.
    pub fn read(dir: impl AsRef<Path>) -> Result<Self, CloudError> {
        Self::read_with(dir, &FrameOptions::default())
    }

    /// As [`Frame::read`], with what is known beside the folder's files.
    ///
    /// # Errors
    ///
    /// As [`Frame::read`]; [`CloudError::File`] where the options contradict the camera's file.
    pub fn read_with(dir: impl AsRef<Path>, options: &FrameOptions) -> Result<Self, CloudError> {
        let dir = dir.as_ref();
        if let Err(source) = fs::read_dir(dir) {
            return Err(FileError::read(dir, source).into());
        }
        let color_file = required(dir, &Self::COLOR_FILES, "color.png or color.jpg")?;
        let color = ColorImage::read(&color_file)?;
        let depth_file = required(dir, &Self::DEPTH_FILES, "depth.png")?;
        let depth = DepthValues::read(&depth_file)?;
        let path = required(dir, CAMERA, "camera.json (or camera.yaml, intrinsic.json)")?;
        let camera_options = CameraOptions {
            image_size: Some([color.width, color.height]),
            ..options.camera
        };
        let mut camera = Camera::read_with(&path, &camera_options)?;
        let is_assumed = |w: &Warning| w.code == WarningCode::DepthScaleAssumed;
        let assumed = camera.warnings.iter().any(is_assumed);
        let scale = (!assumed).then_some(camera.value.depth_scale);
        let (depth, unit) = depth
            .in_units(scale)
            .map_err(|fault| fault.at(&depth_file))?;
        if let Some(unit) = unit {
            camera.value.depth_scale = unit;
            camera.warnings.retain(|w| !is_assumed(w));
            if assumed {
                camera.warnings.push(Warning::new(
                    WarningCode::DepthScaleAssumed,
                    "no depth unit; depth in floating point is taken to be in metres",
                ));
            }
        }
        let mut frame = Self::new(folder_name(dir), camera.value, color, depth);
        frame.warnings = camera.warnings;
        frame.warnings.extend(other_cameras(dir, &path));
        frame.validate_as(dir)?;
        frame
            .warnings
            .extend(ColorImage::turned_by_exif(&color_file)?);
        let box_file = match &options.boxes {
            BoxSource::Own => present(dir, &Self::BOX_FILES),
            BoxSource::File(path) => Some(path.clone()),
            BoxSource::Nowhere => None,
        };
        if let Some(path) = box_file {
            let image = BoxImage::new(frame.color.width, frame.color.height).at(color_file);
            let boxes = read_boxes(path, &image, &options.choice)?;
            frame.boxes = Some(boxes.append_to(&mut frame.warnings));
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
                .chain(&Self::DEPTH_FILES)
                .chain(&Self::BOX_FILES);
            if let Some(name) = names
                .filter(|n| !kept.contains(n))
                .find(|n| present(dir, &[n]).is_some())
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

/// The first of these files that is in a folder, by its name as it stands, else regardless of capitals.
fn present(dir: &Path, names: &[&str]) -> Option<PathBuf> {
    let exact = names
        .iter()
        .map(|name| dir.join(name))
        .find(|path| path.exists());
    exact.or_else(|| {
        let entries = fs::read_dir(dir).ok()?.filter_map(Result::ok);
        let mut inside: Vec<_> = entries.map(|entry| entry.file_name()).collect();
        inside.sort();
        names.iter().find_map(|name| {
            let same = inside
                .iter()
                .find(|other| other.eq_ignore_ascii_case(name))?;
            Some(dir.join(same))
        })
    })
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

#[cfg(test)]
mod tests;
