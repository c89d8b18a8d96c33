use super::images::{LabelForm, LabelledDataset, LabelledImage};
use super::listing::folder_name;
use crate::error::LabelsError;
use pomona_cloud::{BoxImage, ColorImage, Frame, read_labels};
use std::path::{Path, PathBuf};

/// Whether a folder is a frame's, with boxes or without.
pub(super) fn is_frame(folder: &Path) -> bool {
    let rest = Frame::depth_file(folder).or_else(|| Frame::box_file(folder));
    Frame::color_file(folder).is_some() && rest.is_some()
}

/// The frames in `folders`, of which `folder` is the one or holds them all.
pub(super) fn read(folder: &Path, folders: &[PathBuf]) -> Result<LabelledDataset, LabelsError> {
    let mut dataset = LabelledDataset::new(folder_name(folder), LabelForm::Frames, Vec::new());
    for frame in folders {
        let (Some(path), boxes) = (Frame::color_file(frame), Frame::box_file(frame)) else {
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
