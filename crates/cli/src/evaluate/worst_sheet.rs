//! Sheets with pictures of the images on which a detector or segmenter did worst.

use crate::output_folder::Staging;
use pomona_view::{ContactSheetImage, contact_sheet};
use std::path::Path;

/// Pictures in a row of a sheet.
const COLUMNS: usize = 4;
/// Side of a picture on a sheet, pixels.
const SIDE: usize = 416;

/// The file of the sheet of this number, counted from 1.
fn name(number: usize) -> String {
    format!("worst-{number}.png")
}

/// Whether a file of this name is such a sheet.
pub(super) fn is_sheet(name: &str) -> bool {
    let number = name
        .strip_prefix("worst-")
        .and_then(|n| n.strip_suffix(".png"));
    number.is_some_and(|n| n.parse::<usize>().is_ok())
}

/// Writes the sheet of this number, counted from 1; its file's name, empty where there is no picture.
pub(super) fn write(
    pictures: &[ContactSheetImage],
    number: usize,
    output: &Staging<'_>,
) -> anyhow::Result<String> {
    if pictures.is_empty() {
        return Ok(String::new());
    }
    let name = name(number);
    contact_sheet(pictures, COLUMNS, SIDE)?.write(output.file(&name))?;
    Ok(name)
}

/// What a model, a file or a folder is called in an evaluation: its name without the ending of a file.
pub(super) fn stem(path: &Path) -> String {
    let name = if path.is_dir() {
        path.file_name()
    } else {
        path.file_stem()
    };
    name.map_or_else(
        || path.display().to_string(),
        |name| name.to_string_lossy().into_owned(),
    )
}
