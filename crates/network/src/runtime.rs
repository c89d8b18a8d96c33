//! The inference backends: ONNX Runtime where the machine has it, and rten, which is built in.

mod choice;
#[cfg(feature = "embedded")]
mod embedded;
#[cfg(feature = "embedded")]
mod explicit_attributes;
#[cfg(any(feature = "embedded", feature = "onnxruntime"))]
mod idle;
#[cfg(any(feature = "embedded", feature = "onnxruntime"))]
mod inputs;
#[cfg(any(feature = "embedded", feature = "onnxruntime"))]
mod isolated;
#[cfg(feature = "onnxruntime")]
mod library;
#[cfg(feature = "onnxruntime")]
mod onnxruntime;
#[cfg(feature = "onnxruntime")]
mod places;
#[cfg(feature = "onnxruntime")]
mod truncation;

pub use choice::RuntimeChoice;

use crate::{error::NetworkError, network::Network, onnx_file::OnnxFile, source::ModelSource};

/// Opens a network.
///
/// `threads` is how many threads one run uses, at least 1. One network serves any number of threads at
/// once, so 1 is best where images or tiles are spread over the cores, and more where there is but one.
///
/// # Errors
///
/// [`NetworkError::Read`] for a file that cannot be read, [`NetworkError::Model`] for one that is not a usable
/// model, [`NetworkError::Runtime`] where no inference backend of the chosen kind can be used.
pub fn open_network(
    source: &ModelSource,
    choice: &RuntimeChoice,
    threads: usize,
) -> Result<Box<dyn Network>, NetworkError> {
    let file = OnnxFile::read(source)?;
    let open = match choice {
        RuntimeChoice::Embedded => embedded(None)?,
        RuntimeChoice::OnnxRuntime | RuntimeChoice::Library(_) => onnx_runtime(choice)?,
        RuntimeChoice::Automatic => match onnx_runtime(choice) {
            Ok(open) => open,
            Err(error) => embedded(Some(error.to_string())).map_err(|_| error)?,
        },
    };
    open(file, threads.max(1))
}

/// Opens a file, with so many threads to a run, in a backend that can be used.
type Open = Box<dyn FnOnce(OnnxFile, usize) -> Result<Box<dyn Network>, NetworkError>>;

#[cfg(feature = "onnxruntime")]
fn onnx_runtime(choice: &RuntimeChoice) -> Result<Open, NetworkError> {
    let library = library::load(choice)?;
    Ok(Box::new(|file, threads| {
        let network = onnxruntime::OnnxRuntime::open(file, library, threads)?;
        Ok(Box::new(network))
    }))
}

#[cfg(not(feature = "onnxruntime"))]
fn onnx_runtime(_choice: &RuntimeChoice) -> Result<Open, NetworkError> {
    Err(left_out("ONNX Runtime", "onnxruntime"))
}

#[cfg(feature = "embedded")]
#[expect(
    clippy::unnecessary_wraps,
    reason = "a build without it has only an error"
)]
fn embedded(fallback_reason: Option<String>) -> Result<Open, NetworkError> {
    Ok(Box::new(|file, threads| {
        let network = embedded::Embedded::open(file, threads, fallback_reason)?;
        Ok(Box::new(network))
    }))
}

#[cfg(not(feature = "embedded"))]
fn embedded(_fallback_reason: Option<String>) -> Result<Open, NetworkError> {
    Err(left_out("the embedded runtime", "embedded"))
}

#[cfg(not(all(feature = "onnxruntime", feature = "embedded")))]
fn left_out(runtime: &str, feature: &str) -> NetworkError {
    NetworkError::Runtime {
        runtime: runtime.to_owned(),
        problem: "left out of this build".to_owned(),
        remedy: format!(
            "build pomona-network with its feature `{feature}`, or choose the other runtime"
        ),
    }
}
