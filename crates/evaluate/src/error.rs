use std::path::PathBuf;
use thiserror::Error;

/// Why an evaluation could not be made.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum EvaluateError {
    /// It is neither a suite nor a folder.
    #[error(
        "`{name}` is neither a folder nor a suite; the suites are {}, each also with other scenes as in orchard@1000",
        .suites.join(", ")
    )]
    UnknownSubject {
        /// What was asked for.
        name: String,
        /// The suites there are.
        suites: Vec<&'static str>,
    },
    /// A folder without a truth to measure against.
    #[error(
        "{path}: no truth.json in it or in its folders; give a frame with ground truth, or --calipers FILE"
    )]
    NoTruth {
        /// The folder.
        path: PathBuf,
    },
    /// A scene or a truth could not be read.
    #[error(transparent)]
    Scene(#[from] pomona_scenes::SceneError),
    /// A frame could not be read.
    #[error(transparent)]
    Frame(#[from] pomona_cloud::CloudError),
    /// A file of strokes could not be read.
    #[error(transparent)]
    Labels(#[from] pomona_labels::LabelsError),
    /// A method could not work on a frame at all.
    #[error(transparent)]
    Pick(#[from] pomona::PickError),
    /// The noise of a simulated calibration makes no sense.
    #[error("noise of the simulated calibration: {name} is {value}, and must be {rule}")]
    Noise {
        /// Which number.
        name: &'static str,
        /// Its value.
        value: f64,
        /// What it must be.
        rule: &'static str,
    },
    /// A simulated calibration failed.
    #[error("{case}: simulated calibration: {source}; take more poses or less noise")]
    Calibration {
        /// The frame it was for.
        case: String,
        /// Why.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    /// The system refused a file.
    #[error("{path}: {source}")]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A file is not of the form that is read here.
    #[error("{path}: {problem}; {remedy}")]
    Malformed {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        problem: String,
        /// What to do.
        remedy: String,
    },
    /// A table could not be written as text.
    #[error("table of apples: {reason}")]
    Table {
        /// Why.
        reason: String,
    },
    /// A plot could not be drawn.
    #[error(transparent)]
    Plot(#[from] pomona_report::plot::PlotError),
}
