use pomona_cloud::{ImageKey, LabelKind, LabelledBox, Warning, WithWarnings};
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
#[non_exhaustive]
pub struct LabelledDataset {
    /// Name of the folder or of the COCO file.
    pub name: String,
    /// How the labels are stored.
    pub form: LabelForm,
    /// The images.
    pub images: Vec<LabelledImage>,
    /// Number of images without a label file, which count as background as in YOLO.
    pub without_label_file: usize,
    /// Number of frames left out because they have no boxes.
    pub frames_without_boxes: usize,
    /// Numbers of the classes whose labels count alike; empty where the labels have names only.
    pub classes: BTreeSet<u64>,
    /// What is doubtful about the labels, each with its file.
    pub warnings: Vec<(PathBuf, Warning)>,
}

/// How labels are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
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
#[non_exhaustive]
pub struct LabelledImage {
    /// Its name: the path within the folder of images, or a frame's folder.
    pub name: String,
    /// Its file.
    pub path: PathBuf,
    /// Width in pixels.
    pub width: usize,
    /// Height in pixels.
    pub height: usize,
    /// What identifies it in a COCO file.
    pub coco_id: Option<ImageKey>,
    /// The boxes that are labelled in it.
    pub boxes: Vec<LabelledBox>,
}

impl LabelledImage {
    /// An image without labels.
    pub fn new(
        name: impl Into<String>,
        path: impl Into<PathBuf>,
        width: usize,
        height: usize,
    ) -> Self {
        Self {
            name: name.into(),
            path: path.into(),
            width,
            height,
            coco_id: None,
            boxes: Vec::new(),
        }
    }
}

impl LabelledDataset {
    /// A data set of these images, in their order.
    pub fn new(name: impl Into<String>, form: LabelForm, images: Vec<LabelledImage>) -> Self {
        Self {
            name: name.into(),
            form,
            images,
            without_label_file: 0,
            frames_without_boxes: 0,
            classes: BTreeSet::new(),
            warnings: Vec::new(),
        }
    }

    /// What was read from a file, whose warnings are kept.
    pub(super) fn note<T>(&mut self, file: &Path, read: WithWarnings<T>) -> T {
        let warnings = read.warnings.into_iter();
        self.warnings
            .extend(warnings.map(|warning| (file.to_owned(), warning)));
        read.value
    }

    /// Marks the boxes whose name or class is `name` as difficult, so that they are ignored in matching; a `*` at its
    /// end matches anything.
    ///
    /// Returns their number.
    pub fn ignore(&mut self, name: &str) -> usize {
        let is_meant = |given: &str| match name.strip_suffix('*') {
            Some(start) => given.starts_with(start),
            None => given == name,
        };
        let labels = self.images.iter_mut().flat_map(|i| &mut i.boxes);
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

    /// Keeps the boxes of one class; the error names the classes there are where none is of it.
    pub(super) fn keep(&mut self, class: &ClassChoice) -> Result<(), String> {
        let is_of = |label: &LabelledBox| match class {
            ClassChoice::Number(number) => label.class_number == Some(*number as u64),
            ClassChoice::Name(name) => label.class_name.as_deref() == Some(name),
        };
        let all = || self.images.iter().flat_map(|image| &image.boxes);
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
            image.boxes.retain(is_of);
        }
        Ok(())
    }
}

/// A class as a message names it.
fn class_of(label: &LabelledBox) -> String {
    match (&label.class_number, &label.class_name) {
        (Some(number), Some(name)) => format!("{number} `{name}`"),
        (Some(number), None) => number.to_string(),
        (None, Some(name)) => format!("`{name}`"),
        (None, None) => "one without name".to_owned(),
    }
}
