use crate::{DetectError, ModelDescription, ModelSource};

/// The model that is part of the program, its name, and its description.
///
/// # Errors
///
/// [`DetectError::Model`]: this build holds none. One comes in as `include_bytes!` of `model/apple.onnx` and
/// `include_str!` of `model/apple.toml`.
pub(crate) fn model() -> Result<(ModelSource, String, ModelDescription), DetectError> {
    Err(DetectError::Model {
        model: "built-in model".to_owned(),
        place: "the program".to_owned(),
        problem: "this build holds no model".to_owned(),
        remedy: "name an ONNX file, or give boxes".to_owned(),
    })
}
