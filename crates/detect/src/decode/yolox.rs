use super::table::Table;
use super::{Decoder, USUAL_STRIDES, cells, found::Found, table, yolov5::BEFORE_CLASSES};
use crate::{Detection, Tensor, fault::Fault};

pub(super) fn decode(decoder: &Decoder, outputs: &[Tensor]) -> Result<Vec<Detection>, Fault> {
    let tensor = decoder.flat(outputs)?;
    let table = Table::new(tensor)?;
    let place = table::place(tensor);
    if table.columns <= BEFORE_CLASSES {
        let problem = format!("{} columns; yolox has 5 and the classes", table.columns);
        return Err(Fault::new(place, problem, "state the model's `family`"));
    }
    decoder.check_classes(&place, table.columns - BEFORE_CLASSES)?;
    let strides = decoder.strides.as_deref().unwrap_or(USUAL_STRIDES);
    let [width, height] = decoder.input;
    let expected = cells(decoder.input, strides);
    if table.rows != expected {
        return Err(Fault::new(
            place,
            format!(
                "{} rows, where the grids of strides {strides:?} on {width}x{height} pixels have {expected} cells",
                table.rows
            ),
            "state `family`, `input_size` or `strides`",
        ));
    }
    let mut found = Found::new(decoder);
    let mut row = 0;
    for &stride in strides {
        for v in 0..height.div_ceil(stride) {
            for u in 0..width.div_ceil(stride) {
                let something = table.get(row, 4);
                if found.counts(something) {
                    let score = something * table.get(row, BEFORE_CLASSES + decoder.class);
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
