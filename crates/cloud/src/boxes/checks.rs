//! What every box file is checked for.

use super::labelled::LabelledBox;
use super::pixel_box::{BoxError, PixelBox};
use crate::CloudError;
use pomona_files::Malformed;
use std::path::Path;

pub(crate) fn validate_all(
    path: &Path,
    boxes: &[PixelBox],
    width: usize,
    height: usize,
) -> Result<(), CloudError> {
    let checked = boxes.iter().try_for_each(|b| b.validate(width, height));
    checked.map_err(|source| at_file(path, source))
}

/// Refuses labels that do not touch their image.
pub(super) fn touch_all(
    path: &Path,
    labels: &[LabelledBox],
    width: usize,
    height: usize,
) -> Result<(), CloudError> {
    let checked = labels
        .iter()
        .try_for_each(|label| label.bounds.touches(width, height));
    checked.map_err(|source| at_file(path, source))
}

pub(super) fn at_file(path: &Path, source: BoxError) -> CloudError {
    CloudError::Box {
        path: path.to_owned(),
        source,
    }
}

/// The text of a box file, without a byte-order mark.
pub(super) fn text_of(bytes: &[u8]) -> Result<&str, Malformed> {
    let text = std::str::from_utf8(bytes).map_err(|e| {
        let place = format!("byte {}", e.valid_up_to());
        Malformed::new(
            place,
            "not UTF-8 text",
            "give boxes as VOC XML, COCO JSON or YOLO text",
        )
    })?;
    Ok(text.trim_start_matches('\u{feff}'))
}
