use pomona_cloud::CloudError;
use pomona_detect::DetectError;
use pomona_report::plot::PlotError;
use pomona_segment::SegmentError;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Why labelled images could not be read or measured on.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum LabelsError {
    /// The system refused a file.
    #[error("{path}: {source}")]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// An image or its boxes could not be read.
    #[error(transparent)]
    Cloud(#[from] CloudError),
    /// A file or folder is not a data set, or contradicts itself.
    #[error("{path}: {problem}; {remedy}")]
    Malformed {
        /// The file or folder where it shows.
        path: PathBuf,
        /// What is wrong with it.
        problem: String,
        /// What to do.
        remedy: String,
    },
    /// A detector could not work on an image.
    #[error("{}: {source}", .image.display())]
    Detection {
        /// The image.
        image: PathBuf,
        /// What it said.
        source: DetectError,
    },
    /// A segmenter could not work on an image.
    #[error("{}: {source}", .image.display())]
    Segmentation {
        /// The image.
        image: PathBuf,
        /// What it said.
        source: Box<SegmentError>,
    },
    /// A plot could not be drawn.
    #[error(transparent)]
    Plot(#[from] PlotError),
}

impl LabelsError {
    pub(crate) fn malformed(path: &Path, problem: &str, remedy: &str) -> Self {
        Self::Malformed {
            path: path.to_owned(),
            problem: problem.to_owned(),
            remedy: remedy.to_owned(),
        }
    }
}
