use crate::{description::ModelDescription, error::DetectError};
use pomona_network::ModelSource;

/// What the model that is part of the program is called.
const NAME: &str = "built-in apple model";

/// The model that is part of the program, its name, and its description.
///
/// # Errors
///
/// [`DetectError`] for a description that cannot be read; a test holds it to be fine.
pub(crate) fn model() -> Result<(ModelSource, String, ModelDescription), DetectError> {
    let source = ModelSource::BuiltIn {
        name: NAME,
        bytes: include_bytes!("../model/apple.onnx"),
    };
    let description = ModelDescription::parse(include_str!("../model/apple.toml"), NAME)?;
    Ok((source, NAME.to_owned(), description))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::family::Family;

    #[test]
    fn it_is_described() {
        let (_, _, description) = model().unwrap();
        assert_eq!(description.family, Some(Family::YoloV8));
        assert!(description.licence.is_some() && description.source.is_some());
    }
}
