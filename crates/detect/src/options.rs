use pomona_cloud::ClassChoice;
use pomona_network::{RuntimeChoice, TilingChoice};
use std::path::PathBuf;

/// How to open a detector.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct DetectorOptions {
    /// The model, ONNX; the built-in one where absent. `MODEL.toml` beside `MODEL.onnx` is read.
    pub model: Option<PathBuf>,
    /// The inference backend.
    pub runtime: RuntimeChoice,
    /// The class that counts; by the description, else what is an apple by its name, else the only one, where absent.
    /// Where classes have no names it is class 0, and a note in the report says so.
    pub class: Option<ClassChoice>,
    /// Lowest score of a box, 0 to 1; by the description, else 0.25, where absent.
    pub threshold: Option<f64>,
    /// `IoU` above which of two boxes only the better one is kept, 0 to 1; by the description, else 0.45.
    pub nms_iou: Option<f64>,
    /// How a large image is tiled.
    pub tiling: TilingChoice,
}

impl DetectorOptions {
    /// These options after a change.
    #[must_use]
    pub fn with(mut self, change: impl FnOnce(&mut Self)) -> Self {
        change(&mut self);
        self
    }
}
