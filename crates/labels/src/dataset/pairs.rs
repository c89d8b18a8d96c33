use super::images::{LabelForm, LabelledDataset, LabelledImage};
use super::listing::{files_below, folder_name, is_about_labels, is_image, is_label, name_below};
use crate::error::LabelsError;
use pomona_cloud::{BoxImage, ColorImage, LabelledBox, read_labels};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

const IMAGES: [&str; 2] = ["images", "JPEGImages"];
const LABELS: [&str; 3] = ["labels", "Annotations", "annotations"];

/// The images of a folder with a label file for each; `None` where there are no such files.
pub(super) fn read(
    folder: &Path,
    inside: &[PathBuf],
) -> Result<Option<LabelledDataset>, LabelsError> {
    let sub = |names: &[&str]| {
        names
            .iter()
            .map(|n| folder.join(n))
            .find(|path| path.is_dir())
    };
    let label_folder = sub(&LABELS);
    let (image_folder, images) = match sub(&IMAGES) {
        Some(images) => {
            let files = files_below(&images)?;
            (images, files)
        }
        // Folders beside the images are not of them.
        None => (folder.to_owned(), inside.to_vec()),
    };
    let images: Vec<PathBuf> = images.into_iter().filter(|path| is_image(path)).collect();
    let place = label_folder.clone().unwrap_or_else(|| image_folder.clone());
    let files = match &label_folder {
        Some(labels) => files_below(labels)?,
        None if place == folder => inside.to_vec(),
        None => files_below(&place)?,
    };
    let labels: Vec<PathBuf> = files
        .into_iter()
        .filter(|path| path.is_file() && is_label(path) && !is_about_labels(path))
        .collect();
    if images.is_empty() || (labels.is_empty() && label_folder.is_none()) {
        return Ok(None);
    }
    let mut label_of = by_stem(&labels, &place)?;
    let image_of = by_stem(&images, &image_folder)?;
    if let Some((_, alone)) = label_of
        .iter()
        .find(|(stem, _)| !image_of.contains_key(*stem))
    {
        let problem = format!("a label without its image in {}", image_folder.display());
        return Err(LabelsError::malformed(
            alone,
            &problem,
            "add the image, or remove the label",
        ));
    }
    let names = class_names(folder, &place)?;
    let form = if label_folder.is_some() {
        LabelForm::LabelFolder
    } else {
        LabelForm::BesideImages
    };
    let mut dataset = LabelledDataset::new(folder_name(folder), form, Vec::new());
    for (stem, path) in image_of {
        let (width, height) = ColorImage::read_size(&path)?;
        let turned = ColorImage::turned_by_exif(&path)?;
        dataset
            .warnings
            .extend(turned.map(|warning| (path.clone(), warning)));
        let mut labels = match label_of.remove(&stem) {
            Some(file) => {
                let image = BoxImage::new(width, height).at(&path);
                dataset.note(&file, read_labels(&file, &image)?)
            }
            None if label_folder.is_some() => {
                dataset.without_label_file += 1;
                Vec::new()
            }
            None => {
                return Err(LabelsError::malformed(
                    &path,
                    "no label file beside this image, though others have one",
                    "add an empty one if nothing is to be found there, or keep images and labels in images/ and \
                     labels/",
                ));
            }
        };
        for label in &mut labels {
            name_class(label, &names);
        }
        dataset.images.push(LabelledImage {
            boxes: labels,
            ..LabelledImage::new(name_below(&path, &image_folder), path, width, height)
        });
    }
    Ok(Some(dataset))
}

/// Files by their path in `folder` without the ending.
fn by_stem(files: &[PathBuf], folder: &Path) -> Result<BTreeMap<String, PathBuf>, LabelsError> {
    let mut found: BTreeMap<String, PathBuf> = BTreeMap::new();
    for path in files {
        let stem = name_below(&path.with_extension(""), folder);
        if let Some(other) = found.insert(stem, path.clone()) {
            let problem = format!("has the same name as {}", other.display());
            return Err(LabelsError::malformed(
                path,
                &problem,
                "keep one of the two",
            ));
        }
    }
    Ok(found)
}

/// The names of the classes 0, 1, 2, …, one on each line of `classes.txt`, where there is one.
fn class_names(folder: &Path, labels: &Path) -> Result<Vec<String>, LabelsError> {
    for place in [folder, labels] {
        let path = place.join("classes.txt");
        if path.is_file() {
            let text = fs::read_to_string(&path).map_err(|source| LabelsError::Io {
                path: path.clone(),
                source,
            })?;
            return Ok(text.lines().map(|line| line.trim().to_owned()).collect());
        }
    }
    Ok(Vec::new())
}

fn name_class(label: &mut LabelledBox, names: &[String]) {
    if label.class_name.is_none() {
        let name = label
            .class_number
            .and_then(|n| names.get(usize::try_from(n).ok()?));
        label.class_name = name.cloned();
    }
}
