//! COCO JSON, <https://cocodataset.org/#format-data>: a ground-truth object with `images`
//! and `annotations`, or the bare list of detections that its result files are.

use super::checks::check_size;
use super::labelled::{LabelKind, LabelledBox};
use super::pixel_box::PixelBox;
use pomona_files::Malformed;
use serde::{Deserialize, Deserializer, Serialize};

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
    pub(super) id: u64,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) file_name: Option<String>,
    #[serde(default)]
    pub(super) width: u32,
    #[serde(default)]
    pub(super) height: u32,
}

#[derive(Serialize, Deserialize)]
pub(super) struct Annotation {
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) id: Option<u64>,
    #[serde(default)]
    pub(super) image_id: u64,
    #[serde(default)]
    pub(super) category_id: u64,
    pub(super) bbox: [f64; 4],
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) score: Option<f64>,
    /// Not in the standard, whose names are those of classes: the name of this one apple.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) name: Option<String>,
    #[serde(default)]
    pub(super) area: f64,
    #[serde(default, deserialize_with = "flag")]
    pub(super) iscrowd: u8,
    #[serde(default, deserialize_with = "flag", skip_serializing_if = "is_zero")]
    pub(super) ignore: u8,
}

#[derive(Serialize, Deserialize)]
pub(super) struct Category {
    pub(super) id: u64,
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

/// 0 or 1, which some tools write as `false` or `true`.
fn flag<'de, D: Deserializer<'de>>(deserializer: D) -> Result<u8, D::Error> {
    #[derive(Deserialize)]
    #[serde(untagged)]
    enum Flag {
        Word(bool),
        Number(u8),
    }
    Ok(match Flag::deserialize(deserializer)? {
        Flag::Word(word) => u8::from(word),
        Flag::Number(number) => number,
    })
}

impl Annotation {
    /// The box that stands at `index`, its class named by one of `categories`.
    pub(super) fn labelled(self, index: usize, categories: &[Category]) -> LabelledBox {
        let [x, y, w, h] = self.bbox;
        let name = self.name.unwrap_or_else(|| {
            let number = self.id.map_or(index as u64, |id| id);
            number.to_string()
        });
        let category = categories.iter().find(|c| c.id == self.category_id);
        LabelledBox {
            bounds: PixelBox {
                name,
                x_min: x,
                y_min: y,
                x_max: x + w,
                y_max: y + h,
                score: self.score.unwrap_or(1.0),
            },
            class_number: Some(self.category_id),
            class_name: category.and_then(|c| c.name.clone()),
            kind: match (self.iscrowd, self.ignore) {
                (0, 0) => LabelKind::Object,
                (0, _) => LabelKind::Difficult,
                _ => LabelKind::Crowd,
            },
        }
    }
}

pub(super) fn parse(
    text: &str,
    width: usize,
    height: usize,
) -> Result<Vec<LabelledBox>, Malformed> {
    let (annotations, categories) = if text.trim_start().starts_with('[') {
        let annotations: Vec<Annotation> = serde_json::from_str(text).map_err(fault)?;
        (annotations, Vec::new())
    } else {
        let dataset: Dataset = serde_json::from_str(text).map_err(fault)?;
        for image in &dataset.images {
            let stated = (f64::from(image.width), f64::from(image.height));
            check_size("`images`", stated, width, height)?;
        }
        (dataset.annotations, dataset.categories)
    };
    if let Some(other) = annotations
        .iter()
        .find(|a| a.image_id != annotations[0].image_id)
    {
        let problem = format!(
            "annotations of several images (image_id {} and {})",
            annotations[0].image_id, other.image_id
        );
        return Err(Malformed::new(
            "`annotations`",
            problem,
            "keep those of this frame's image only",
        ));
    }
    Ok(annotations
        .into_iter()
        .enumerate()
        .map(|(index, annotation)| annotation.labelled(index, &categories))
        .collect())
}

/// What serde found wrong, with its place.
#[expect(clippy::needless_pass_by_value, reason = "`map_err` hands errors over")]
pub(super) fn fault(e: serde_json::Error) -> Malformed {
    Malformed::new(
        format!("line {} column {}", e.line(), e.column()),
        e.to_string(),
        REMEDY,
    )
}

pub(super) fn format(boxes: &[PixelBox], width: usize, height: usize) -> String {
    let annotations = boxes.iter().zip(1..).map(|(b, id)| Annotation {
        id: Some(id),
        image_id: 1,
        category_id: 1,
        bbox: [b.x_min, b.y_min, b.width(), b.height()],
        score: Some(b.score),
        name: Some(b.name.clone()),
        area: b.width() * b.height(),
        iscrowd: 0,
        ignore: 0,
    });
    let dataset = Dataset {
        images: vec![Image {
            id: 1,
            file_name: None,
            width: width as u32,
            height: height as u32,
        }],
        annotations: annotations.collect(),
        categories: vec![Category {
            id: 1,
            name: Some("apple".to_owned()),
        }],
    };
    // Neither maps with odd keys nor failing writers are in here.
    serde_json::to_string_pretty(&dataset).unwrap_or_default() + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_datasets_and_detections() {
        let dataset = r#"{"info":{"year":2024},"images":[{"id":7,"width":9,"height":8,"file_name":"a.png"}],
            "annotations":[{"id":41,"image_id":7,"category_id":53,"bbox":[1,2,3,4],"segmentation":[]}],
            "categories":[{"id":53,"name":"apple"}]}"#;
        let label = parse(dataset, 9, 8).unwrap().remove(0);
        let class = (label.class_number, label.class_name.as_deref());
        assert_eq!(class, (Some(53), Some("apple")));
        let first = label.bounds;
        assert_eq!(first.name, "41");
        assert_eq!((first.x_max, first.y_max, first.score), (4.0, 6.0, 1.0));
        let detections = r#"[{"image_id":7,"category_id":53,"bbox":[1.5,2,3,4],"score":0.5}]"#;
        let first = parse(detections, 9, 8).unwrap().remove(0).bounds;
        assert_eq!(
            (first.name.as_str(), first.x_min, first.score),
            ("0", 1.5, 0.5)
        );
        assert_eq!(parse("[]", 9, 8).unwrap(), []);
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
            assert_eq!(parse(&text, 9, 8).unwrap()[0].kind, kind, "{flags}");
        }
    }

    #[test]
    fn the_wrong_schema_is_refused_with_its_place() {
        let fault = parse("{\n\"picks\": []}", 9, 8).unwrap_err();
        assert!(fault.problem.contains("annotations") && fault.place.starts_with("line 2"));
        assert!(parse(r#"[{"bbox":[1,2,3]}]"#, 9, 8).is_err());
        let two = r#"[{"image_id":1,"bbox":[1,2,3,4]},{"image_id":2,"bbox":[1,2,3,4]}]"#;
        assert!(
            parse(two, 9, 8)
                .unwrap_err()
                .problem
                .contains("several images")
        );
    }
}
