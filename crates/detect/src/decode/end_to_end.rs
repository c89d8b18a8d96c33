use super::{
    collector::Collector,
    decoder::Decoder,
    grids::on_usual_grid,
    table::{self, Table},
    yolov5,
};
use crate::{detection::Detection, family::Family};
use pomona_network::{Malformed, Tensor};

/// Numbers to a box: its edges, score and class.
pub(super) const COLUMNS: usize = 6;

/// Place of the score among them.
const SCORE: usize = 4;

/// Place of the class among them.
const CLASS: usize = 5;

/// How many rows Ultralytics' exports have, whatever the image shows.
pub(super) const USUAL_ROWS: usize = 300;

/// Whether rows that the model left open turn out to be those of such a model: six numbers to a row, and not as many
/// rows as the grids of another family have cells or anchors.
pub(super) fn is(decoder: &Decoder, outputs: &[Tensor]) -> bool {
    if decoder.stated || !matches!(decoder.family, Family::YoloV5 | Family::YoloV8) {
        return false;
    }
    let table = decoder.rows(outputs).and_then(Table::new);
    let strides = decoder.strides.as_deref();
    let on_grid = |rows| {
        [1, 3]
            .into_iter()
            .any(|times| on_usual_grid(rows, times, decoder.input, strides))
    };
    table.is_ok_and(|table| table.columns == COLUMNS && !on_grid(table.rows))
}

pub(super) fn decode(decoder: &Decoder, outputs: &[Tensor]) -> Result<Vec<Detection>, Malformed> {
    let tensor = decoder.rows(outputs)?;
    let table = Table::new(tensor)?;
    let fault =
        |problem: String, remedy: &str| Err(Malformed::new(table::place(tensor), problem, remedy));
    if table.columns < COLUMNS && table.rows > 0 {
        let problem = format!(
            "{} numbers to a box; end2end has 6: edges, score and class",
            table.columns
        );
        return fault(problem, "state the model's `family`");
    }
    let [width, height] = yolov5::scale(decoder, &table);
    let mut found = Collector::new(decoder);
    let mut guessed: Option<usize> = None;
    for row in 0..table.rows {
        let score = table.get(row, SCORE);
        if !found.counts(score) {
            continue;
        }
        let number = table.get(row, CLASS);
        let class = decoder.classes.map_or(usize::MAX, |count| count - 1);
        let is_class = number >= 0.0 && number.fract() == 0.0 && number as usize <= class;
        if !is_class || score > 1.0 {
            let problem =
                format!("row {row} has score {score} and class {number}, which is none of end2end");
            return fault(problem, "state the model's `family`, and its `classes`");
        }
        let class = number as usize;
        if decoder.class_is_guess {
            if let Some(other) = guessed.filter(|&other| other != class) {
                let problem =
                    format!("boxes of classes {other} and {class}, which the model does not name");
                return fault(problem, "say by --class which of them is an apple");
            }
            guessed = Some(class);
        } else if !decoder.wanted.contains(&class) {
            continue;
        }
        let [x_min, y_min, x_max, y_max] = table.first_four(row);
        let corners = [x_min * width, y_min * height, x_max * width, y_max * height];
        found.add_corners(corners.map(f64::from), score);
    }
    if let Some(class) = guessed {
        for detection in &mut found.detections {
            detection.class = class;
        }
    }
    Ok(found.detections)
}
