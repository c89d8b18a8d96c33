use pomona_cloud::CloudError;
use pomona_files::FileError;
use std::path::PathBuf;
use thiserror::Error;

/// Why a scene could not be named, written or read.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SceneError {
    /// No suite has that name.
    #[error("no suite is called `{name}`; the suites are {}", .known.join(", "))]
    UnknownSuite {
        /// The name asked for.
        name: String,
        /// The names there are.
        known: Vec<&'static str>,
    },
    /// The folder exists and holds files that are not a scene's.
    #[error(
        "{path}: is not part of a scene and would be lost; name a new folder, an empty one, or one that contains a scene \
         alone"
    )]
    Occupied {
        /// The file or folder in the way.
        path: PathBuf,
    },
    /// A file or a folder could not be read or written.
    #[error(transparent)]
    File(#[from] FileError),
    /// The frame's own files could not be written.
    #[error(transparent)]
    Frame(#[from] CloudError),
    /// A truth file is not one.
    #[error("{path}: {reason}")]
    Truth {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        reason: String,
    },
}
