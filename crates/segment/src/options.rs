use crate::{
    built_in, description::SegmentDescription, error::SegmentError, onnx_segmenter::OnnxSegmenter,
    segmenter::Segmenter,
};
use pomona_network::{ModelSource, RuntimeChoice, TilingChoice, open_network};
use std::path::PathBuf;

/// Threads of one run of a network: it is the tiles that are spread over the cores.
const THREADS_PER_RUN: usize = 1;

/// Which segmenter, and how it is run.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct SegmenterOptions {
    /// The ONNX file; the built-in model where absent.
    pub model: Option<PathBuf>,
    /// The inference backend.
    pub runtime: RuntimeChoice,
    /// Which tiles of an image are run.
    pub tiling: TilingChoice,
}

impl SegmenterOptions {
    /// The options for a model file; the built-in model for `None`.
    pub fn of_model(model: Option<PathBuf>) -> Self {
        Self {
            model,
            ..Self::default()
        }
    }

    /// Opens the segmenter.
    ///
    /// # Errors
    ///
    /// [`SegmentError`] for a model, a description, an inference backend or a tiling that cannot be used.
    pub fn open(&self) -> Result<Box<dyn Segmenter>, SegmentError> {
        Ok(Box::new(self.open_network()?))
    }

    /// The same as the type that it is.
    ///
    /// # Errors
    ///
    /// As [`SegmenterOptions::open`].
    pub fn open_network(&self) -> Result<OnnxSegmenter, SegmentError> {
        let (source, name, description) = match &self.model {
            Some(path) => (
                ModelSource::File(path.clone()),
                path.display().to_string(),
                SegmentDescription::beside(path)?,
            ),
            None => built_in::model()?,
        };
        let network = open_network(&source, &self.runtime, THREADS_PER_RUN)?;
        OnnxSegmenter::new(network, name, &description, self.tiling)
    }
}
