//! COCO JSON of many images, and the list of detections that its result files are.

use super::checks::{at_file, text_of, touch_all};
use super::coco::{Annotation, Category, Dataset, Image, fault, fault_of, unlisted};
use super::coco_values::{Bounds, ImageKey, Polygons};
use super::labelled::{LabelKind, LabelledBox};
use super::pixel_box::PixelBox;
use crate::CloudError;
use pomona_files::{Malformed, write_atomically};
use serde::Deserialize;
use std::collections::HashMap;
use std::path::Path;

/// The labels of many images in one file, <https://cocodataset.org/#format-data>.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct CocoDataset {
    /// The images in the file's order, each with its boxes.
    pub images: Vec<CocoImage>,
    /// The classes.
    pub categories: Vec<CocoCategory>,
}

/// One image of a [`CocoDataset`].
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct CocoImage {
    /// What identifies it in the file.
    pub id: ImageKey,
    /// Its file, relative to a folder that the dataset does not name.
    pub file_name: String,
    /// Width in pixels; 0 where the file does not say.
    pub width: usize,
    /// Height in pixels; 0 where the file does not say.
    pub height: usize,
    /// Its boxes, in the file's order.
    pub boxes: Vec<LabelledBox>,
}

impl CocoImage {
    /// An image of unknown size without boxes.
    pub fn new(id: impl Into<ImageKey>, file_name: impl Into<String>) -> Self {
        Self {
            id: id.into(),
            file_name: file_name.into(),
            width: 0,
            height: 0,
            boxes: Vec::new(),
        }
    }
}

/// One class of a [`CocoDataset`].
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct CocoCategory {
    /// Its number, which `class_number` of a box refers to; its place in the list where the file identifies it by a
    /// text.
    pub id: u64,
    /// Its name; empty where the file gives none.
    pub name: String,
}

impl CocoCategory {
    /// A class.
    pub fn new(id: u64, name: impl Into<String>) -> Self {
        Self {
            id,
            name: name.into(),
        }
    }
}

/// One detection of a COCO result file.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct CocoResult {
    /// The image it is of.
    pub image: ImageKey,
    /// The box, with its score.
    pub label: LabelledBox,
}

impl CocoDataset {
    /// Reads a dataset: `images`, each with `id` and `file_name`, `annotations`, and perhaps `categories`.
    ///
    /// # Errors
    ///
    /// [`CloudError::File`], also for an image without `file_name`, one that is
    /// given twice, and an annotation of an image that is not listed; [`CloudError::Box`] for a box that is inverted,
    /// not finite, or outside an image whose size is given.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, CloudError> {
        let path = path.as_ref();
        let bytes = pomona_files::read(path)?;
        let dataset = parse(&bytes).map_err(|fault| fault.at(path))?;
        for image in &dataset.images {
            let (width, height) = image.size_or_any();
            touch_all(path, &image.boxes, width, height)?;
        }
        Ok(dataset)
    }

    /// Writes the dataset; annotations are numbered from 1 on, in order.
    ///
    /// # Errors
    ///
    /// [`CloudError::Box`] for a box that could not be read back, [`CloudError::File`].
    pub fn write(&self, path: impl AsRef<Path>) -> Result<(), CloudError> {
        let path = path.as_ref();
        for image in &self.images {
            let (width, height) = image.size_or_any();
            touch_all(path, &image.boxes, width, height)?;
        }
        write_atomically(path, format(self).as_bytes())?;
        Ok(())
    }
}

impl CocoImage {
    /// Its size; where that is not known, one that holds every box.
    fn size_or_any(&self) -> (usize, usize) {
        let known = |side: usize| if side == 0 { usize::MAX } else { side };
        (known(self.width), known(self.height))
    }
}

/// Reads a result file: a list of detections, each with `image_id`, `category_id`, `bbox` and `score`.
///
/// The boxes are finite and not inverted; whether they lie in their images is not known here.
///
/// # Errors
///
/// [`CloudError::File`], [`CloudError::Box`].
pub fn read_coco_results(path: impl AsRef<Path>) -> Result<Vec<CocoResult>, CloudError> {
    let path = path.as_ref();
    let bytes = pomona_files::read(path)?;
    let results = parse_results(&bytes).map_err(|fault| fault.at(path))?;
    // The images' sizes are not known here.
    let checked = results.iter().try_for_each(|result| {
        let bounds = &result.label.bounds;
        bounds.touches(usize::MAX, usize::MAX)
    });
    checked.map_err(|source| at_file(path, source))?;
    Ok(results)
}

