//! The names of numbered classes, which YOLO keeps in a file of its own.

use super::parsed::Parsed;
use crate::CloudError;
use pomona_files::FileError;
use std::io::ErrorKind;
use std::path::Path;

/// What labelling tools call the file beside the labels with the name of a class on each line.
const FILE: &str = "classes.txt";

/// Names the classes of `parsed` that have numbers alone, where there is such a file beside the box file at `path`.
pub(super) fn add(parsed: &mut Parsed, path: &Path) -> Result<(), CloudError> {
    let is_numbered =
        |label: &super::LabelledBox| label.class_number.is_some() && label.class_name.is_none();
    let mut labels = parsed.images.iter().flat_map(|image| &image.labels);
    if !parsed.classes.is_empty() || !labels.any(is_numbered) {
        return Ok(());
    }
    let names = path.with_file_name(FILE);
    let text = match std::fs::read_to_string(&names) {
        Ok(text) => text,
        Err(e) if e.kind() == ErrorKind::NotFound => return Ok(()),
        Err(source) => return Err(FileError::read(names, source).into()),
    };
    parsed.classes = text.lines().map(|line| line.trim().to_owned()).collect();
    for label in parsed.images.iter_mut().flat_map(|image| &mut image.labels) {
        if is_numbered(label) {
            let number = label.class_number.and_then(|n| usize::try_from(n).ok());
            label.class_name = number.and_then(|n| parsed.classes.get(n)).cloned();
        }
    }
    Ok(())
}
