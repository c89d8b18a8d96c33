use super::{
    collector::Collector,
    decoder::Decoder,
    table::{self, check_length},
};
use crate::detection::Detection;
use pomona_network::{Malformed, Tensor};

/// Place of the objectness among an anchor's numbers.
const OBJECTNESS: usize = 4;

/// Numbers to an anchor before the classes: box and objectness.
const BEFORE_CLASSES: usize = 5;

/// `YOLOv3`'s anchors in pixels, those of the finest grid first (arXiv 1804.02767, section 2.3).
const ANCHORS: [[f32; 2]; 9] = [
    [10.0, 13.0],
    [16.0, 30.0],
    [33.0, 23.0],
    [30.0, 61.0],
    [62.0, 45.0],
    [59.0, 119.0],
    [116.0, 90.0],
    [156.0, 198.0],
    [373.0, 326.0],
];

/// `YOLOv3-tiny`'s, from its authors' configuration (`yolov3-tiny.cfg` of darknet).
const TINY_ANCHORS: [[f32; 2]; 6] = [
    [10.0, 14.0],
    [23.0, 27.0],
    [37.0, 58.0],
    [81.0, 82.0],
    [135.0, 169.0],
    [344.0, 319.0],
];

/// Strides that a head can have where the description names none.
const STRIDES: std::ops::RangeInclusive<usize> = 4..=128;

/// How the numbers of one grid lie in memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Head {
    stride: usize,
    columns: usize,
    rows: usize,
    pub(super) classes: usize,
    /// Steps from anchor to anchor, number to number, row to row, column to column.
    steps: [usize; 4],
}

impl Head {
    /// Of an output of this shape, batch included, with so many anchors to a cell.
    ///
    /// The axes after the batch may be `A·P h w`, `h w A·P`, `A h w P`, `A P h w` or `h w A P`, where `P` is 5 and
    /// the number of classes; the first of these whose `h` and `w` are a grid of the input is meant.
    pub(super) fn new(
        shape: &[usize],
        anchors: usize,
        input: [usize; 2],
        strides: Option<&[usize]>,
    ) -> Option<Self> {
        let candidates: Vec<([usize; 3], [usize; 4])> = match *shape {
            [1, a, b, c] => vec![
                ([b, c, a / anchors], [a / anchors * b * c, b * c, c, 1]),
                ([a, b, c / anchors], [c / anchors, 1, b * c, c]),
            ],
            [1, a, b, c, d] => vec![
                ([b, c, d], [b * c * d, 1, c * d, d]),
                ([c, d, b], [b * c * d, c * d, d, 1]),
                ([a, b, d], [d, 1, b * c * d, c * d]),
            ],
            _ => return None,
        };
        let divides = |numbers: usize| {
            let length: usize = shape.iter().product();
            // Each way of reading must use all the numbers.
            move |[rows, columns, _]: [usize; 3]| rows * columns * anchors * numbers == length
        };
        candidates.into_iter().find_map(|(sides, steps)| {
            let [rows, columns, numbers] = sides;
            let fits = numbers > BEFORE_CLASSES && rows > 0 && columns > 0;
            if !fits || !divides(numbers)(sides) {
                return None;
            }
            let stride = input[0] / columns;
            let allowed = match strides {
                Some(strides) => strides.contains(&stride),
                None => STRIDES.contains(&stride),
            };
            let grid = allowed && columns * stride == input[0] && rows * stride == input[1];
            grid.then_some(Self {
                stride,
                columns,
                rows,
                classes: numbers - BEFORE_CLASSES,
                steps,
            })
        })
    }
}

/// The anchors of each cell on each of so many grids, those of the finest grid first.
pub(super) fn anchors(
    heads: usize,
    described: Option<&[[f32; 2]]>,
) -> Result<&[[f32; 2]], Malformed> {
    let anchors = match (described, heads) {
        (Some(anchors), _) => anchors,
        (None, 3) => &ANCHORS[..],
        (None, 2) => &TINY_ANCHORS[..],
        (None, _) => {
            let problem = format!("{heads} grids, for which there are no usual anchors");
            return Err(Malformed::new(
                "outputs",
                problem,
                "list the model's `anchors`",
            ));
        }
    };
    if heads == 0 || anchors.is_empty() || anchors.len() % heads != 0 {
        return Err(Malformed::new(
            "`anchors`",
            format!("{} of them for {heads} grids", anchors.len()),
            "list the anchors of every grid, as many for each, those of the finest grid first",
        ));
    }
    Ok(anchors)
}

pub(super) fn decode(decoder: &Decoder, outputs: &[Tensor]) -> Result<Vec<Detection>, Malformed> {
    let anchors = anchors(outputs.len(), decoder.anchors.as_deref())?;
    let per_cell = anchors.len() / outputs.len();
    let mut heads = Vec::with_capacity(outputs.len());
    for tensor in outputs {
        check_length(tensor)?;
        let strides = decoder.strides.as_deref();
        let head = Head::new(&tensor.shape, per_cell, decoder.input, strides).ok_or_else(|| {
            let [width, height] = decoder.input;
            Malformed::new(
                table::place(tensor),
                format!(
                    "its shape {:?} is no grid of a {width}x{height} input with {per_cell} anchors to a cell",
                    tensor.shape
                ),
                "state `family`, `input_size`, `strides` or `anchors`",
            )
        })?;
        decoder.check_classes(&table::place(tensor), head.classes)?;
        heads.push((head, tensor));
    }
    heads.sort_by_key(|(head, _)| head.stride);
    if let Some(pair) = heads
        .windows(2)
        .find(|pair| pair[0].0.stride == pair[1].0.stride)
    {
        let problem = format!("the same grid as output `{}`", pair[0].1.name);
        return Err(Malformed::new(
            table::place(pair[1].1),
            problem,
            "state the model's `family`",
        ));
    }
    let mut found = Collector::new(decoder);
    for ((head, tensor), anchors) in heads.iter().zip(anchors.chunks_exact(per_cell)) {
        decode_head(head, &tensor.data, anchors, decoder, &mut found);
    }
    Ok(found.detections)
}

/// arXiv 1804.02767, section 2.1: centres by a sigmoid within their cell, sizes by an exponential times the anchor's.
fn decode_head(
    head: &Head,
    data: &[f32],
    anchors: &[[f32; 2]],
    decoder: &Decoder,
    found: &mut Collector,
) {
    let [anchor_step, number_step, row_step, column_step] = head.steps;
    let stride = head.stride as f32;
    for (a, anchor) in anchors.iter().enumerate() {
        for v in 0..head.rows {
            for u in 0..head.columns {
                let start = a * anchor_step + v * row_step + u * column_step;
                let number = |k: usize| data[start + k * number_step];
                let objectness = sigmoid(number(OBJECTNESS));
                if !found.counts(objectness) {
                    continue;
                }
                let centre = [
                    (sigmoid(number(0)) + u as f32) * stride,
                    (sigmoid(number(1)) + v as f32) * stride,
                ];
                let size = [number(2).exp() * anchor[0], number(3).exp() * anchor[1]];
                let best = decoder.best(|class| number(BEFORE_CLASSES + class));
                let score = objectness * sigmoid(best);
                found.add_centred([centre[0], centre[1], size[0], size[1]], score);
            }
        }
    }
}

fn sigmoid(x: f32) -> f32 {
    1.0 / (1.0 + (-x).exp())
}
