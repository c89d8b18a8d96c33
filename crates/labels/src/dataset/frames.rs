use super::images::{LabelForm, LabelledDataset, LabelledImage};
use super::listing::folder_name;
use crate::error::LabelsError;
use pomona_cloud::{ColorImage, read_labels};
use std::path::{Path, PathBuf};

const COLOR: [&str; 3] = ["color.png", "color.jpg", "color.jpeg"];
const BOXES: [&str; 3] = ["boxes.xml", "boxes.json", "boxes.txt"];

/// Whether a folder is a frame's, with boxes or without.
pub(super) fn is_frame(folder: &Path) -> bool {
    let rest = ["depth.png"].into_iter().chain(BOXES);
    present(folder, &COLOR).is_some() && rest.into_iter().any(|name| folder.join(name).is_file())
}

fn present(folder: &Path, names: &[&str]) -> Option<PathBuf> {
    names
        .iter()
        .map(|name| folder.join(name))
        .find(|path| path.is_file())
}

/// The frames in `folders`, of which `folder` is the one or holds them all.
pub(super) fn read(folder: &Path, folders: &[PathBuf]) -> Result<LabelledDataset, LabelsError> {
    let mut dataset = LabelledDataset::new(folder_name(folder), LabelForm::Frames, Vec::new());
    for frame in folders {
        let (Some(path), boxes) = (present(frame, &COLOR), present(frame, &BOXES)) else {
            continue;
        };
        let Some(boxes) = boxes else {
            dataset.frames_without_boxes += 1;
            continue;
        };
        let (width, height) = ColorImage::read_size(&path)?;
        dataset.images.push(LabelledImage {
            boxes: read_labels(boxes, width, height)?,
            ..LabelledImage::new(folder_name(frame), path, width, height)
        });
    }
    if dataset.images.is_empty() {
        let problem = format!("no {} in the frame", BOXES.join(", "));
        return Err(LabelsError::malformed(
            folder,
            &problem,
            "put the apples' boxes there",
        ));
    }
    Ok(dataset)
}
