use crate::{
    DetectError, Detector, ModelDescription, ModelSource, OnnxDetector, built_in, open_network,
};
use serde::Deserialize;
use std::path::PathBuf;

/// Which runtime runs the network.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum RuntimeChoice {
    /// ONNX Runtime where a usable library is found, else the embedded one.
    #[default]
    Automatic,
    /// ONNX Runtime from this library, or an error.
    Library(PathBuf),
    /// ONNX Runtime from the usual places, or an error.
    OnnxRuntime,
    /// The embedded one.
    Embedded,
}

/// Which of the model's classes is an apple.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(untagged, expecting = "expected a class's name or number")]
pub enum ClassChoice {
    /// By its number.
    Number(usize),
    /// By its name in the description beside the model or in the model's own metadata, or among COCO's where a
    /// model of 80 classes has no names.
    Name(String),
}

/// How a large image is cut.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TilingChoice {
    /// By the sizes of image and model.
    #[default]
    Automatic,
    /// Not at all: the image is scaled to the model's input.
    Whole,
    /// Into so many columns and rows.
    Grid {
        /// Columns.
        columns: usize,
        /// Rows.
        rows: usize,
    },
}

/// How to open a detector.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DetectorOptions {
    /// The model, ONNX; the built-in one where absent. `MODEL.toml` beside `MODEL.onnx` is read.
    pub model: Option<PathBuf>,
    /// What runs it.
    pub runtime: RuntimeChoice,
    /// The class that counts; by the description, else the one named `apple`, else class 0, where absent.
    pub class: Option<ClassChoice>,
    /// Lowest score that counts, 0 to 1; by the description, else 0.25, where absent.
    pub threshold: Option<f64>,
    /// IoU above which two boxes are one apple, 0 to 1; by the description, else 0.45.
    pub overlap: Option<f64>,
    /// How a large image is cut.
    pub tiling: TilingChoice,
}

impl DetectorOptions {
    /// Opens the detector.
    ///
    /// # Errors
    ///
    /// [`DetectError`] for a model, a description, a runtime or a setting that cannot be used.
    pub fn open(&self) -> Result<Box<dyn Detector>, DetectError> {
        let (source, name, description) = match &self.model {
            Some(path) => (
                ModelSource::File(path.clone()),
                path.display().to_string(),
                ModelDescription::beside(path)?,
            ),
            None => built_in::model()?,
        };
        // One thread to a run: the tiles are what is shared among the cores.
        let network = open_network(&source, &self.runtime, 1)?;
        let detector = OnnxDetector::new(network, name, &description, self)?;
        Ok(Box::new(detector))
    }
}
