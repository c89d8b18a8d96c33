//! `detections.json`, the record that `pomona detect` writes.

use super::coco::fault_of;
use super::labelled::LabelledBox;
use super::parsed::{ImageBoxes, Parsed};
use super::pixel_box::PixelBox;
use pomona_files::Malformed;
use serde::Deserialize;

/// How the `schema` of such a record begins.
pub(super) const SCHEMA: &str = "pomona.detections/";

const REMEDY: &str = "write it again with `pomona detect`";

/// A record holds what the detector was asked for, and nothing else.
const CLASS: &str = "apple";

#[derive(Deserialize)]
struct Record {
    images: Vec<Image>,
}

#[derive(Deserialize)]
struct Image {
    file: String,
    width: f64,
    height: f64,
    detections: Vec<Detection>,
}

#[derive(Deserialize)]
struct Detection {
    x_min: f64,
    y_min: f64,
    x_max: f64,
    y_max: f64,
    score: f64,
}

pub(super) fn parse(text: &str) -> Result<Parsed, Malformed> {
    let record: Record = serde_json::from_str(text).map_err(|e| fault_of(&e, REMEDY))?;
    let images = record.images.into_iter().map(|image| {
        let boxes = image
            .detections
            .iter()
            .enumerate()
            .map(|(index, d)| LabelledBox {
                class_name: Some(CLASS.to_owned()),
                ..LabelledBox::new(PixelBox {
                    name: index.to_string(),
                    x_min: d.x_min,
                    y_min: d.y_min,
                    x_max: d.x_max,
                    y_max: d.y_max,
                    score: d.score,
                })
            });
        ImageBoxes {
            labels: boxes.collect(),
            size: Some(("`images`".to_owned(), [image.width, image.height])),
            name: Some(image.file),
        }
    });
    Ok(Parsed {
        images: images.collect(),
        classes: vec![CLASS.to_owned()],
        ..Parsed::default()
    })
}
