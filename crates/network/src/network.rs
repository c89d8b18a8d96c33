use crate::{
    error::NetworkError,
    tensor::{Port, Tensor},
};
use serde::Serialize;

/// A network that is loaded and can be run.
///
/// Implement it for an inference backend that this crate does not bring. One network serves many threads.
pub trait Network: Send + Sync {
    /// What it takes.
    fn inputs(&self) -> &[Port];

    /// What it gives.
    fn outputs(&self) -> &[Port];

    /// Runs it once; the outputs in the order of [`Network::outputs`].
    ///
    /// # Errors
    ///
    /// [`NetworkError::Model`] where the model refuses its input or fails.
    fn run(&self, inputs: &[Tensor]) -> Result<Vec<Tensor>, NetworkError>;

    /// What the exporter wrote into the model's file, such as the classes' names; empty where nothing.
    fn metadata(&self) -> &[(String, String)] {
        &[]
    }

    /// The inference backend that runs it.
    fn report(&self) -> RuntimeReport;
}

/// The inference backend that ran a network.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct RuntimeReport {
    /// `onnxruntime` or `embedded`.
    pub name: String,
    /// Its version.
    pub version: String,
    /// The library that was loaded; absent for the embedded one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub library: Option<String>,
    /// Why a backend that was preferred could not be used; absent where none was.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fallback_reason: Option<String>,
}

impl RuntimeReport {
    /// A backend that needs no library and was not a fallback.
    pub fn new(name: impl Into<String>, version: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            version: version.into(),
            library: None,
            fallback_reason: None,
        }
    }
}
