//! COCO JSON, <https://cocodataset.org/#format-data>: a ground-truth object with `images`
//! and `annotations`, or the bare list of detections that its result files are.

use super::{PixelBox, check_size};
use crate::error::Fault;
use serde::{Deserialize, Serialize};

const REMEDY: &str =
    "give COCO JSON with `annotations`, each with `bbox`: [x, y, width, height] in pixels";

#[derive(Serialize, Deserialize)]
struct Dataset {
    #[serde(default)]
    images: Vec<Image>,
    annotations: Vec<Annotation>,
    #[serde(default, skip_deserializing)]
    categories: Vec<Category>,
}

#[derive(Serialize, Deserialize)]
struct Image {
    id: u64,
    #[serde(default)]
    width: u32,
    #[serde(default)]
    height: u32,
}

#[derive(Serialize, Deserialize)]
struct Annotation {
    #[serde(default, skip_serializing_if = "Option::is_none")]
    id: Option<u64>,
    #[serde(default)]
    image_id: u64,
    #[serde(default)]
    category_id: u64,
    bbox: [f64; 4],
    #[serde(default, skip_serializing_if = "Option::is_none")]
    score: Option<f64>,
    /// Not in the standard, whose names are those of classes: the name of this one apple.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    name: Option<String>,
    #[serde(default)]
    area: f64,
    #[serde(default)]
    iscrowd: u8,
}

#[derive(Serialize)]
struct Category {
    id: u64,
    name: &'static str,
}

pub(super) fn parse(text: &str, width: usize, height: usize) -> Result<Vec<PixelBox>, Fault> {
    let fault = |e: serde_json::Error| {
        Fault::new(
            format!("line {} column {}", e.line(), e.column()),
            e.to_string(),
            REMEDY,
        )
    };
    let annotations = if text.trim_start().starts_with('[') {
        serde_json::from_str::<Vec<Annotation>>(text).map_err(fault)?
    } else {
        let dataset: Dataset = serde_json::from_str(text).map_err(fault)?;
        for image in &dataset.images {
            let stated = (f64::from(image.width), f64::from(image.height));
            check_size("`images`", stated, width, height)?;
        }
        dataset.annotations
    };
    if let Some(other) = annotations
        .iter()
        .find(|a| a.image_id != annotations[0].image_id)
    {
        let problem = format!(
            "annotations of several images (image_id {} and {})",
            annotations[0].image_id, other.image_id
        );
        return Err(Fault::new(
            "`annotations`",
            problem,
            "keep those of this frame's image only",
        ));
    }
    Ok(annotations
        .into_iter()
        .enumerate()
        .map(|(index, a)| {
            let [x, y, w, h] = a.bbox;
            PixelBox {
                name: a
                    .name
                    .unwrap_or_else(|| a.id.map_or_else(|| index.to_string(), |id| id.to_string())),
                x_min: x,
                y_min: y,
                x_max: x + w,
                y_max: y + h,
                score: a.score.unwrap_or(1.0),
            }
        })
        .collect())
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
    });
    let dataset = Dataset {
        images: vec![Image {
            id: 1,
            width: width as u32,
            height: height as u32,
        }],
        annotations: annotations.collect(),
        categories: vec![Category {
            id: 1,
            name: "apple",
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
        let boxes = parse(dataset, 9, 8).unwrap();
        assert_eq!(boxes[0].name, "41");
        assert_eq!(
            (boxes[0].x_max, boxes[0].y_max, boxes[0].score),
            (4.0, 6.0, 1.0)
        );
        let detections = r#"[{"image_id":7,"category_id":53,"bbox":[1.5,2,3,4],"score":0.5}]"#;
        let boxes = parse(detections, 9, 8).unwrap();
        assert_eq!(
            (boxes[0].name.as_str(), boxes[0].x_min, boxes[0].score),
            ("0", 1.5, 0.5)
        );
        assert_eq!(parse("[]", 9, 8).unwrap(), []);
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
