//! COCO JSON, <https://cocodataset.org/#format-data>: a ground-truth object with `images`
//! and `annotations`, or the bare list of detections that its result files are.

use super::coco_values::{Bounds, ImageKey, Polygons, flag, whole};
use super::labelled::{LabelKind, LabelledBox};
use super::parsed::{ImageBoxes, Parsed};
use super::pixel_box::PixelBox;
use pomona_files::Malformed;
use serde::{Deserialize, Serialize};

const REMEDY: &str =
    "give COCO JSON with `annotations`, each with `bbox`: [x, y, width, height] in pixels";

#[derive(Serialize, Deserialize)]
pub(super) struct Dataset {
    #[serde(default)]
    pub(super) images: Vec<Image>,
    pub(super) annotations: Vec<Annotation>,
    #[serde(default)]
    pub(super) categories: Vec<Category>,
}

#[derive(Serialize, Deserialize)]
pub(super) struct Image {
    pub(super) id: ImageKey,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) file_name: Option<String>,
    #[serde(default, deserialize_with = "whole")]
    pub(super) width: u32,
    #[serde(default, deserialize_with = "whole")]
    pub(super) height: u32,
}

#[derive(Serialize, Deserialize)]
pub(super) struct Annotation {
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) id: Option<ImageKey>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) image_id: Option<ImageKey>,
    #[serde(default)]
    pub(super) category_id: ImageKey,
    #[serde(default)]
    pub(super) bbox: Bounds,
    #[serde(default, skip_serializing)]
    pub(super) segmentation: Polygons,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) score: Option<f64>,
    /// Not in the standard, whose names are those of classes: the name of this one apple.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) name: Option<String>,
    #[serde(skip_deserializing)]
    pub(super) area: f64,
    #[serde(default, deserialize_with = "flag")]
    pub(super) iscrowd: u8,
    #[serde(default, deserialize_with = "flag", skip_serializing_if = "is_zero")]
    pub(super) ignore: u8,
}

#[derive(Serialize, Deserialize)]
pub(super) struct Category {
    pub(super) id: ImageKey,
    #[serde(default)]
    pub(super) name: Option<String>,
}

#[expect(
    clippy::trivially_copy_pass_by_ref,
    reason = "serde hands a reference over"
)]
fn is_zero(number: &u8) -> bool {
    *number == 0
}

/// The number and the name of a class; one whose id is a text counts as its place among `categories`.
fn class(id: &ImageKey, categories: &[Category]) -> (Option<u64>, Option<String>) {
    let place = categories.iter().position(|category| category.id == *id);
    let name = place.and_then(|place| categories[place].name.clone());
    match id {
        ImageKey::Number(number) => (Some(*number), name),
        ImageKey::Name(text) => (
            place.map(|place| place as u64),
            name.or_else(|| Some(text.clone())),
        ),
    }
}

impl Category {
    /// Its number, for a category that stands at `index`.
    pub(super) fn number(&self, index: usize) -> u64 {
        match self.id {
            ImageKey::Number(number) => number,
            ImageKey::Name(_) => index as u64,
        }
    }
}

impl Annotation {
    /// The box that stands at `index`, its class named by one of `categories`.
    pub(super) fn labelled(
        self,
        index: usize,
        categories: &[Category],
    ) -> Result<LabelledBox, Malformed> {
        let bounds = self.bbox.0.or(self
            .segmentation
            .0
            .map(|[x0, y0, x1, y1]| [x0, y0, x1 - x0, y1 - y0]));
        let Some([x, y, w, h]) = bounds else {
            let place = format!("`annotations`[{index}]");
            return Err(Malformed::new(
                place,
                "no `bbox`, nor polygons that bound it",
                REMEDY,
            ));
        };
        let name = self.name.unwrap_or_else(|| {
            self.id
                .map_or_else(|| index.to_string(), |id| id.to_string())
        });
        let (class_number, class_name) = class(&self.category_id, categories);
        Ok(LabelledBox {
            bounds: PixelBox {
                name,
                x_min: x,
                y_min: y,
                x_max: x + w,
                y_max: y + h,
                score: self.score.unwrap_or(1.0),
            },
            class_number,
            class_name,
            kind: match (self.iscrowd, self.ignore) {
                (0, 0) => LabelKind::Object,
                (0, _) => LabelKind::Difficult,
                _ => LabelKind::Crowd,
            },
        })
    }
}

