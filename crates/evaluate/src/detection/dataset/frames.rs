use super::listing::folder_name;
use super::{DetectionDataset, LabelForm, LabelledImage, refused};
use crate::EvaluateError;
use pomona_cloud::{ColorImage, read_labels};
use std::collections::BTreeSet;
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
pub(super) fn read(folder: &Path, folders: &[PathBuf]) -> Result<DetectionDataset, EvaluateError> {
    let mut dataset = DetectionDataset {
        name: folder_name(folder),
        form: LabelForm::Frames,
        images: Vec::new(),
        without_label_file: 0,
        frames_without_boxes: 0,
        classes: BTreeSet::new(),
    };
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
            name: folder_name(frame),
            labels: read_labels(boxes, width, height)?,
            path,
            width,
            height,
            coco_id: None,
        });
    }
    if dataset.images.is_empty() {
        let problem = format!("no {} in the frame", BOXES.join(", "));
        return Err(refused(folder, &problem, "put the apples' boxes there"));
    }
    Ok(dataset)
}
