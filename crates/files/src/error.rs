use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Why a file could not be read or written.
///
/// Every message names the file, the place in it, and what to do about it.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum FileError {
    /// The operating system refused to read the file, for example because there is none.
    #[error("{}: cannot be read: {source}; {}", .path.display(), read_remedy(.source))]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// The operating system refused to write the file.
    #[error("{}: cannot be written: {source}; check that the folder exists, is writable and has room", .path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// The content is not what the file's format asks for.
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
}

impl FileError {
    /// The error for a file that could not be read.
    pub fn read(path: impl Into<PathBuf>, source: io::Error) -> Self {
        Self::Read {
            path: path.into(),
            source,
        }
    }

    /// The error for a file that could not be written.
    pub fn write(path: impl Into<PathBuf>, source: io::Error) -> Self {
        Self::Write {
            path: path.into(),
            source,
        }
    }
}

fn read_remedy(source: &io::Error) -> &'static str {
    match source.kind() {
        ErrorKind::NotFound => "check the path",
        ErrorKind::PermissionDenied => "check the file's permissions",
        _ => "check that it is a plain, readable file",
    }
}

/// What a parser found wrong in bytes whose file it does not know.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Malformed {
    /// Where: a line, a byte, a field.
    pub place: String,
    /// What is wrong there.
    pub problem: String,
    /// What to do about it.
    pub remedy: String,
}

impl Malformed {
    /// A problem at a place, and its remedy.
    pub fn new(
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

    /// The error, in the file at `path`.
    pub fn at(self, path: &Path) -> FileError {
        FileError::Malformed {
            path: path.to_owned(),
            place: self.place,
            problem: self.problem,
            remedy: self.remedy,
        }
    }
}
