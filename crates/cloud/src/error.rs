use crate::boxes::BoxError;
use crate::camera::CameraError;
use pomona_files::FileError;
use std::path::PathBuf;
use thiserror::Error;

/// Why a frame, an image, a cloud or a box file could not be read, written or used.
///
/// Every message names the file, the place in it, and what to do about it.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum CloudError {
    /// A file could not be read or written, or its content is not what its format asks for.
    #[error(transparent)]
    File(#[from] FileError),
    /// A frame's folder lacks one of its files.
    #[error("{}: no {expected} in this folder; a frame is color.png|jpg, depth.png|tiff|npy and camera.json", .path.display())]
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
