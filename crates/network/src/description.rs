//! The small TOML file beside a model: how it is read, and the values in it that every kind of network shares.

mod values;

use crate::{error::NetworkError, names::nearest};
use pomona_files::Malformed;
use serde::de::DeserializeOwned;
use std::{
    fs, io,
    path::{Path, PathBuf},
};

pub use values::{
    class_names, input_size, mean, not_a_share, refuse, scale, std, tile, tile_overlap,
};

/// Where the description of a model file is: beside it, with the extension `toml`.
pub fn path_beside(model: &Path) -> PathBuf {
    model.with_extension("toml")
}

/// The text beside a model file and its path; `None` where there is no such file.
///
/// # Errors
///
/// [`NetworkError::Read`] for a file that is there and cannot be read.
pub fn read_beside(model: &Path) -> Result<Option<(String, String)>, NetworkError> {
    let path = path_beside(model);
    match fs::read_to_string(&path) {
        Ok(text) => Ok(Some((text, path.display().to_string()))),
        Err(source) if source.kind() == io::ErrorKind::NotFound => Ok(None),
        Err(source) => Err(NetworkError::Read { path, source }),
    }
}

/// Reads a description from `text`; `origin` is the file in messages, and `remedy` tells where its keys are explained.
///
/// # Errors
///
/// [`NetworkError::Model`] with the line and the key; for a key that does not exist it offers the nearest.
pub fn parse<T: DeserializeOwned>(
    text: &str,
    origin: &str,
    remedy: &str,
) -> Result<T, NetworkError> {
    toml::from_str(text).map_err(|error| {
        let (line, key) = line_and_key(text, error.span().map_or(0, |span| span.start));
        let remedy = match key {
            Some(key) if error.message().starts_with("unknown field") => {
                let known = known_keys(error.message());
                format!("the nearest keys are {}", nearest(key, &known))
            }
            _ => remedy.to_owned(),
        };
        let key = key.map_or_else(String::new, |key| format!(", `{key}`"));
        let problem = error.message().trim().replace('\n', " ");
        NetworkError::model(
            origin,
            Malformed::new(format!("line {line}{key}"), problem, remedy),
        )
    })
}

/// The keys in the message for an unknown one: each stands in backquotes, after the unknown one itself.
pub fn known_keys(message: &str) -> Vec<&str> {
    message.split('`').skip(3).step_by(2).collect()
}

/// The line of a byte of the text, from 1, and the key that stands there.
fn line_and_key(text: &str, byte: usize) -> (usize, Option<&str>) {
    let before = text.get(..byte).unwrap_or_default();
    let line = before.matches('\n').count();
    let key = text.lines().nth(line).and_then(|line| line.split_once('='));
    (line + 1, key.map(|(key, _)| key.trim()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde::Deserialize;

    #[derive(Debug, Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Kettle {
        #[expect(dead_code, reason = "it is only read")]
        temperature: f64,
    }

    #[test]
    fn messages_name_file_line_and_key() {
        let message = |text| parse::<Kettle>(text, "k.toml", "see the manual").unwrap_err();
        let unknown = message("temperature = 1\ntemprature = 2").to_string();
        assert!(
            unknown.starts_with("k.toml: line 2, `temprature`: unknown field"),
            "{unknown}"
        );
        assert!(unknown.contains("nearest keys are `temperature`"));
        let kind = message("temperature = 'hot'").to_string();
        assert!(kind.contains("line 1, `temperature`") && kind.ends_with("see the manual"));
        parse::<Kettle>("temperature = 3.5", "k.toml", "").unwrap();
    }

    #[test]
    fn a_description_is_beside_its_model() {
        let folder = tempfile::tempdir().unwrap();
        let model = folder.path().join("apples.onnx");
        assert!(read_beside(&model).unwrap().is_none());
        fs::write(folder.path().join("apples.toml"), "fill = 3").unwrap();
        let (text, origin) = read_beside(&model).unwrap().unwrap();
        assert_eq!(text, "fill = 3");
        assert!(origin.ends_with("apples.toml"));
        fs::remove_file(folder.path().join("apples.toml")).unwrap();
        fs::create_dir(folder.path().join("apples.toml")).unwrap();
        assert!(read_beside(&model).is_err());
    }
}
