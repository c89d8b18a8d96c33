use crate::{DetectError, ModelDescription, ModelSource};

/// What stands for the built-in model in reports and messages.
const NAME: &str = "built-in apple model";

/// The network; `model/README.md` is its card, `training/` its recipe.
static NETWORK: &[u8] = include_bytes!("../model/apple.onnx");

/// How it is read.
const DESCRIPTION: &str = include_str!("../model/apple.toml");

/// The model that is part of the program, its name, and its description.
///
/// # Errors
///
/// None that a caller could meet: the description is tested with the program.
pub(crate) fn model() -> Result<(ModelSource, String, ModelDescription), DetectError> {
    let source = ModelSource::BuiltIn {
        name: NAME,
        bytes: NETWORK,
    };
    let description = ModelDescription::parse(DESCRIPTION, NAME)?;
    Ok((source, NAME.to_owned(), description))
}
