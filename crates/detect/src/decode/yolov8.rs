use super::{
    collector::Collector,
    decoder::Decoder,
    grids::{GRIDS, cells},
    table::{self, Table},
    yolov5,
};
use crate::detection::Detection;
use pomona_network::{Malformed, Tensor};

/// Columns before the classes: the box.
pub(super) const BEFORE_CLASSES: usize = 4;

pub(super) fn decode(decoder: &Decoder, outputs: &[Tensor]) -> Result<Vec<Detection>, Malformed> {
    let tensor = decoder.rows(outputs)?;
    let mut table = Table::new(tensor)?;
    let place = table::place(tensor);
    if columns_first(
        [table.rows, table.columns],
        Some(decoder.input),
        decoder.classes,
    ) {
        table = table.transposed();
    }
    if table.columns <= BEFORE_CLASSES {
        let problem = format!(
            "{} numbers to a box; yolov8 has 4 and the classes",
            table.columns
        );
        return Err(Malformed::new(place, problem, "state the model's `family`"));
    }
    let classes = decoder.class_columns(table.columns, BEFORE_CLASSES);
    decoder.check_classes(&place, classes)?;
    let [width, height] = yolov5::scale(decoder, &table);
    let mut found = Collector::new(decoder);
    for row in 0..table.rows {
        let score = decoder.best(|class| table.get(row, BEFORE_CLASSES + class));
        if found.counts(score) {
            let [x, y, w, h] = table.first_four(row);
            found.add_centred([x * width, y * height, w * width, h * height], score);
        }
    }
    Ok(found.detections)
}

/// Whether an output of this shape holds the numbers of a box along its first axis, as the family does, unless only the
/// second axis agrees with the number of classes, or only the first with the grids. Where neither decides, the shorter
/// axis is taken: there are more boxes than numbers to a box.
pub(super) fn columns_first(
    [first, second]: [usize; 2],
    input: Option<[usize; 2]>,
    classes: Option<usize>,
) -> bool {
    let by_classes = |axis: usize| classes.is_some_and(|c| axis == BEFORE_CLASSES + c);
    if by_classes(first) != by_classes(second) {
        return by_classes(first);
    }
    let by_grid = |axis: usize| {
        input.is_some_and(|input| GRIDS.iter().any(|grid| axis == cells(input, grid)))
    };
    if by_grid(first) != by_grid(second) {
        return by_grid(second);
    }
    first <= second
}
