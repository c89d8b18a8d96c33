use crate::{DetectError, RuntimeReport};

/// What the numbers of a [`Port`] are stored as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Element {
    /// 32-bit floating point.
    F32,
    /// 16-bit floating point.
    F16,
    /// 8-bit unsigned.
    U8,
    /// 32-bit signed.
    I32,
    /// 64-bit signed.
    I64,
    /// Anything else.
    Other,
}

/// One input or output of a network.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Port {
    /// Its name in the model.
    pub name: String,
    /// Length of each axis; `None` for one that the model leaves open.
    pub shape: Vec<Option<usize>>,
    /// What its numbers are stored as.
    pub element: Element,
}

/// Numbers that a network takes or gives.
#[derive(Clone, Debug, PartialEq)]
pub struct Tensor {
    /// Its name in the model.
    pub name: String,
    /// Length of each axis, slowest first.
    pub shape: Vec<usize>,
    /// The values, row-major, turned into `f32` whatever the model stores.
    pub data: Vec<f32>,
}

/// A network that is loaded and can be run: what stands between a model's file and its detections.
///
/// Implement it for a runtime that this crate does not bring. One network serves many threads.
pub trait Network: Send + Sync {
    /// What it takes.
    fn inputs(&self) -> &[Port];

    /// What it gives.
    fn outputs(&self) -> &[Port];

    /// Runs it once; the outputs in the order of [`Network::outputs`].
    ///
    /// # Errors
    ///
    /// [`DetectError::Model`] where the model refuses its input or fails.
    fn run(&self, inputs: &[Tensor]) -> Result<Vec<Tensor>, DetectError>;

    /// What the exporter wrote into the model's file, such as the classes' names; empty where nothing.
    fn metadata(&self) -> &[(String, String)] {
        &[]
    }

    /// What runs it.
    fn report(&self) -> RuntimeReport;
}
