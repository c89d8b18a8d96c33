use super::{
    collector::Collector,
    decoder::Decoder,
    grids::{USUAL_STRIDES, cells},
    table::{self, Table},
};
use crate::{detection::Detection, family::Coordinates};
use pomona_network::{Malformed, Tensor};

/// Column of the objectness: how sure the network is that there is anything.
pub(super) const OBJECTNESS: usize = 4;

/// Columns before the classes: box and objectness.
pub(super) const BEFORE_CLASSES: usize = 5;

/// Largest centre of a box in shares of the input; with any beyond it, coordinates are pixels. Every cell reports a
/// centre, so that a network that counts in pixels always has some far beyond 2, and one that gives shares none.
const LARGEST_SHARE: f32 = 2.0;

pub(super) fn decode(decoder: &Decoder, outputs: &[Tensor]) -> Result<Vec<Detection>, Malformed> {
    let tensor = decoder.rows(outputs)?;
    let table = Table::new(tensor)?;
    let place = table::place(tensor);
    if table.columns < BEFORE_CLASSES {
        let problem = format!(
            "{} columns; {} has 5 and the classes",
            table.columns, decoder.family
        );
        return Err(Malformed::new(place, problem, "state the model's `family`"));
    }
    // Without a column for a class, the objectness is the score.
    let classes = decoder.class_columns(table.columns, BEFORE_CLASSES);
    decoder.check_classes(&place, classes.max(1))?;
    if !decoder.stated && table.rows == cells(decoder.input, USUAL_STRIDES) {
        return Err(Malformed::new(
            place,
            format!(
                "its shape {:?} is that of yolox, where it was left open before",
                tensor.shape
            ),
            "state `family = \"yolox\"`, or `\"yolov5\"` if the model decodes its boxes itself",
        ));
    }
    let [width, height] = scale(decoder, &table);
    let mut found = Collector::new(decoder);
    for row in 0..table.rows {
        let objectness = table.get(row, OBJECTNESS);
        if !found.counts(objectness) {
            continue;
        }
        let class = if classes == 0 {
            1.0
        } else {
            decoder.best(|class| table.get(row, BEFORE_CLASSES + class))
        };
        let [x, y, w, h] = table.first_four(row);
        found.add_centred(
            [x * width, y * height, w * width, h * height],
            objectness * class,
        );
    }
    Ok(found.detections)
}

/// What decoded coordinates are multiplied by.
pub(super) fn scale(decoder: &Decoder, table: &Table<'_>) -> [f32; 2] {
    let coordinates = decoder.coordinates.unwrap_or_else(|| {
        let centre = |row| table.get(row, 0).max(table.get(row, 1));
        let in_pixels = (0..table.rows).any(|row| centre(row) > LARGEST_SHARE);
        if in_pixels {
            Coordinates::Pixels
        } else {
            Coordinates::Normalized
        }
    });
    match coordinates {
        Coordinates::Pixels => [1.0; 2],
        Coordinates::Normalized => decoder.input.map(|side| side as f32),
    }
}
