//! What is wood about the apples of a frame.

use crate::detector::{BUILT_IN, Model, parse_model};
use crate::segmenter::{options, say};
use crate::terminal::Terminal;
use pomona_cloud::{ColorImage, GrayImage, PixelBox, PixelWindow};
use pomona_segment::{CloseUps, RuntimeChoice, TilingChoice};

/// The word for no segmenter.
const NONE: &str = "none";

/// How far about an apple wood is told, half sides of its box: beyond the reach of the search for branches.
const REACH: f64 = 3.6;

/// Which segmenter tells wood.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum SegmenterChoice {
    /// None.
    None,
    /// This model.
    Model(Model),
}

pub(crate) fn parse_segmenter(text: &str) -> Result<SegmenterChoice, String> {
    if text == NONE {
        return Ok(SegmenterChoice::None);
    }
    let model =
        parse_model(text).map_err(|error| format!("{error}; or `{BUILT_IN}` or `{NONE}`"))?;
    Ok(SegmenterChoice::Model(model))
}

/// Opens the segmenter, and says what was assumed about it.
pub(crate) fn open(
    model: &Model,
    runtime: &RuntimeChoice,
    terminal: Terminal,
) -> anyhow::Result<CloseUps> {
    let segmenter = CloseUps::open(&options(model, runtime, TilingChoice::Automatic))?;
    say(&segmenter.report(), terminal);
    Ok(segmenter)
}

/// The probability of wood about the boxes; 0 elsewhere.
pub(crate) fn about(
    segmenter: &CloseUps,
    image: &ColorImage,
    boxes: &[&PixelBox],
) -> anyhow::Result<GrayImage> {
    let (width, height) = (image.width, image.height);
    let windows: Vec<PixelWindow> = boxes
        .iter()
        .map(|b| {
            let middle = (0.5 * (b.x_min + b.x_max), 0.5 * (b.y_min + b.y_max));
            let reach = REACH * 0.5 * (b.x_max - b.x_min).max(b.y_max - b.y_min);
            PixelWindow::clamped(
                middle.0 - reach,
                middle.1 - reach,
                middle.0 + reach,
                middle.1 + reach,
                width,
                height,
            )
        })
        .filter(|window| !window.is_empty())
        .collect();
    Ok(segmenter.wood(image, &windows)?)
}