fn parse(bytes: &[u8]) -> Result<CocoDataset, Malformed> {
    let dataset: Dataset = serde_json::from_str(text_of(bytes)?).map_err(fault)?;
    let mut images = Vec::with_capacity(dataset.images.len());
    let mut index_of = HashMap::with_capacity(dataset.images.len());
    for (index, image) in dataset.images.into_iter().enumerate() {
        let place = || format!("`images`[{index}]");
        let Some(file_name) = image.file_name else {
            let problem = format!("image {} without `file_name`", image.id);
            return Err(Malformed::new(place(), problem, "name its file"));
        };
        if index_of.insert(image.id.clone(), index).is_some() {
            let problem = format!("the id {} is given twice", image.id);
            return Err(Malformed::new(
                place(),
                problem,
                "give each image its own id",
            ));
        }
        images.push(CocoImage {
            id: image.id,
            file_name,
            width: image.width as usize,
            height: image.height as usize,
            boxes: Vec::new(),
        });
    }
    for (index, mut annotation) in dataset.annotations.into_iter().enumerate() {
        let key = annotation.image_id.take().unwrap_or_default();
        let Some(&image) = index_of.get(&key) else {
            return Err(unlisted(index, &key.to_string()));
        };
        let label = annotation.labelled(index, &dataset.categories)?;
        images[image].boxes.push(label);
    }
    let categories = dataset
        .categories
        .into_iter()
        .enumerate()
        .map(|(index, c)| CocoCategory {
            id: c.number(index),
            name: c.name.unwrap_or_default(),
        });
    Ok(CocoDataset {
        images,
        categories: categories.collect(),
    })
}

fn format(dataset: &CocoDataset) -> String {
    let images = dataset.images.iter().map(|image| Image {
        id: image.id.clone(),
        file_name: Some(image.file_name.clone()),
        width: image.width as u32,
        height: image.height as u32,
    });
    let boxes = dataset.images.iter().flat_map(|image| {
        image
            .boxes
            .iter()
            .map(move |label| (image.id.clone(), label))
    });
    let annotations = boxes.zip(1..).map(|((image_id, label), id)| {
        let b = &label.bounds;
        Annotation {
            id: Some(ImageKey::Number(id)),
            image_id: Some(image_id),
            category_id: ImageKey::Number(label.class_number.unwrap_or_default()),
            bbox: Bounds(Some([b.x_min, b.y_min, b.width(), b.height()])),
            segmentation: Polygons::default(),
            score: Some(b.score),
            name: Some(b.name.clone()),
            area: b.width() * b.height(),
            iscrowd: u8::from(label.kind == LabelKind::Crowd),
            ignore: u8::from(label.kind == LabelKind::Difficult),
        }
    });
    let categories = dataset.categories.iter().map(|c| Category {
        id: ImageKey::Number(c.id),
        name: Some(c.name.clone()),
    });
    let dataset = Dataset {
        images: images.collect(),
        annotations: annotations.collect(),
        categories: categories.collect(),
    };
    // Neither maps with odd keys nor failing writers are in here.
    serde_json::to_string_pretty(&dataset).unwrap_or_default() + "\n"
}

