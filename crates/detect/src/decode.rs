//! What a network's outputs say: one file for each family, and how a family is told from the others.

mod found;
mod recognise;
mod table;
mod yolov3;
mod yolov3_nms;
mod yolov5;
mod yolov8;
mod yolox;

pub(crate) use recognise::{class_count, recognise};

use crate::{Detection, Family, Port, Tensor, description::Coordinates, fault::Fault};

/// Strides of the grids of nearly all of these networks.
const USUAL_STRIDES: &[usize] = &[8, 16, 32];

/// Reads a network's outputs.
///
/// Boxes come out in pixels of the input, in the order of the rows, not suppressed. Whatever is not a box, with a
/// number that is not finite or without area, is left out; a score beyond 1 is 1.
#[derive(Clone, Debug)]
pub(crate) struct Decoder {
    pub(crate) family: Family,
    /// Whether somebody said so, against recognised.
    pub(crate) stated: bool,
    /// Width and height of the input in pixels.
    pub(crate) input: [usize; 2],
    pub(crate) class: usize,
    pub(crate) threshold: f64,
    /// Number of classes, where they have names.
    pub(crate) classes: Option<usize>,
    pub(crate) strides: Option<Vec<usize>>,
    pub(crate) anchors: Option<Vec<[f32; 2]>>,
    pub(crate) coordinates: Option<Coordinates>,
    /// The outputs as the model declares them.
    pub(crate) ports: Vec<Port>,
}

impl Decoder {
    /// The boxes of the class that counts, from the outputs in the order of the ports.
    pub(crate) fn decode(&self, outputs: &[Tensor]) -> Result<Vec<Detection>, Fault> {
        if outputs.len() < self.ports.len() {
            return Err(Fault::new(
                "outputs",
                format!("{} of {} came", outputs.len(), self.ports.len()),
                "export the model again",
            ));
        }
        let outputs = &outputs[..self.ports.len()];
        match self.family {
            Family::YoloV3 => yolov3::decode(self, outputs),
            Family::YoloV3Nms => yolov3_nms::decode(self, outputs),
            Family::YoloV5 => yolov5::decode(self, outputs),
            Family::YoloV8 => yolov8::decode(self, outputs),
            Family::YoloX => yolox::decode(self, outputs),
        }
    }

    /// The output that holds rows of boxes.
    fn flat<'a>(&self, outputs: &'a [Tensor]) -> Result<&'a Tensor, Fault> {
        let at = recognise::flat_output(&self.ports).unwrap_or(0);
        outputs.get(at).ok_or_else(|| {
            let problem = format!("none, and {} is read from one", self.family);
            Fault::new("outputs", problem, "export the model again")
        })
    }

    /// Refuses a number of classes that their names or the choice contradict.
    fn check_classes(&self, place: &str, count: usize) -> Result<(), Fault> {
        if let Some(named) = self.classes
            && named != count
        {
            return Err(Fault::new(
                place,
                format!("{count} classes, of which {named} are named"),
                "name every class of the model in `classes`, in its order, or state its `family`",
            ));
        }
        crate::classes::check(self.class, Some(count))
    }
}

/// How many cells the grids of these strides have together.
fn cells(input: [usize; 2], strides: &[usize]) -> usize {
    let grid = |stride: &usize| input[0].div_ceil(*stride) * input[1].div_ceil(*stride);
    strides.iter().map(grid).sum()
}
