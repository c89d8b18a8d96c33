use super::{
    collector::Collector,
    decoder::Decoder,
    grids::{USUAL_STRIDES, cells},
    table::{self, Table},
    yolov5::{BEFORE_CLASSES, OBJECTNESS},
};
use crate::detection::Detection;
use pomona_network::{Malformed, Tensor};

pub(super) fn decode(decoder: &Decoder, outputs: &[Tensor]) -> Result<Vec<Detection>, Malformed> {
    let tensor = decoder.rows(outputs)?;
    let table = Table::new(tensor)?;
    let place = table::place(tensor);
    if table.columns <= BEFORE_CLASSES {
        let problem = format!("{} columns; yolox has 5 and the classes", table.columns);
        return Err(Malformed::new(place, problem, "state the model's `family`"));
    }
    decoder.check_classes(&place, table.columns - BEFORE_CLASSES)?;
    let strides = decoder.strides.as_deref().unwrap_or(USUAL_STRIDES);
    let [width, height] = decoder.input;
    let expected = cells(decoder.input, strides);
    if table.rows != expected {
        return Err(Malformed::new(
            place,
            format!(
                "{} rows, where the grids of strides {strides:?} on {width}x{height} pixels have {expected} cells",
                table.rows
            ),
            "state `family`, `input_size` or `strides`",
        ));
    }
    let mut found = Collector::new(decoder);
    if is_decoded(&table, &found) {
        for row in 0..table.rows {
            let objectness = table.get(row, OBJECTNESS);
            let best = decoder.best(|class| table.get(row, BEFORE_CLASSES + class));
            found.add_centred(table.first_four(row), objectness * best);
        }
        return Ok(found.detections);
    }
    let mut row = 0;
    for &stride in strides {
        for v in 0..height.div_ceil(stride) {
            for u in 0..width.div_ceil(stride) {
                let objectness = table.get(row, OBJECTNESS);
                if found.counts(objectness) {
                    let best = decoder.best(|class| table.get(row, BEFORE_CLASSES + class));
                    let score = objectness * best;
                    let [x, y, w, h] = table.first_four(row);
                    let stride = stride as f32;
                    let centre = [(x + u as f32) * stride, (y + v as f32) * stride];
                    let size = [w.exp() * stride, h.exp() * stride];
                    found.add_centred([centre[0], centre[1], size[0], size[1]], score);
                }
                row += 1;
            }
        }
    }
    Ok(found.detections)
}

/// Largest number of a box in units of the stride: a centre lies in its cell or near it, and sides are logarithms of at
/// most some dozens of cells.
const LARGEST_RELATIVE: f32 = 16.0;

/// Whether the boxes are in pixels of the input already, as the likely ones show: fruit that is larger than some pixels
/// or further than that from the corner of the image has larger numbers than any in units of the stride.
fn is_decoded(table: &Table<'_>, found: &Collector) -> bool {
    let likely = (0..table.rows).filter(|&row| found.counts(table.get(row, OBJECTNESS)));
    likely
        .into_iter()
        .any(|row| table.first_four(row).iter().any(|x| *x > LARGEST_RELATIVE))
}
