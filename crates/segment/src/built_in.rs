use crate::{description::SegmentDescription, error::SegmentError};
use pomona_network::ModelSource;

/// What the model that is part of the program is called.
const NAME: &str = "built-in wood model";

/// The model that is part of the program, its name, and its description.
///
/// # Errors
///
/// [`SegmentError`] for a description that cannot be read; a test holds it to be fine.
pub(crate) fn model() -> Result<(ModelSource, String, SegmentDescription), SegmentError> {
    let source = ModelSource::BuiltIn {
        name: NAME,
        bytes: include_bytes!("../model/wood.onnx"),
    };
    let description = SegmentDescription::parse(include_str!("../model/wood.toml"), NAME)?;
    Ok((source, NAME.to_owned(), description))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_described() {
        let (_, _, description) = model().unwrap();
        assert!(description.licence.is_some() && description.source.is_some());
        assert!(description.activation.is_some() && description.classes.is_some());
    }
}
