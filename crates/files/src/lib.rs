//! Reading and atomic writing of files, errors that name the file, the location and the remedy, and warnings.
//!
//! ```
//! use pomona_files::{FileError, Malformed, read, write_atomically};
//!
//! /// The number that a file holds.
//! fn number(path: &std::path::Path) -> Result<f64, FileError> {
//!     let bytes = read(path)?;
//!     let text = String::from_utf8_lossy(&bytes);
//!     text.trim().parse().map_err(|_| {
//!         Malformed::new("line 1", format!("`{}` is not a number", text.trim()), "write a number").at(path)
//!     })
//! }
//!
//! # let folder = tempfile::tempdir()?;
//! let path = folder.path().join("length.txt");
//! write_atomically(&path, b"0.25\n")?;
//! assert_eq!(number(&path)?, 0.25);
//!
//! write_atomically(&path, b"long\n")?;
//! let message = number(&path).unwrap_err().to_string();
//! assert!(message.ends_with("length.txt: line 1: `long` is not a number; write a number"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Concepts
//!
//! - A parser works on bytes and returns a [`Malformed`]; the caller, who knows the file's name, turns it into a
//!   [`FileError`] with [`Malformed::at`].
//! - [`write_atomically`] writes to a temporary file beside the destination and renames it, so that a reader finds the
//!   old content or the new one, never a part.
//! - A [`Warning`] says what was assumed about an input that does not state it, or what is doubtful about it. Its
//!   [`WarningCode`] is for programs; all codes are declared in one list, with their [`Level`]. A reader returns them
//!   beside what it read, as [`WithWarnings`].
//!
//! # Not here
//!
//! Any file format; folders of several files, which the commands publish as one.

mod atomic;
mod error;
mod warning;

pub use atomic::{read, temporary_beside, write_atomically};
pub use error::{FileError, Malformed};
pub use warning::{Level, Warning, WarningCode, WithWarnings};
