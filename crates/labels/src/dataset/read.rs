use super::images::LabelledDataset;
use super::listing::entries;
use super::{coco, frames, pairs};
use crate::error::LabelsError;
use pomona_detect::ClassChoice;
use std::path::{Path, PathBuf};

impl LabelledDataset {
    /// Reads a folder, or a COCO file; of several classes only `class`, where one is given.
    ///
    /// # Errors
    ///
    /// [`LabelsError`]: nothing that is recognised; a label without its image; an image without its label where no
    /// folder of labels says that it is background; labels that cannot be read; no label of `class`.
    pub fn read(path: impl AsRef<Path>, class: Option<&ClassChoice>) -> Result<Self, LabelsError> {
        let path = path.as_ref();
        let mut dataset = if path.is_file() {
            coco::read(path)?
        } else {
            of_folder(path)?
        };
        if dataset.images.is_empty() {
            return Err(LabelsError::malformed(
                path,
                "no images",
                "give a folder with images and their labels",
            ));
        }
        dataset.images.sort_by(|a, b| a.name.cmp(&b.name));
        if let Some(class) = class {
            dataset.keep(class).map_err(|problem| {
                LabelsError::malformed(path, &problem, "give one of these by --label-class")
            })?;
        }
        let numbers = dataset.images.iter().flat_map(|i| &i.boxes);
        dataset.classes = numbers.filter_map(|label| label.class_number).collect();
        Ok(dataset)
    }
}

fn of_folder(folder: &Path) -> Result<LabelledDataset, LabelsError> {
    let inside = entries(folder)?;
    if frames::is_frame(folder) {
        return frames::read(folder, &[folder.to_owned()]);
    }
    if let Some(file) = coco::find(folder)? {
        return coco::read(&file);
    }
    if let Some(dataset) = pairs::read(folder, &inside)? {
        return Ok(dataset);
    }
    let folders: Vec<PathBuf> = inside
        .into_iter()
        .filter(|path| frames::is_frame(path))
        .collect();
    if !folders.is_empty() {
        return frames::read(folder, &folders);
    }
    Err(LabelsError::malformed(
        folder,
        "neither images with labels (images/ and labels/, images/ and Annotations/, or label files beside the \
         images), nor a COCO file that names its images, nor frames with boxes",
        "give such a folder",
    ))
}
