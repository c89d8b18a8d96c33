use crate::terminal::Terminal;
use clap::Args;
use pomona_cloud::BoxChoice;
use pomona_detect::{
    ClassChoice, DetectError, Detector, DetectorOptions, RuntimeChoice, RuntimeReport, TilingChoice,
};
use std::path::PathBuf;

/// What `--model` calls the bundled model.
pub(crate) const BUILT_IN: &str = "built-in";

/// Heading of these options.
const HEADING: &str = "Detector";

/// Which detector finds the apples of a colour image, for each command that needs one.
#[derive(Clone, Debug, Args)]
pub(crate) struct DetectorArguments {
    /// Detection model (ONNX; MODEL.toml beside it may describe it), or `built-in`.
    /// Default: built-in.
    #[arg(long, value_name = "FILE", value_parser = parse_model, help_heading = HEADING)]
    model: Option<Model>,
    /// Which class is an apple, by name or number, of the model or of a box file. Default: from the model's
    /// description, else what is an apple by its name.
    #[arg(long, value_name = "NAME|N", value_parser = parse_class, help_heading = HEADING)]
    class: Option<ClassChoice>,
    /// Lowest score of a box, 0 to 1. Default: by the model's description, else 0.25; 0 for boxes of a file.
    #[arg(long, value_name = "SCORE", value_parser = parse_share, help_heading = HEADING)]
    threshold: Option<f64>,
    #[command(flatten)]
    settings: DetectorSettings,
}

/// How detectors run, whichever they are.
#[derive(Clone, Debug, Default, Args)]
pub(crate) struct DetectorSettings {
    /// Inference backend: auto (ONNX Runtime where it is found, else the embedded one), onnxruntime, embedded, or the
    /// path of an ONNX Runtime library.
    #[arg(long, value_name = "NAME|PATH", default_value = "auto", value_parser = parse_runtime, help_heading = HEADING)]
    runtime: RuntimeChoice,
    /// Intersection over union above which of two boxes only the better one is kept, 0 to 1. Default: by the model's
    /// description, else 0.45.
    #[arg(long, value_name = "IOU", value_parser = parse_share, help_heading = HEADING)]
    nms_iou: Option<f64>,
    /// How a large image is tiled: auto, whole, or columns and rows such as 3x2.
    #[arg(long, value_name = "TILES", default_value = "auto", value_parser = parse_tiles, help_heading = HEADING)]
    tiles: TilingChoice,
}

/// A model as the command line names it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Model {
    /// The bundled one.
    BuiltIn,
    /// This file.
    File(PathBuf),
}

impl DetectorArguments {
    /// The inference backend.
    pub(crate) fn runtime(&self) -> &RuntimeChoice {
        self.settings.runtime()
    }

    /// Opens the detector.
    pub(crate) fn open(&self) -> Result<Box<dyn Detector>, DetectError> {
        self.settings
            .options(self.model(), self.class.clone(), self.threshold)
            .open()
    }

    fn model(&self) -> &Model {
        self.model.as_ref().unwrap_or(&Model::BuiltIn)
    }

    /// Which boxes of a file are taken where no detector runs.
    pub(crate) fn box_choice(&self) -> BoxChoice {
        BoxChoice::default().with(|choice| {
            choice.class.clone_from(&self.class);
            choice.min_score = self.threshold.unwrap_or(0.0);
        })
    }

    /// An option that was given and says nothing where no detector runs; `--runtime` is none where a segmenter does.
    pub(crate) fn of_detector_alone(&self, segmenter_runs: bool) -> Option<&'static str> {
        let default = DetectorSettings::default();
        let given = [
            (self.model.is_some(), "--model"),
            (self.settings.nms_iou.is_some(), "--nms-iou"),
            (self.settings.tiles != default.tiles, "--tiles"),
            (
                !segmenter_runs && self.settings.runtime != default.runtime,
                "--runtime",
            ),
        ];
        given
            .into_iter()
            .find(|(is_given, _)| *is_given)
            .map(|(_, name)| name)
    }
}

impl DetectorSettings {
    /// The inference backend.
    pub(crate) fn runtime(&self) -> &RuntimeChoice {
        &self.runtime
    }

    /// How a large image is tiled.
    pub(crate) fn tiles(&self) -> TilingChoice {
        self.tiles
    }

    /// How to open `model` under these settings.
    pub(crate) fn options(
        &self,
        model: &Model,
        class: Option<ClassChoice>,
        threshold: Option<f64>,
    ) -> DetectorOptions {
        DetectorOptions::default().with(|o| {
            o.model = match model {
                Model::BuiltIn => None,
                Model::File(path) => Some(path.clone()),
            };
            o.runtime = self.runtime.clone();
            o.class = class;
            o.threshold = threshold;
            o.nms_iou = self.nms_iou;
            o.tiling = self.tiles;
        })
    }
}

