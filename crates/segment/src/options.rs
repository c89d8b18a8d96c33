use crate::{
    built_in, description::SegmentDescription, error::SegmentError, onnx_segmenter::OnnxSegmenter,
    segmenter::Segmenter, zooms::Mean,
};
use pomona_network::{ModelSource, RuntimeChoice, TilingChoice, open_network};
use std::path::PathBuf;

/// Threads of one run of a network: it is the tiles that are spread over the cores.
const THREADS_PER_RUN: usize = 1;

/// Zooms that can be used: below, tiles would be larger than images, above, smaller than anything in them.
const ZOOMS: std::ops::RangeInclusive<f64> = 0.1..=8.0;

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
    /// The scales at which an image is looked at, above 0: at 2 each pixel becomes two by two, and a tile covers half of
    /// the length. The result is the mean of all. None means 1 alone.
    pub zooms: Vec<f64>,
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
    /// [`SegmentError`] for a model, a description, an inference backend, a tiling or a zoom that cannot be used.
    pub fn open(&self) -> Result<Box<dyn Segmenter>, SegmentError> {
        let open = |zoom: &f64| -> Result<Box<dyn Segmenter>, SegmentError> {
            Ok(Box::new(self.open_at(*zoom)?))
        };
        let Some((first, others)) = self.zooms.split_first() else {
            return open(&1.0);
        };
        let first = open(first)?;
        if others.is_empty() {
            return Ok(first);
        }
        let others = others.iter().map(open);
        Ok(Box::new(Mean::new(
            first,
            others.collect::<Result<_, _>>()?,
        )))
    }

    /// The segmenter at one zoom, whatever [`SegmenterOptions::zooms`] are.
    ///
    /// # Errors
    ///
    /// As [`SegmenterOptions::open`].
    pub fn open_at(&self, zoom: f64) -> Result<OnnxSegmenter, SegmentError> {
        if !ZOOMS.contains(&zoom) {
            return Err(SegmentError::Zoom { zoom });
        }
        let (source, name, description) = match &self.model {
            Some(path) => (
                ModelSource::File(path.clone()),
                path.display().to_string(),
                SegmentDescription::beside(path)?,
            ),
            None => built_in::model()?,
        };
        let network = open_network(&source, &self.runtime, THREADS_PER_RUN)?;
        OnnxSegmenter::zoomed(network, name, &description, self.tiling, zoom)
    }
}