fn parse_results(bytes: &[u8]) -> Result<Vec<CocoResult>, Malformed> {
    #[derive(Deserialize)]
    struct Entry {
        image_id: ImageKey,
        #[serde(default)]
        category_id: ImageKey,
        bbox: Bounds,
        score: f64,
    }
    let remedy = "give a COCO result list, each entry with image_id, bbox and score";
    let entries: Vec<Entry> =
        serde_json::from_str(text_of(bytes)?).map_err(|e| fault_of(&e, remedy))?;
    let results = entries.into_iter().enumerate().map(|(index, entry)| {
        let Bounds(Some([x, y, w, h])) = entry.bbox else {
            let place = format!("entry {index}");
            return Err(Malformed::new(place, "no `bbox`", remedy));
        };
        let (class_number, class_name) = match entry.category_id {
            ImageKey::Number(number) => (Some(number), None),
            ImageKey::Name(name) => (None, Some(name)),
        };
        Ok(CocoResult {
            image: entry.image_id,
            label: LabelledBox {
                class_number,
                class_name,
                ..LabelledBox::new(PixelBox {
                    name: index.to_string(),
                    x_min: x,
                    y_min: y,
                    x_max: x + w,
                    y_max: y + h,
                    score: entry.score,
                })
            },
        })
    });
    results.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn dataset() -> CocoDataset {
        let label = |name: &str, x: f64, kind| LabelledBox {
            class_number: Some(3),
            class_name: Some("apple".to_owned()),
            kind,
            ..LabelledBox::new(PixelBox {
                name: name.to_owned(),
                x_min: x,
                y_min: 1.25,
                x_max: x + 4.5,
                y_max: 7.0,
                score: 0.625,
            })
        };
        let image = |id, name: &str, boxes| CocoImage {
            id: ImageKey::Number(id),
            file_name: name.to_owned(),
            width: 20,
            height: 10,
            boxes,
        };
        CocoDataset {
            images: vec![
                image(7, "b.png", vec![label("1", 2.0, LabelKind::Object)]),
                image(3, "sub/a.jpg", Vec::new()),
                image(
                    9,
                    "c.png",
                    vec![
                        label("2", 3.0, LabelKind::Crowd),
                        label("3", 8.0, LabelKind::Difficult),
                    ],
                ),
            ],
            categories: vec![CocoCategory {
                id: 3,
                name: "apple".to_owned(),
            }],
        }
    }

    #[test]
    fn several_images_read_back_as_written() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("all.json");
        dataset().write(&path).unwrap();
        assert_eq!(CocoDataset::read(&path).unwrap(), dataset());
    }

    #[test]
    fn boxes_of_unknown_images_and_images_without_names_are_refused() {
        let fault = |text: &str| parse(text.as_bytes()).unwrap_err();
        let unknown = fault(
            r#"{"images":[{"id":1,"file_name":"a"}],"annotations":[{"image_id":1,"bbox":[1,1,1,1]},{"image_id":2,"bbox":[1,1,1,1]}]}"#,
        );
        assert_eq!(unknown.place, "`annotations`[1]");
        assert!(unknown.problem.contains("image_id 2"), "{unknown:?}");
        let nameless = fault(r#"{"images":[{"id":1}],"annotations":[]}"#);
        assert!(nameless.problem.contains("file_name"), "{nameless:?}");
        let twice = fault(
            r#"{"images":[{"id":1,"file_name":"a"},{"id":1,"file_name":"b"}],"annotations":[]}"#,
        );
        assert!(twice.problem.contains("twice"), "{twice:?}");
    }

    #[test]
    fn boxes_outside_their_image_are_refused_where_its_size_is_known() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("all.json");
        let mut wide = dataset();
        wide.images[0].boxes[0].bounds.x_min = 30.0;
        wide.images[0].boxes[0].bounds.x_max = 40.0;
        assert!(matches!(wide.write(&path), Err(CloudError::Box { .. })));
        wide.images[0].width = 0;
        wide.write(&path).unwrap();
        assert_eq!(CocoDataset::read(&path).unwrap(), wide);
    }

    #[test]
    fn results_name_images_by_number_or_text() {
        let text = br#"[{"image_id":4,"category_id":1,"bbox":[1,2,3,4],"score":0.5},
            {"image_id":"DSC_1","bbox":[1,2,3,4],"score":1}]"#;
        let results = parse_results(text).unwrap();
        assert_eq!(results[0].image, ImageKey::Number(4));
        assert_eq!(results[1].image, ImageKey::Name("DSC_1".to_owned()));
        assert_eq!(results[0].label.bounds.y_max, 6.0);
        let scoreless = parse_results(br#"[{"image_id":4,"bbox":[1,2,3,4]}]"#).unwrap_err();
        assert!(scoreless.problem.contains("score"), "{scoreless:?}");
    }

    #[test]
    fn files_that_are_cut_or_changed_are_boxes_or_an_error() {
        let whole = format(&dataset());
        let list = r#"[{"image_id":4,"category_id":1,"bbox":[1,2,3,4],"score":0.5}]"#;
        for text in [&whole, list] {
            for at in 0..text.len() {
                let _ = parse(&text.as_bytes()[..at]);
                let _ = parse_results(&text.as_bytes()[..at]);
                for change in [1, 3, 0x10, 0x80] {
                    let mut bytes = text.as_bytes().to_vec();
                    bytes[at] ^= change;
                    let _ = parse(&bytes);
                    let _ = parse_results(&bytes);
                }
            }
        }
    }
}