pub(super) fn parse(text: &str) -> Result<Parsed, Malformed> {
    let dataset = if text.trim_start().starts_with('[') {
        Dataset {
            images: Vec::new(),
            annotations: serde_json::from_str(text).map_err(fault)?,
            categories: Vec::new(),
        }
    } else {
        serde_json::from_str(text).map_err(fault)?
    };
    let Dataset {
        images: listed,
        annotations,
        categories,
    } = dataset;
    let is_listed = !listed.is_empty();
    let mut keys: Vec<Option<ImageKey>> = Vec::new();
    let mut images: Vec<ImageBoxes> = Vec::new();
    for (index, image) in listed.into_iter().enumerate() {
        let size = [image.width, image.height].map(f64::from);
        keys.push(Some(image.id));
        images.push(ImageBoxes {
            name: image.file_name,
            size: Some((format!("`images`[{index}]"), size)),
            labels: Vec::new(),
        });
    }
    let mut index_of: std::collections::HashMap<Option<ImageKey>, usize> = keys
        .into_iter()
        .enumerate()
        .map(|(index, key)| (key, index))
        .collect();
    let only = (images.len() == 1).then_some(0);
    for (index, mut annotation) in annotations.into_iter().enumerate() {
        let key = annotation.image_id.take();
        let known = index_of
            .get(&key)
            .copied()
            .or(only.filter(|_| key.is_none()));
        let image = match known {
            Some(image) => image,
            None if is_listed => {
                let key = key.map_or_else(|| "none".to_owned(), |key| key.to_string());
                return Err(unlisted(index, &key));
            }
            None => {
                let name = match &key {
                    Some(ImageKey::Name(name)) => Some(name.clone()),
                    _ => None,
                };
                index_of.insert(key, images.len());
                images.push(ImageBoxes {
                    name,
                    ..ImageBoxes::default()
                });
                images.len() - 1
            }
        };
        images[image]
            .labels
            .push(annotation.labelled(index, &categories)?);
    }
    Ok(Parsed {
        images,
        classes: categories
            .into_iter()
            .filter_map(|category| category.name)
            .collect(),
        ..Parsed::default()
    })
}

/// The fault of an annotation whose image is not there.
pub(super) fn unlisted(index: usize, key: &str) -> Malformed {
    Malformed::new(
        format!("`annotations`[{index}]"),
        format!("image_id {key} is of no image in `images`"),
        "list its image, or remove the annotation",
    )
}

/// What serde found wrong, with its place.
#[expect(clippy::needless_pass_by_value, reason = "`map_err` hands errors over")]
pub(super) fn fault(e: serde_json::Error) -> Malformed {
    fault_of(&e, REMEDY)
}

/// The same with another remedy.
pub(super) fn fault_of(e: &serde_json::Error, remedy: &str) -> Malformed {
    let place = format!("line {} column {}", e.line(), e.column());
    let text = e.to_string();
    let problem = text.strip_suffix(&format!(" at {place}")).unwrap_or(&text);
    Malformed::new(place, problem, remedy)
}

