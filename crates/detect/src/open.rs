use crate::{
    built_in, description::ModelDescription, detection::Detector, error::DetectError,
    onnx_detector::OnnxDetector, options::DetectorOptions,
};
use pomona_network::{ModelSource, open_network};

/// Threads of one run of a network: it is the tiles that are spread over the cores.
const THREADS_PER_RUN: usize = 1;

impl DetectorOptions {
    /// Opens the detector.
    ///
    /// # Errors
    ///
    /// [`DetectError`] for a model, a description, an inference backend or a setting that cannot be used.
    pub fn open(&self) -> Result<Box<dyn Detector>, DetectError> {
        let (source, name, description) = match &self.model {
            Some(path) => (
                ModelSource::File(path.clone()),
                path.display().to_string(),
                ModelDescription::beside(path)?,
            ),
            None => built_in::model()?,
        };
        let network = open_network(&source, &self.runtime, THREADS_PER_RUN)?;
        let detector = OnnxDetector::new(network, name, &description, self)?;
        Ok(Box::new(detector))
    }
}
