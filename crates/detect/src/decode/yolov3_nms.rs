use super::{
    collector::Collector,
    decoder::Decoder,
    table::{self, check_length},
};
use crate::detection::Detection;
use pomona_network::{Element, Malformed, Port, Tensor};

/// Which outputs are the boxes, the scores and the chosen rows: the integers are the chosen ones, and of the others
/// the first whose last axis is 4 long holds the boxes; else they come in this order.
pub(super) fn roles(ports: &[Port]) -> Option<[usize; 3]> {
    if ports.len() != 3 {
        return None;
    }
    let whole = |port: &Port| matches!(port.element, Element::I32 | Element::I64);
    let chosen = ports.iter().position(whole).unwrap_or(2);
    let others: Vec<usize> = (0..3).filter(|&k| k != chosen).collect();
    let corners = |&k: &usize| ports[k].shape.last() == Some(&Some(4));
    let boxes = others
        .iter()
        .copied()
        .find(|k| corners(k))
        .unwrap_or(others[0]);
    let scores = others.into_iter().find(|&k| k != boxes)?;
    Some([boxes, scores, chosen])
}

/// The network is told that the image has the size of its input, so that its boxes are in pixels of the input, and one
/// exact mapping leads from there to the image.
pub(super) fn decode(decoder: &Decoder, outputs: &[Tensor]) -> Result<Vec<Detection>, Malformed> {
    let roles = roles(&decoder.ports).ok_or_else(|| {
        let problem = format!("{} of them, where yolov3-nms has 3", decoder.ports.len());
        Malformed::new("outputs", problem, "state the model's `family`")
    })?;
    let [boxes, scores, chosen] = roles.map(|k| &outputs[k]);
    for tensor in [boxes, scores, chosen] {
        check_length(tensor)?;
    }
    let shape_fault = |tensor: &Tensor, wanted: &str| {
        let problem = format!("its shape is {:?}, not {wanted}", tensor.shape);
        Malformed::new(table::place(tensor), problem, "state the model's `family`")
    };
    let [1, rows, 4] = boxes.shape[..] else {
        return Err(shape_fault(boxes, "[1, N, 4]"));
    };
    let [1, classes, scored] = scores.shape[..] else {
        return Err(shape_fault(scores, "[1, C, N]"));
    };
    if scored != rows {
        return Err(shape_fault(scores, &format!("[1, C, {rows}]")));
    }
    let ([_, 3] | [1, _, 3]) = chosen.shape[..] else {
        return Err(shape_fault(chosen, "[M, 3]"));
    };
    decoder.check_classes(&table::place(scores), classes)?;
    let mut found = Collector::new(decoder);
    for triple in chosen.data.chunks_exact(3) {
        // Unused places are filled with -1.
        let [Some(0), Some(class), Some(row)] = [0, 1, 2].map(|k| whole(triple[k])) else {
            continue;
        };
        if !decoder.wanted.contains(&class) || row >= rows {
            continue;
        }
        let corner = |k: usize| f64::from(boxes.data[row * 4 + k]);
        let score = scores.data[class * rows + row];
        found.add_corners([corner(1), corner(0), corner(3), corner(2)], score);
    }
    Ok(found.detections)
}

/// The whole number that a float holds, if it is one and not negative.
fn whole(x: f32) -> Option<usize> {
    (x >= 0.0 && x.fract() == 0.0).then_some(x as usize)
}
