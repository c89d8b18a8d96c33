mod checks;
mod chosen;
mod class_choice;
mod class_names;
mod coco;
mod coco_dataset;
mod coco_values;
mod cvat;
mod detections;
mod image;
mod label_studio;
mod labelled;
mod labelme;
mod parsed;
mod pixel_box;
mod voc;
mod yolo;
mod yolo_doubts;

pub(crate) use checks::validate_all;
pub use chosen::BoxChoice;
pub use class_choice::ClassChoice;
pub use coco_dataset::{CocoCategory, CocoDataset, CocoImage, CocoResult, read_coco_results};
pub use coco_values::ImageKey;
pub use image::BoxImage;
pub use labelled::{LabelKind, LabelledBox};
pub use pixel_box::{BoxError, PixelBox};

use crate::CloudError;
use checks::{text_of, touch_all};
use parsed::Parsed;
use pomona_files::{Malformed, Warning, WithWarnings, write_atomically};
use serde_json::Value;
use std::path::Path;

/// A form in which boxes are kept in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum BoxFormat {
    /// Pascal VOC XML. Coordinates are taken and written as they stand, as edges in pixels
    /// counted from 0: the original development kit counts from 1 and includes the last
    /// pixel, but the labelling tools in use do not.
    Voc,
    /// COCO JSON: an object with `images` and `annotations`, or a bare list of detections.
    Coco,
    /// YOLO text: `class cx cy w h [score]` on each line, as fractions of the image.
    Yolo,
}

/// Reads the boxes of an image that `choice` asks for; the format is recognised by the content.
///
/// Besides the [`BoxFormat`]s it may be the XML of CVAT, the JSON of `LabelMe` or Label Studio, or the record of `pomona
/// detect`. A file with the boxes of several images gives those of this image, by its name. Boxes of other classes are
/// left out, and a warning counts them. A box that reaches beyond the image is kept as it is; [`PixelBox::window`] cuts
/// it off.
///
/// # Errors
///
/// [`CloudError::File`], also where no class or no image of the file is the one that is asked for, and
/// [`CloudError::Box`] for a box that is inverted, not finite, or outside the image.
pub fn read_boxes(
    path: impl AsRef<Path>,
    image: &BoxImage,
    choice: &BoxChoice,
) -> Result<WithWarnings<Vec<PixelBox>>, CloudError> {
    let path = path.as_ref();
    let Reading {
        labels,
        classes,
        mut warnings,
    } = read(path, image)?;
    let boxes = choice
        .of(&file_name(path), labels, &classes)
        .map_err(|fault| fault.at(path))?
        .append_to(&mut warnings);
    validate_all(path, &boxes, image.width, image.height)?;
    Ok(WithWarnings::new(boxes, warnings))
}

/// Reads all boxes of an image with their classes.
///
/// Boxes that hold no pixel are read too, if they touch the image: a label may be a sliver at its edge.
///
/// # Errors
///
/// As [`read_boxes`], but for such boxes and for the choice of a class.
pub fn read_labels(
    path: impl AsRef<Path>,
    image: &BoxImage,
) -> Result<WithWarnings<Vec<LabelledBox>>, CloudError> {
    let path = path.as_ref();
    let reading = read(path, image)?;
    touch_all(path, &reading.labels, image.width, image.height)?;
    Ok(WithWarnings::new(reading.labels, reading.warnings))
}

/// What a file says of one image.
struct Reading {
    labels: Vec<LabelledBox>,
    /// The classes that the file declares.
    classes: Vec<String>,
    warnings: Vec<Warning>,
}

fn read(path: &Path, image: &BoxImage) -> Result<Reading, CloudError> {
    let bytes = pomona_files::read(path)?;
    let file = file_name(path);
    let mut parsed = parse(&bytes, &file, image).map_err(|fault| fault.at(path))?;
    class_names::add(&mut parsed, path)?;
    let classes = std::mem::take(&mut parsed.classes);
    let chosen = image.choose(path, parsed);
    let (image, warnings) = chosen.map_err(|fault| fault.at(path))?;
    Ok(Reading {
        labels: image.labels,
        classes,
        warnings,
    })
}

/// A file's name for a warning.
fn file_name(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default();
    name.to_string_lossy().into_owned()
}

/// Writes the boxes of a `width` × `height` image.
///
/// YOLO has no names: there a box reads back with its number as its name.
///
/// # Errors
///
/// [`CloudError::Box`] for a box that could not be read back, [`CloudError::File`].
pub fn write_boxes(
    path: impl AsRef<Path>,
    boxes: &[PixelBox],
    width: usize,
    height: usize,
    format: BoxFormat,
) -> Result<(), CloudError> {
    let path = path.as_ref();
    validate_all(path, boxes, width, height)?;
    let text = match format {
        BoxFormat::Voc => voc::format(boxes, width, height),
        BoxFormat::Coco => coco::format(boxes, width, height),
        BoxFormat::Yolo => yolo::format(boxes, width, height),
    };
    write_atomically(path, text.as_bytes())?;
    Ok(())
}

fn parse(bytes: &[u8], file: &str, image: &BoxImage) -> Result<Parsed, Malformed> {
    let text = text_of(bytes)?;
    match text.trim_start().chars().next() {
        Some('<') => voc::parse(text),
        Some('{') => parse_object(text),
        Some('[') => parse_list(text, image),
        _ => yolo::parse(text, file, image.width, image.height),
    }
}

