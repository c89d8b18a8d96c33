use std::path::PathBuf;

/// Which inference backend runs a network.
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
