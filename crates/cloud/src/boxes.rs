mod checks;
mod coco;
mod coco_dataset;
mod labelled;
mod pixel_box;
mod voc;
mod yolo;

pub(crate) use checks::validate_all;
pub use coco_dataset::{
    CocoCategory, CocoDataset, CocoImage, CocoResult, ImageKey, read_coco_results,
};
pub use labelled::{LabelKind, LabelledBox};
pub use pixel_box::{BoxError, PixelBox};

use crate::CloudError;
use checks::{text_of, touch_all};
use pomona_files::{Malformed, write_atomically};
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

/// Reads the boxes of a `width` × `height` image; the format is recognised by the content.
///
/// A box that reaches beyond the image is kept as it is; [`PixelBox::window`] cuts it off.
///
/// # Errors
///
/// [`CloudError::File`], and [`CloudError::Box`] for a box that
/// is inverted, not finite, or outside the image.
pub fn read_boxes(
    path: impl AsRef<Path>,
    width: usize,
    height: usize,
) -> Result<Vec<PixelBox>, CloudError> {
    let path = path.as_ref();
    let labels = read_labels(path, width, height)?;
    let boxes: Vec<PixelBox> = labels.into_iter().map(|label| label.bounds).collect();
    validate_all(path, &boxes, width, height)?;
    Ok(boxes)
}

/// Reads the boxes of a `width` × `height` image with their classes, as [`read_boxes`] does without.
///
/// Boxes that hold no pixel are read too, if they touch the image: a label may be a sliver at its edge.
///
/// # Errors
///
/// As [`read_boxes`], but for such boxes.
pub fn read_labels(
    path: impl AsRef<Path>,
    width: usize,
    height: usize,
) -> Result<Vec<LabelledBox>, CloudError> {
    let path = path.as_ref();
    let bytes = pomona_files::read(path)?;
    let labels = parse(&bytes, width, height).map_err(|fault| fault.at(path))?;
    touch_all(path, &labels, width, height)?;
    Ok(labels)
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

fn parse(bytes: &[u8], width: usize, height: usize) -> Result<Vec<LabelledBox>, Malformed> {
    let text = text_of(bytes)?;
    match text.trim_start().chars().next() {
        Some('<') => voc::parse(text, width, height),
        Some('{' | '[') => coco::parse(text, width, height),
        _ => yolo::parse(text, width, height),
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
            let back = read_boxes(&path, 64, 32).unwrap();
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
        let message = read_boxes(&path, 64, 32).unwrap_err().to_string();
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
        let missing = read_boxes(dir.path().join("none.xml"), 1, 1)
            .unwrap_err()
            .to_string();
        assert!(missing.contains("none.xml"), "{missing}");
    }

    #[test]
    fn boxes_of_another_image_size_are_refused() {
        let xml = "<annotation><size><width>640</width><height>480</height></size></annotation>";
        let fault = parse(xml.as_bytes(), 64, 32).unwrap_err();
        assert!(fault.problem.contains("640x480") && fault.problem.contains("64x32"));
        assert_eq!(parse(xml.as_bytes(), 640, 480).unwrap(), []);
        let json = br#"{"images":[{"id":1,"width":640,"height":480}],"annotations":[]}"#;
        assert!(parse(json, 64, 32).is_err());
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
                let _ = parse(&whole.as_bytes()[..at], 64, 32);
                for change in [1, 3, 0x10, 0x80] {
                    let mut bytes = whole.clone().into_bytes();
                    bytes[at] ^= change;
                    for label in parse(&bytes, 64, 32).unwrap_or_default() {
                        let _ = label.bounds.window(64, 32);
                    }
                }
            }
        }
    }
}
