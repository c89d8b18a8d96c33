use pomona_network::NetworkError;
use thiserror::Error;

/// Most classes of a segmenter: as many as 8-bit indices can tell apart, with one left for unseen pixels.
pub(crate) const MOST_CLASSES: usize = 255;

/// Why a segmenter could not be made or used.
///
/// Every message names the file or the input, what is wrong with it, and what to do about it.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SegmentError {
    /// A zoom that cannot be used.
    #[error("a zoom of {zoom}: give one from 0.1 to 8; at 2 each pixel becomes two by two")]
    Zoom {
        /// The zoom.
        zoom: f64,
    },
    /// A model, its description, an inference backend or an image cannot be used.
    #[error(transparent)]
    Network(#[from] NetworkError),
    /// Classes that make no sense.
    #[error(
        "classes {names:?}: {problem}; give each class one name of its own, 1 to {} of them",
        MOST_CLASSES
    )]
    Classes {
        /// Their names.
        names: Vec<String>,
        /// What is wrong with them.
        problem: String,
    },
    /// Probabilities that do not fit an image.
    #[error("segmentation of a {width}x{height} image: {problem}; {remedy}")]
    Segmentation {
        /// Width in pixels.
        width: usize,
        /// Height in pixels.
        height: usize,
        /// What is wrong with it.
        problem: String,
        /// What to do about it.
        remedy: &'static str,
    },
    /// A segmenter of the caller's own failed.
    #[error("{segmenter}: {source}")]
    Other {
        /// The segmenter's name.
        segmenter: String,
        /// What it said.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
}
