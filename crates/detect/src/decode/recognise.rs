use super::{
    end_to_end,
    grids::{USUAL_STRIDES, cells, on_usual_grid},
    table::rows_output,
    yolov3, yolov3_nms, yolov5, yolov8,
};
use crate::{
    description::ModelDescription,
    family::Family,
    metadata::{Metadata, Task},
};
use pomona_network::{Malformed, Port};

/// The family of a network with these inputs and outputs.
///
/// `input` is its width and height in pixels, where they are known. Two inputs and three outputs are the ONNX model
/// zoo's `YOLOv3`. An output with three axes is recognised by its number of rows: with as many as the grids have cells
/// along its last axis it is `YOLOv8`, along its middle axis YOLOX, and with three times as many `YOLOv5`; with rows of
/// six numbers and none of these it suppresses its boxes itself. Outputs of four or five axes alone are `YOLOv3`'s grids.
pub(crate) fn recognise(
    inputs: &[Port],
    outputs: &[Port],
    input: Option<[usize; 2]>,
    description: &ModelDescription,
    metadata: &Metadata,
) -> Result<Family, Malformed> {
    if let Some(family) = description.family {
        return Ok(family);
    }
    metadata.check_task()?;
    if inputs.len() == 2 && yolov3_nms::roles(outputs).is_some() {
        return Ok(Family::YoloV3Nms);
    }
    if let Some(k) = rows_output(outputs) {
        return rows_family(&outputs[k], input, description, metadata);
    }
    let grid = |port: &Port| matches!(port.shape.len(), 4 | 5);
    if !outputs.is_empty() && outputs.iter().all(grid) {
        return Ok(Family::YoloV3);
    }
    let shown: Vec<String> = outputs.iter().map(show).collect();
    Err(Malformed::new(
        "outputs",
        format!("{} are those of no known family", shown.join(", ")),
        "export the model without suppression inside, or state its `family` in the description beside it",
    ))
}

fn rows_family(
    output: &Port,
    input: Option<[usize; 2]>,
    description: &ModelDescription,
    metadata: &Metadata,
) -> Result<Family, Malformed> {
    let unknown = |problem: &str| {
        let size = input.map_or_else(String::new, |[w, h]| format!(" of a {w}x{h} input"));
        let problem = format!("{}{size}: {problem}", show(output));
        let remedy = "state `family`, and `input_size` or `strides` where they are unusual, in the \
            description beside the model";
        Err(Malformed::new("outputs", problem, remedy))
    };
    let grids = description.strides.as_deref();
    let on_grid = |rows: usize, times: usize| {
        input.is_some_and(|input| on_usual_grid(rows, times, input, grids))
    };
    let yolox = |rows: usize| {
        input.is_some_and(|input| cells(input, grids.unwrap_or(USUAL_STRIDES)) == rows)
    };
    let classes = description.classes.as_ref().map(Vec::len);
    let boxes_only =
        |columns: usize| classes.is_some_and(|c| columns == yolov8::BEFORE_CLASSES + c);
    let suppressed = |columns: usize| {
        columns == end_to_end::COLUMNS
            || (metadata.task == Task::BoxesAndMore && columns > end_to_end::COLUMNS)
    };
    match output.shape[1..] {
        [_, Some(columns)] if metadata.end_to_end && suppressed(columns) => Ok(Family::EndToEnd),
        [Some(columns), Some(rows)] if on_grid(rows, 1) && columns > yolov8::BEFORE_CLASSES => {
            Ok(Family::YoloV8)
        }
        [Some(rows), Some(columns)] if on_grid(rows, 1) && boxes_only(columns) => {
            Ok(Family::YoloV8)
        }
        [Some(rows), Some(columns)] if yolox(rows) && columns > yolov5::BEFORE_CLASSES => {
            Ok(Family::YoloX)
        }
        [Some(rows), Some(columns)] if on_grid(rows, 3) && columns >= yolov5::BEFORE_CLASSES => {
            Ok(Family::YoloV5)
        }
        [Some(rows), Some(end_to_end::COLUMNS)]
            if input.is_some() || rows == end_to_end::USUAL_ROWS =>
        {
            Ok(Family::EndToEnd)
        }
        // Neither box, objectness and classes nor box and classes are six numbers.
        [None, Some(end_to_end::COLUMNS)] if classes.is_some_and(|c| c != 1 && c != 2) => {
            Ok(Family::EndToEnd)
        }
        // YOLOX's own export leaves no axis open but the batch.
        [None, Some(columns)] if boxes_only(columns) => Ok(Family::YoloV8),
        [None, Some(columns)] if columns >= yolov5::BEFORE_CLASSES => Ok(Family::YoloV5),
        [Some(columns), None] if columns > yolov8::BEFORE_CLASSES => Ok(Family::YoloV8),
        [None, None] => unknown("it leaves open what would tell its family"),
        [Some(_), Some(_)] if input.is_none() => {
            unknown("its family cannot be told while the input's size is open")
        }
        _ => unknown("it has neither one nor three rows for each cell of the usual grids"),
    }
}

/// How many classes the outputs hold, as far as their declared shapes tell.
pub(crate) fn class_count(
    family: Family,
    outputs: &[Port],
    input: [usize; 2],
    description: &ModelDescription,
    metadata: &Metadata,
) -> Option<usize> {
    if let (Some(named), Task::BoxesAndMore) = (&description.classes, &metadata.task) {
        return Some(named.len());
    }
    let is_open = |port: &Port| {
        port.shape.get(1) == Some(&None) && port.shape.get(2) == Some(&Some(end_to_end::COLUMNS))
    };
    if description.family.is_none() && rows_output(outputs).is_some_and(|k| is_open(&outputs[k])) {
        // It may turn out to suppress its boxes itself, with any number of classes.
        return None;
    }
    match family {
        Family::EndToEnd => None,
        Family::YoloV5 | Family::YoloX => {
            let columns = (*outputs[rows_output(outputs)?].shape.last()?)?;
            Some(columns.checked_sub(yolov5::BEFORE_CLASSES)?.max(1))
        }
        Family::YoloV8 => {
            let columns = match outputs[rows_output(outputs)?].shape[1..] {
                [Some(first), Some(second)] => {
                    let classes = description.classes.as_ref().map(Vec::len);
                    let first_is = yolov8::columns_first([first, second], Some(input), classes);
                    if first_is { first } else { second }
                }
                [Some(columns), None] | [None, Some(columns)] => columns,
                _ => return None,
            };
            columns.checked_sub(yolov8::BEFORE_CLASSES)
        }
        Family::YoloV3Nms => {
            let [_, scores, _] = yolov3_nms::roles(outputs)?;
            *outputs[scores].shape.get(1)?
        }
        Family::YoloV3 => {
            let anchors = yolov3::anchors(outputs.len(), description.anchors.as_deref()).ok()?;
            let mut shape: Vec<usize> = Vec::new();
            for side in outputs[0].shape.iter().skip(1) {
                shape.push((*side)?);
            }
            shape.insert(0, 1);
            shape
                .iter()
                .try_fold(1_usize, |product, &side| product.checked_mul(side))?;
            let per_cell = anchors.len() / outputs.len();
            let strides = description.strides.as_deref();
            yolov3::Head::new(&shape, per_cell, input, strides).map(|head| head.classes)
        }
    }
}

/// An output's name and shape.
fn show(port: &Port) -> String {
    format!("`{}` {}", port.name, port.shape_text())
}
