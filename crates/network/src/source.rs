use std::path::PathBuf;

/// Where a model comes from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ModelSource {
    /// An ONNX file; weights that it keeps in other files are looked for beside it.
    File(PathBuf),
    /// A model that is part of the program.
    BuiltIn {
        /// Its name in reports and messages.
        name: &'static str,
        /// The ONNX file's content.
        bytes: &'static [u8],
    },
}
