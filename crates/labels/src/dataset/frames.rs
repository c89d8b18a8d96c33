use super::images::{LabelForm, LabelledDataset, LabelledImage};
use super::listing::folder_name;
use crate::error::LabelsError;
use pomona_cloud::{BoxImage, ColorImage, Frame, read_labels};
use std::path::{Path, PathBuf};

/// Whether a folder is a frame's, with boxes or without.
pub(super) fn is_frame(folder: &Path) -> bool {
    let rest = ["depth.png"].into_iter().chain(Frame::BOX_FILES);
    present(folder, &Frame::COLOR_FILES).is_some()
        && rest.into_iter().any(|name| folder.join(name).is_file())
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
        let (Some(path), boxes) = (
            present(frame, &Frame::COLOR_FILES),
            present(frame, &Frame::BOX_FILES),
        ) else {
            continue;
        };
        let Some(boxes) = boxes else {
            dataset.frames_without_boxes += 1;
            continue;
        };
        let (width, height) = ColorImage::read_size(&path)?;
        let turned = ColorImage::turned_by_exif(&path)?;
        dataset
            .warnings
            .extend(turned.map(|warning| (path.clone(), warning)));
        let image = BoxImage::new(width, height).at(&path);
        let labels = dataset.note(&boxes, read_labels(&boxes, &image)?);
        dataset.images.push(LabelledImage {
            boxes: labels,
            ..LabelledImage::new(folder_name(frame), path, width, height)
        });
    }
    if dataset.images.is_empty() {
        let problem = format!("no {} in the frame", Frame::BOX_FILES.join(", "));
        return Err(LabelsError::malformed(
            folder,
            &problem,
            "put the apples' boxes there",
        ));
    }
    Ok(dataset)
}
