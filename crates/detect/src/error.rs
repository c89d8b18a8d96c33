use std::path::PathBuf;
use thiserror::Error;

/// Why a detector could not be made or used.
///
/// Every message names the file or the input, what is wrong with it, and what to do about it.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum DetectError {
    /// The operating system refused to read a file.
    #[error("{}: cannot be read: {source}; check the path and its permissions", .path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A model, or the description beside it, cannot be used.
    #[error("{model}: {place}: {problem}; {remedy}")]
    Model {
        /// The model's or description's file, or the name of the built-in one.
        model: String,
        /// Where in it: an input, an output, a key.
        place: String,
        /// What is wrong there.
        problem: String,
        /// What to do about it.
        remedy: String,
    },
    /// A runtime that was asked for by name does not serve.
    #[error("{runtime}: {problem}; {remedy}")]
    Runtime {
        /// The library or runtime.
        runtime: String,
        /// What is wrong with it.
        problem: String,
        /// What to do about it.
        remedy: String,
    },
    /// An image that no detector can work on.
    #[error("{width}x{height} image: {problem}; {remedy}")]
    Image {
        /// Width in pixels.
        width: usize,
        /// Height in pixels.
        height: usize,
        /// What is wrong with it.
        problem: String,
        /// What to do about it.
        remedy: String,
    },
    /// A setting that makes no sense.
    #[error("{setting} = {value}: {problem}; {remedy}")]
    Setting {
        /// The setting's name.
        setting: &'static str,
        /// Its value.
        value: String,
        /// What is wrong with it.
        problem: String,
        /// What to do about it.
        remedy: String,
    },
    /// A detector of the caller's own failed.
    #[error("{detector}: {source}")]
    Other {
        /// The detector's name.
        detector: String,
        /// What it said.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
}
