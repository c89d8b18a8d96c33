use crate::{BoxError, CameraError};
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Why a frame, an image, a cloud or a box file could not be read, written or used.
///
/// Every message names the file, the place in it, and what to do about it.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum CloudError {
    /// The operating system refused to read a file.
    #[error("{}: cannot be read: {source}; {}", .path.display(), read_remedy(.source))]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The operating system refused to write a file.
    #[error("{}: cannot be written: {source}; check that the folder exists, is writable and has room", .path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// What a file holds is not what its format asks for.
    #[error("{}: {place}: {problem}; {remedy}", .path.display())]
    Malformed {
        /// The file.
        path: PathBuf,
        /// Where in the file: a line, a byte, a field.
        place: String,
        /// What is wrong there.
        problem: String,
        /// What to do about it.
        remedy: String,
    },
    /// A frame's folder lacks one of its files.
    #[error("{}: no {expected} in this folder; a frame is color.png|jpg, depth.png and camera.json", .path.display())]
    MissingFile {
        /// The folder.
        path: PathBuf,
        /// The names that were looked for.
        expected: &'static str,
    },
    /// Two parts of a frame that must have the same size do not.
    #[error(
        "{}: {first} is {}x{} but {second} is {}x{}; register depth to colour, and give the camera of that image",
        .path.display(), .first_size.0, .first_size.1, .second_size.0, .second_size.1
    )]
    SizeMismatch {
        /// The frame's folder, or its id.
        path: PathBuf,
        /// One part.
        first: String,
        /// Its width and height.
        first_size: (usize, usize),
        /// The other part.
        second: String,
        /// Its width and height.
        second_size: (usize, usize),
    },
    /// A camera that cannot be computed with.
    #[error("{}: {source}", .path.display())]
    Camera {
        /// The camera's file, or the frame's id.
        path: PathBuf,
        /// What is wrong with it.
        source: CameraError,
    },
    /// A box that encloses nothing of the image.
    #[error("{}: {source}", .path.display())]
    Box {
        /// The box file, or the frame's id.
        path: PathBuf,
        /// What is wrong with it.
        source: BoxError,
    },
}

fn read_remedy(source: &std::io::Error) -> &'static str {
    match source.kind() {
        std::io::ErrorKind::NotFound => "check the path",
        std::io::ErrorKind::PermissionDenied => "check the file's permissions",
        _ => "check that it is a plain, readable file",
    }
}

/// What a parser of bytes found wrong; it becomes a [`CloudError`] where the file's name is known.
#[derive(Debug, PartialEq)]
pub(crate) struct Fault {
    pub(crate) place: String,
    pub(crate) problem: String,
    pub(crate) remedy: String,
}

impl Fault {
    pub(crate) fn new(
        place: impl Into<String>,
        problem: impl Into<String>,
        remedy: impl Into<String>,
    ) -> Self {
        Self {
            place: place.into(),
            problem: problem.into(),
            remedy: remedy.into(),
        }
    }

    pub(crate) fn at(self, path: &Path) -> CloudError {
        let Self {
            place,
            problem,
            remedy,
        } = self;
        CloudError::Malformed {
            path: path.to_owned(),
            place,
            problem,
            remedy,
        }
    }
}
