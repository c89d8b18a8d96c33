mod coco;
mod frames;
mod listing;
mod pairs;

pub(super) use listing::{files_below, is_about_labels, is_label};

use crate::EvaluateError;
use listing::entries;
use pomona_cloud::{LabelKind, LabelledBox};
use pomona_detect::ClassChoice;
use serde::Serialize;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Images with labels, in the order of their names.
///
/// A folder is recognised by what it holds:
///
/// - `images/` (or `JPEGImages/`) with `labels/` (or `Annotations/`), or images with their label files beside them:
///   each label file YOLO text, VOC XML or COCO JSON of that one image;
/// - one COCO JSON that names its images, in the folder or in its `annotations/`;
/// - a frame: `color.png` or `.jpg` with `boxes.xml`, `.json` or `.txt`; or a folder of frames.
#[derive(Clone, Debug, PartialEq)]
pub struct DetectionDataset {
    /// Name of the folder or of the COCO file.
    pub name: String,
    /// How the labels are kept.
    pub form: LabelForm,
    /// The images.
    pub images: Vec<LabelledImage>,
    /// How many images had no label file and count as background, as YOLO has it.
    pub without_label_file: usize,
    /// How many frames were left out because they have no boxes.
    pub frames_without_boxes: usize,
    /// Numbers of the classes whose labels count alike; empty where the labels have names only.
    pub classes: BTreeSet<u64>,
}

/// How labels are kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum LabelForm {
    /// A file for each image in a folder of labels.
    LabelFolder,
    /// A file for each image, beside it.
    BesideImages,
    /// One COCO file.
    Coco,
    /// Frames with boxes.
    Frames,
}

/// One image and its labels.
#[derive(Clone, Debug, PartialEq)]
pub struct LabelledImage {
    /// Its name: the path within the folder of images, or a frame's folder.
    pub name: String,
    /// Its file.
    pub path: PathBuf,
    /// Width in pixels.
    pub width: usize,
    /// Height in pixels.
    pub height: usize,
    /// Its number in a COCO file.
    pub coco_id: Option<u64>,
    /// Its labels.
    pub labels: Vec<LabelledBox>,
}

impl DetectionDataset {
    /// Reads a folder, or a COCO file; of several classes only `class`, where one is given.
    ///
    /// # Errors
    ///
    /// [`EvaluateError`]: nothing that is recognised; a label without its image; an image without its label where no
    /// folder of labels says that it is background; labels that cannot be read; no label of `class`.
    pub fn read(
        path: impl AsRef<Path>,
        class: Option<&ClassChoice>,
    ) -> Result<Self, EvaluateError> {
        let path = path.as_ref();
        let mut dataset = if path.is_file() {
            coco::read(path)?
        } else {
            of_folder(path)?
        };
        if dataset.images.is_empty() {
            return Err(refused(
                path,
                "no images",
                "give a folder with images and their labels",
            ));
        }
        dataset.images.sort_by(|a, b| a.name.cmp(&b.name));
        if let Some(class) = class {
            dataset
                .keep(class)
                .map_err(|problem| refused(path, &problem, "give one of these by --label-class"))?;
        }
        let numbers = dataset.images.iter().flat_map(|i| &i.labels);
        dataset.classes = numbers.filter_map(|label| label.class_number).collect();
        Ok(dataset)
    }

    /// Lets the labels whose name or class is `name` neither count nor punish; a `*` at its end stands for anything.
    ///
    /// Returns how many there are.
    pub fn ignore(&mut self, name: &str) -> usize {
        let is_meant = |given: &str| match name.strip_suffix('*') {
            Some(start) => given.starts_with(start),
            None => given == name,
        };
        let labels = self.images.iter_mut().flat_map(|i| &mut i.labels);
        let mut count = 0;
        for label in labels {
            let class = label.class_name.as_deref();
            if is_meant(&label.bounds.name) || class.is_some_and(is_meant) {
                label.kind = LabelKind::Difficult;
                count += 1;
            }
        }
        count
    }

    /// Keeps the labels of one class; says what there is where none is of it.
    fn keep(&mut self, class: &ClassChoice) -> Result<(), String> {
        let is_of = |label: &LabelledBox| match class {
            ClassChoice::Number(number) => label.class_number == Some(*number as u64),
            ClassChoice::Name(name) => label.class_name.as_deref() == Some(name),
        };
        let all = || self.images.iter().flat_map(|image| &image.labels);
        if !all().any(is_of) && all().next().is_some() {
            let classes: BTreeSet<String> = all().map(class_of).collect();
            let some: Vec<String> = classes.into_iter().take(20).collect();
            let wanted = match class {
                ClassChoice::Number(number) => number.to_string(),
                ClassChoice::Name(name) => format!("`{name}`"),
            };
            return Err(format!(
                "no label is of the class {wanted}; there are {}",
                some.join(", ")
            ));
        }
        for image in &mut self.images {
            image.labels.retain(is_of);
        }
        Ok(())
    }
}

/// A class in words.
fn class_of(label: &LabelledBox) -> String {
    match (&label.class_number, &label.class_name) {
        (Some(number), Some(name)) => format!("{number} `{name}`"),
        (Some(number), None) => number.to_string(),
        (None, Some(name)) => format!("`{name}`"),
        (None, None) => "one without name".to_owned(),
    }
}

fn of_folder(folder: &Path) -> Result<DetectionDataset, EvaluateError> {
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
    Err(refused(
        folder,
        "neither images with labels (images/ and labels/, images/ and Annotations/, or label files beside the \
         images), nor a COCO file that names its images, nor frames with boxes",
        "give such a folder",
    ))
}

/// What is wrong with a data set, by the file or folder where it shows.
pub(super) fn refused(path: &Path, problem: &str, remedy: &str) -> EvaluateError {
    EvaluateError::Malformed {
        path: path.to_owned(),
        problem: problem.to_owned(),
        remedy: remedy.to_owned(),
    }
}