/// Says what was assumed about a model, and with -v why an inference backend did not serve.
pub(crate) fn say_assumptions(
    model: &str,
    notes: &[String],
    runtime: Option<&RuntimeReport>,
    terminal: Terminal,
) {
    for note in notes {
        terminal.note(&format!("{model}: {note}"));
    }
    if let Some(reason) = runtime.and_then(|r| r.fallback_reason.as_ref()) {
        log::info!("{reason}");
    }
}

/// `built-in` or a file.
pub(crate) fn parse_model(text: &str) -> Result<Model, String> {
    match text {
        "" => Err("empty; give an ONNX file, or built-in".to_owned()),
        BUILT_IN => Ok(Model::BuiltIn),
        path => Ok(Model::File(path.into())),
    }
}

/// A class by its number or its name.
pub(crate) fn parse_class(text: &str) -> Result<ClassChoice, String> {
    if text.trim().is_empty() {
        return Err("empty; give a class's name or number".to_owned());
    }
    Ok(match text.parse() {
        Ok(number) => ClassChoice::Number(number),
        Err(_) => ClassChoice::Name(text.to_owned()),
    })
}

/// A number from 0 to 1.
pub(crate) fn parse_share(text: &str) -> Result<f64, String> {
    text.parse()
        .ok()
        .filter(|value| (0.0..=1.0).contains(value))
        .ok_or_else(|| "give a number from 0 to 1".to_owned())
}

pub(crate) fn parse_runtime(text: &str) -> Result<RuntimeChoice, String> {
    match text {
        "auto" => Ok(RuntimeChoice::Automatic),
        "onnxruntime" => Ok(RuntimeChoice::OnnxRuntime),
        "embedded" => Ok(RuntimeChoice::Embedded),
        // A word that is none of these is a slip rather than a file.
        path if path.contains(['/', '\\', '.']) => Ok(RuntimeChoice::Library(path.into())),
        _ => Err("give auto, onnxruntime, embedded, or the path of a library".to_owned()),
    }
}

pub(crate) fn parse_tiles(text: &str) -> Result<TilingChoice, String> {
    const MOST: usize = TilingChoice::LARGEST_GRID;
    let side = |text: &str| text.parse().ok().filter(|n| (1..=MOST).contains(n));
    match text {
        "auto" => Ok(TilingChoice::Automatic),
        "whole" => Ok(TilingChoice::Whole),
        grid => grid
            .split_once(['x', 'X'])
            .and_then(|(columns, rows)| {
                Some(TilingChoice::Grid {
                    columns: side(columns)?,
                    rows: side(rows)?,
                })
            })
            .ok_or_else(|| {
                format!("give auto, whole, or columns and rows from 1 to {MOST} such as 3x2")
            }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    #[derive(Parser)]
    struct Line {
        #[command(flatten)]
        detector: DetectorArguments,
    }

    fn options(arguments: &[&str]) -> Result<DetectorOptions, String> {
        let line = Line::try_parse_from([&["x"], arguments].concat()).map_err(|e| e.to_string())?;
        let detector = line.detector;
        let (class, threshold) = (detector.class.clone(), detector.threshold);
        Ok(detector
            .settings
            .options(detector.model(), class, threshold))
    }

    #[test]
    fn nothing_said_is_the_default() {
        assert_eq!(options(&[]).unwrap(), DetectorOptions::default());
        let named = options(&[
            "--model",
            "built-in",
            "--runtime",
            "auto",
            "--tiles",
            "auto",
        ]);
        assert_eq!(named.unwrap(), DetectorOptions::default());
    }

    #[test]
    fn each_choice_arrives() {
        let line = "--model m.onnx --runtime ./libonnxruntime.so --class 47 --threshold 0.3 --nms-iou 0.45 --tiles 3x2";
        let line: Vec<&str> = line.split(' ').collect();
        let expected = DetectorOptions::default().with(|o| {
            o.model = Some("m.onnx".into());
            o.runtime = RuntimeChoice::Library("./libonnxruntime.so".into());
            o.class = Some(ClassChoice::Number(47));
            o.threshold = Some(0.3);
            o.nms_iou = Some(0.45);
            o.tiling = TilingChoice::Grid {
                columns: 3,
                rows: 2,
            };
        });
        assert_eq!(options(&line).unwrap(), expected);
        let named = options(&["--class", "apple", "--runtime", "embedded"]).unwrap();
        assert_eq!(named.class, Some(ClassChoice::Name("apple".to_owned())));
        assert_eq!(named.runtime, RuntimeChoice::Embedded);
    }

    #[test]
    fn slips_are_refused() {
        for (name, value) in [
            ("--runtime", "onnx"),
            ("--tiles", "3"),
            ("--tiles", "0x2"),
            ("--tiles", "999x2"),
            ("--threshold", "1.5"),
            ("--threshold", "NaN"),
            ("--nms-iou", "-1"),
            ("--class", ""),
            ("--model", ""),
        ] {
            let given = format!("{name}={value}");
            let refused = options(&[&given]).unwrap_err();
            assert!(refused.contains(name), "{given}: {refused}");
        }
    }
}
