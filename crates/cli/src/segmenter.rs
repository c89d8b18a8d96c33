use crate::detector::{BUILT_IN, Model, parse_model, parse_runtime, parse_tiles, say_assumptions};
use clap::Args;
use pomona_segment::{
    RuntimeChoice, SegmentError, Segmenter, SegmenterOptions, SegmenterReport, TilingChoice,
};

/// Heading of these options.
const HEADING: &str = "Segmenter";

/// Which segmenter tells wood in a colour image.
#[derive(Clone, Debug, Args)]
pub(crate) struct SegmenterArguments {
    /// Segmentation model (ONNX; MODEL.toml beside it may describe it), or `built-in`.
    #[arg(long, value_name = "FILE", default_value = BUILT_IN, value_parser = parse_model, help_heading = HEADING)]
    model: Model,
    /// Inference backend: auto (ONNX Runtime where it is found, else the embedded one), onnxruntime, embedded, or the
    /// path of an ONNX Runtime library.
    #[arg(long, value_name = "NAME|PATH", default_value = "auto", value_parser = parse_runtime, help_heading = HEADING)]
    runtime: RuntimeChoice,
    /// How a large image is tiled: auto, whole, or columns and rows such as 3x2.
    #[arg(long, value_name = "TILES", default_value = "auto", value_parser = parse_tiles, help_heading = HEADING)]
    tiles: TilingChoice,
    /// Scales at which the image is looked at, separated by commas; the result is the mean. At 2 thin twigs are seen
    /// enlarged, in four times as many tiles.
    #[arg(long, value_name = "ZOOM", value_delimiter = ',', default_value = "1", help_heading = HEADING)]
    zoom: Vec<f64>,
}

impl SegmenterArguments {
    /// Opens the segmenter.
    pub(crate) fn open(&self) -> Result<Box<dyn Segmenter>, SegmentError> {
        open(&self.model, &self.runtime, self.tiles, &self.zoom)
    }
}

/// Opens `model`, run by this backend over these tiles at these zooms.
pub(crate) fn open(
    model: &Model,
    runtime: &RuntimeChoice,
    tiles: TilingChoice,
    zooms: &[f64],
) -> Result<Box<dyn Segmenter>, SegmentError> {
    let mut options = options(model, runtime, tiles);
    options.zooms = zooms.to_vec();
    options.open()
}

/// How `model` is run by this backend over these tiles.
pub(crate) fn options(
    model: &Model,
    runtime: &RuntimeChoice,
    tiles: TilingChoice,
) -> SegmenterOptions {
    let mut options = SegmenterOptions::of_model(match model {
        Model::BuiltIn => None,
        Model::File(path) => Some(path.clone()),
    });
    (options.runtime, options.tiling) = (runtime.clone(), tiles);
    options
}

/// Says what was assumed about the model, and with -v why a runtime did not serve.
pub(crate) fn say(report: &SegmenterReport, terminal: crate::terminal::Terminal) {
    let runtime = report.runtime.as_ref();
    say_assumptions(&report.name, &report.notes, runtime, terminal);
}