/// Which keys tell a JSON object's format; their values are read by whom it is.
#[derive(serde::Deserialize)]
struct Keys {
    #[serde(default)]
    schema: Option<Value>,
    #[serde(default)]
    shapes: Option<serde::de::IgnoredAny>,
}

fn parse_object(text: &str) -> Result<Parsed, Malformed> {
    let keys: Keys = serde_json::from_str(text).map_err(coco::fault)?;
    let schema = keys.schema.as_ref().and_then(Value::as_str);
    if schema.is_some_and(|schema| schema.starts_with(detections::SCHEMA)) {
        detections::parse(text)
    } else if keys.shapes.is_some() {
        labelme::parse(text)
    } else {
        coco::parse(text)
    }
}

fn parse_list(text: &str, image: &BoxImage) -> Result<Parsed, Malformed> {
    let first = serde_json::Deserializer::from_str(text.trim_start().trim_start_matches('['))
        .into_iter::<Value>()
        .next();
    match first {
        Some(Ok(first)) if label_studio::is(&first) => {
            label_studio::parse(text, image.width, image.height)
        }
        _ => coco::parse(text),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn boxed(name: &str, x_min: f64, y_min: f64, x_max: f64, y_max: f64) -> PixelBox {
        PixelBox {
            name: name.to_owned(),
            x_min,
            y_min,
            x_max,
            y_max,
            score: 1.0,
        }
    }

    fn read(path: &Path) -> Result<Vec<PixelBox>, CloudError> {
        read_boxes(path, &BoxImage::new(64, 32), &BoxChoice::default()).map(|boxes| boxes.value)
    }

    /// The boxes in a text, of a `width` × `height` image.
    fn labels(bytes: &[u8], width: usize, height: usize) -> Result<Vec<LabelledBox>, Malformed> {
        let image = BoxImage::new(width, height);
        let parsed = parse(bytes, "boxes", &image)?;
        image
            .choose(Path::new("boxes"), parsed)
            .map(|(image, _)| image.labels)
    }

    #[test]
    fn each_format_reads_back_what_it_wrote() {
        let dir = tempfile::tempdir().unwrap();
        let boxes = [
            PixelBox {
                score: 0.625,
                ..boxed("<a> & \"b\"", 1.5, 2.0, 30.25, 17.0)
            },
            boxed("1", -2.0, 0.0, 64.0, 32.0),
        ];
        for format in [BoxFormat::Voc, BoxFormat::Coco, BoxFormat::Yolo] {
            let path = dir.path().join("boxes");
            write_boxes(&path, &boxes, 64, 32, format).unwrap();
            let back = read(&path).unwrap();
            assert_eq!(back.len(), 2);
            for (i, (read, written)) in back.iter().zip(&boxes).enumerate() {
                let name = if format == BoxFormat::Yolo {
                    i.to_string()
                } else {
                    written.name.clone()
                };
                assert_eq!(
                    read,
                    &PixelBox {
                        name,
                        ..written.clone()
                    },
                    "{format:?}"
                );
            }
        }
    }

    #[test]
    fn a_bad_box_names_file_and_box() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("boxes.txt");
        std::fs::write(&path, "0 0.5 0.5 0.1 0.1\n0 1.9 0.5 0.1 0.1\n").unwrap();
        let message = read(&path).unwrap_err().to_string();
        assert!(
            message.contains("boxes.txt") && message.contains("`1`"),
            "{message}"
        );
        let error = write_boxes(
            &path,
            &[boxed("x", 9.0, 0.0, 1.0, 1.0)],
            64,
            32,
            BoxFormat::Voc,
        );
        assert!(matches!(error, Err(CloudError::Box { .. })));
        let missing = read(&dir.path().join("none.xml")).unwrap_err().to_string();
        assert!(missing.contains("none.xml"), "{missing}");
    }

    #[test]
    fn boxes_of_another_image_size_are_refused() {
        let xml = "<annotation><size><width>640</width><height>480</height></size></annotation>";
        let fault = labels(xml.as_bytes(), 64, 32).unwrap_err();
        assert!(fault.problem.contains("640x480") && fault.problem.contains("64x32"));
        assert_eq!(labels(xml.as_bytes(), 640, 480).unwrap(), []);
        let json = br#"{"images":[{"id":1,"width":640,"height":480}],"annotations":[]}"#;
        assert!(labels(json, 64, 32).is_err());
    }

    #[test]
    fn box_files_that_are_cut_or_changed_are_boxes_or_an_error() {
        let boxes = [
            boxed("a", 1.5, 2.0, 30.25, 17.0),
            boxed("b", 0.0, 0.0, 64.0, 32.0),
        ];
        for whole in [
            voc::format(&boxes, 64, 32),
            coco::format(&boxes, 64, 32),
            yolo::format(&boxes, 64, 32),
        ] {
            for at in 0..whole.len() {
                let _ = labels(&whole.as_bytes()[..at], 64, 32);
                for change in [1, 3, 0x10, 0x80] {
                    let mut bytes = whole.clone().into_bytes();
                    bytes[at] ^= change;
                    for label in labels(&bytes, 64, 32).unwrap_or_default() {
                        let _ = label.bounds.window(64, 32);
                    }
                }
            }
        }
    }
}
