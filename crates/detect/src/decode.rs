//! What a network's outputs mean: one file for each family, and how a family is recognised.

mod collector;
mod decoder;
mod end_to_end;
mod grids;
mod recognise;
mod table;
mod yolov3;
mod yolov3_nms;
mod yolov5;
mod yolov8;
mod yolox;

pub(crate) use decoder::Decoder;
pub(crate) use recognise::{class_count, recognise};

use crate::{detection::Detection, family::Family};
use pomona_network::{Malformed, Tensor};

/// The boxes of the class that counts, from a network's outputs in the order of its ports.
///
/// They are in pixels of the input, in the order of the rows, and not suppressed. What is not a box, with a number that
/// is not finite or without area, is left out; a score beyond 1 is 1.
pub(crate) fn decode(decoder: &Decoder, outputs: &[Tensor]) -> Result<Vec<Detection>, Malformed> {
    let declared = decoder.ports.len();
    let outputs = outputs.get(..declared).ok_or_else(|| {
        Malformed::new(
            "outputs",
            format!("{} of {declared} came", outputs.len()),
            "export the model again",
        )
    })?;
    if end_to_end::is(decoder, outputs) {
        return end_to_end::decode(decoder, outputs);
    }
    match decoder.family {
        Family::YoloV3 => yolov3::decode(decoder, outputs),
        Family::YoloV3Nms => yolov3_nms::decode(decoder, outputs),
        Family::YoloV5 => yolov5::decode(decoder, outputs),
        Family::YoloV8 => yolov8::decode(decoder, outputs),
        Family::EndToEnd => end_to_end::decode(decoder, outputs),
        Family::YoloX => yolox::decode(decoder, outputs),
    }
}
