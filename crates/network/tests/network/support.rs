//! What several tests share.

use crate::onnx::{self, Noise};
use pomona_network::{
    ModelSource, Network, NetworkError, Port, RuntimeChoice, Tensor, open_network,
};
use std::path::{Path, PathBuf};

/// Writes a model into a folder and opens it, with one thread to a run.
pub(crate) fn open_bytes(
    folder: &Path,
    bytes: &[u8],
    choice: &RuntimeChoice,
) -> Result<Box<dyn Network>, NetworkError> {
    let path = folder.join("model.onnx");
    std::fs::write(&path, bytes).unwrap();
    open_network(&ModelSource::File(path), choice, 1)
}

/// The choices that this build and this machine have; says so where ONNX Runtime is not among them.
pub(crate) fn runtimes() -> Vec<RuntimeChoice> {
    let mut choices = Vec::new();
    if cfg!(feature = "embedded") {
        choices.push(RuntimeChoice::Embedded);
    }
    if has_onnx_runtime() {
        choices.push(RuntimeChoice::OnnxRuntime);
    }
    choices
}

/// Whether ONNX Runtime can be used here; prints why not.
pub(crate) fn has_onnx_runtime() -> bool {
    let folder = tempfile::tempdir().unwrap();
    let outcome = open_bytes(
        folder.path(),
        &onnx::small().to_bytes(),
        &RuntimeChoice::OnnxRuntime,
    );
    if let Err(error) = &outcome {
        println!("skipped for ONNX Runtime: {error}");
    }
    outcome.is_ok()
}

/// A file of the folder `shared` beside the project; says so where it is not there.
pub(crate) fn shared(path: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../../shared")
        .join(path);
    if path.exists() {
        return Some(path);
    }
    println!("skipped: {} is not here", path.display());
    None
}

/// Inputs of noise over 0 to `most`, with `open` for axes that the model leaves open.
pub(crate) fn noise(network: &dyn Network, open: usize, most: f32) -> Vec<Tensor> {
    let mut noise = Noise(11);
    let fill = |port: &Port| {
        let axis = |(index, axis): (usize, &Option<usize>)| {
            axis.unwrap_or(if index == 0 { 1 } else { open })
        };
        let shape: Vec<usize> = port.shape.iter().enumerate().map(axis).collect();
        let data = (0..shape.iter().product())
            .map(|_| most * noise.even())
            .collect();
        Tensor {
            name: port.name.clone(),
            shape,
            data,
        }
    };
    network.inputs().iter().map(fill).collect()
}

/// The largest difference between two runs' outputs, which must agree in names and shapes.
pub(crate) fn largest_difference(one: &[Tensor], other: &[Tensor]) -> f32 {
    assert_eq!(one.len(), other.len());
    let mut largest = 0.0_f32;
    for (one, other) in one.iter().zip(other) {
        assert_eq!((&one.name, &one.shape), (&other.name, &other.shape));
        assert_eq!(one.data.len(), one.shape.iter().product::<usize>());
        for (one, other) in one.data.iter().zip(&other.data) {
            assert!(one.is_finite() && other.is_finite());
            largest = largest.max((one - other).abs());
        }
    }
    largest
}
