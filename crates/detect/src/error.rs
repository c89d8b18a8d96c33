use pomona_network::NetworkError;
use thiserror::Error;

/// Why a detector could not be made or used.
///
/// Every message names the file or the input, what is wrong with it, and what to do about it.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum DetectError {
    /// A model, its description, an inference backend or an image cannot be used.
    #[error(transparent)]
    Network(#[from] NetworkError),
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