pub(super) fn format(boxes: &[PixelBox], width: usize, height: usize) -> String {
    let annotations = boxes.iter().zip(1..).map(|(b, id)| Annotation {
        id: Some(ImageKey::Number(id)),
        image_id: Some(ImageKey::Number(1)),
        category_id: ImageKey::Number(1),
        bbox: Bounds(Some([b.x_min, b.y_min, b.width(), b.height()])),
        segmentation: Polygons::default(),
        score: Some(b.score),
        name: Some(b.name.clone()),
        area: b.width() * b.height(),
        iscrowd: 0,
        ignore: 0,
    });
    let dataset = Dataset {
        images: vec![Image {
            id: ImageKey::Number(1),
            file_name: None,
            width: width as u32,
            height: height as u32,
        }],
        annotations: annotations.collect(),
        categories: vec![Category {
            id: ImageKey::Number(1),
            name: Some("apple".to_owned()),
        }],
    };
    // Neither maps with odd keys nor failing writers are in here.
    serde_json::to_string_pretty(&dataset).unwrap_or_default() + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(text: &str) -> Vec<LabelledBox> {
        let images = parse(text).unwrap().images;
        images.into_iter().flat_map(|image| image.labels).collect()
    }

    #[test]
    fn reads_datasets_and_detections() {
        let dataset = r#"{"info":{"year":2024},"images":[{"id":7,"width":9,"height":8,"file_name":"a.png"}],
            "annotations":[{"id":41,"image_id":7,"category_id":53,"bbox":[1,2,3,4],"segmentation":[]}],
            "categories":[{"id":53,"name":"apple"}]}"#;
        let label = labels(dataset).remove(0);
        let class = (label.class_number, label.class_name.as_deref());
        assert_eq!(class, (Some(53), Some("apple")));
        let first = label.bounds;
        assert_eq!(first.name, "41");
        assert_eq!((first.x_max, first.y_max, first.score), (4.0, 6.0, 1.0));
        let detections = r#"[{"image_id":7,"category_id":53,"bbox":[1.5,2,3,4],"score":0.5}]"#;
        let first = labels(detections).remove(0).bounds;
        assert_eq!(
            (first.name.as_str(), first.x_min, first.score),
            ("0", 1.5, 0.5)
        );
        assert_eq!(labels("[]"), []);
    }

    #[test]
    fn crowds_and_ignored_ones_are_marked() {
        for (flags, kind) in [
            (r#""iscrowd":0"#, LabelKind::Object),
            (r#""iscrowd":1"#, LabelKind::Crowd),
            (r#""ignore":true"#, LabelKind::Difficult),
            (r#""ignore":false,"iscrowd":true"#, LabelKind::Crowd),
        ] {
            let text = format!(r#"{{"annotations":[{{"bbox":[1,2,3,4],{flags}}}]}}"#);
            assert_eq!(labels(&text)[0].kind, kind, "{flags}");
        }
    }

    #[test]
    fn the_wrong_schema_is_refused_with_its_place() {
        let fault = parse("{\n\"picks\": []}").unwrap_err();
        assert!(fault.problem.contains("annotations") && fault.place.starts_with("line 2"));
        assert!(!fault.problem.contains("line"), "{fault:?}");
        let three = parse(r#"[{"bbox":[1,2,3]}]"#).unwrap_err();
        assert!(
            three.problem.contains("four numbers: x, y, width, height"),
            "{three:?}"
        );
        let nothing = parse(r#"[{"segmentation":[]}]"#).unwrap_err();
        assert!(nothing.problem.contains("no `bbox`"), "{nothing:?}");
        let text = r#"{"images":[{"id":1}],"annotations":[{"image_id":2,"bbox":[1,2,3,4]}]}"#;
        assert!(parse(text).unwrap_err().problem.contains("image_id 2"));
    }

    #[test]
    fn boxes_go_to_their_images_and_classes_whatever_their_ids_are() {
        for (image, category) in [
            ("7", "1"),
            ("\"a\"", "\"x\""),
            ("7.0", "1.0"),
            ("\"7\"", "-3"),
        ] {
            let text = format!(
                r#"{{"images":[{{"id":{image},"file_name":"a.png","width":9.0}},{{"id":8,"file_name":"b.png"}}],
                "annotations":[{{"id":"k","image_id":{image},"category_id":{category},"bbox":[1,2,3,4]}}],
                "categories":[{{"id":5,"name":"leaf"}},{{"id":{category},"name":"apple"}}]}}"#
            );
            let parsed = parse(&text).unwrap();
            assert_eq!(parsed.classes, ["leaf", "apple"]);
            assert_eq!(parsed.images[1].labels, []);
            let label = &parsed.images[0].labels[0];
            assert_eq!(
                (label.class_name.as_deref(), &*label.bounds.name),
                (Some("apple"), "k"),
                "{text}"
            );
        }
        let mixed = r#"{"images":[{"id":1,"file_name":"a"}],"annotations":[{"image_id":"1","category_id":1.0,
            "bbox":[1,2,3,4]}],"categories":[{"id":1,"name":"apple"}]}"#;
        assert_eq!(labels(mixed)[0].class_name.as_deref(), Some("apple"));
        let fault = parse(r#"[{"image_id":1.5,"bbox":[1,2,3,4]}]"#).unwrap_err();
        assert!(
            fault.problem.contains("an id: a number or a text"),
            "{fault:?}"
        );
    }

    #[test]
    fn polygons_bound_a_box_where_none_is_given() {
        let text = r#"[{"bbox":[],"segmentation":[[3,4,5,1,4,9],[1,2,2,2,2,3]]},
            {"bbox":[1,2,3,4],"segmentation":{"size":[9,9],"counts":"abc"}}]"#;
        let found = labels(text);
        let edges = |k: usize| {
            let b = &found[k].bounds;
            [b.x_min, b.y_min, b.x_max, b.y_max]
        };
        assert_eq!(
            (edges(0), edges(1)),
            ([1.0, 1.0, 5.0, 9.0], [1.0, 2.0, 4.0, 6.0])
        );
    }
}
