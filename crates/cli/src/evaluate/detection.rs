use super::detection_text;
use super::results::{REPORT, Results, json};
use super::worst_sheet::{self, is_sheet, stem};
use crate::detect;
use crate::detector::{BUILT_IN, DetectorSettings, Model, parse_class, parse_model, parse_share};
use crate::output_folder::Staging;
use crate::progress;
use crate::summary::plural;
use crate::terminal::Terminal;
use anyhow::bail;
use clap::Args;
use pomona_cloud::{ColorImage, PixelBox, WarningCode};
use pomona_detect::{ClassChoice, Detection, Detector};
use pomona_labels::{
    DETECTION_SCHEMA, DetectionEvaluation, DetectionOptions, DetectionSource, GroundTruthBox,
    LabelledDataset, MatchedImage, detection_page, evaluate_detections, read_detections,
};
use pomona_view::{BoxKind, BoxMark, ContactSheetImage};
use std::path::{Path, PathBuf};

/// Heading of these options.
const HEADING: &str = "Detection";
const DETECTION: &str = "detection.json";

/// What `--detection` measures.
#[derive(Clone, Debug, Default, Args)]
pub(super) struct DetectionArguments {
    /// Measure detectors on labelled images: a folder of images with YOLO or VOC labels, a COCO file or its folder, a
    /// frame with boxes, or a folder of frames.
    #[arg(long, value_name = "FOLDER", help_heading = HEADING, conflicts_with_all = ["subjects", "methods", "variants", "SettingValues", "calipers"])]
    pub(super) detection: Option<PathBuf>,
    /// A model to measure (ONNX), or `built-in`; may be repeated. Default: built-in, unless --boxes are given.
    #[arg(long = "model", value_name = "FILE", value_parser = parse_model, requires = "detection", help_heading = HEADING)]
    models: Vec<Model>,
    /// Detections of another program in these images: a COCO result list, a COCO file with scores, or a folder with a
    /// YOLO or VOC file for each image; may be repeated.
    #[arg(long, value_name = "FILE|FOLDER", requires = "detection", help_heading = HEADING)]
    boxes: Vec<PathBuf>,
    /// Which class of a model or of a box file is an apple; once for all, or once for each: models first, then boxes.
    #[arg(long = "class", value_name = "NAME|N", value_parser = parse_class, requires = "detection", help_heading = HEADING)]
    classes: Vec<ClassChoice>,
    /// Which class of the labels is an apple. Default: all of them.
    #[arg(long, value_name = "NAME|N", value_parser = parse_class, requires = "detection", help_heading = HEADING)]
    label_class: Option<ClassChoice>,
    /// Ignore the labels of this name or class, such as reference balls; `*` at its end matches anything. May be
    /// repeated.
    #[arg(long, value_name = "NAME", requires = "detection", help_heading = HEADING)]
    ignore_label: Vec<String>,
    /// Score threshold at which recall, precision and false positives are counted.
    #[arg(long, value_name = "SCORE", default_value_t = 0.25, value_parser = parse_share, requires = "detection", help_heading = HEADING)]
    threshold: f64,
    /// Lowest score of a model's boxes: average precision needs those of low score too.
    #[arg(long, value_name = "SCORE", default_value_t = 0.01, value_parser = parse_share, requires = "detection", help_heading = HEADING)]
    lowest_score: f64,
    #[command(flatten)]
    settings: DetectorSettings,
}

/// Measures the detectors on the first `count` images of the data set `labelled`.
pub(super) fn run(
    own: &DetectionArguments,
    labelled: &Path,
    count: Option<usize>,
    seed: u64,
    results: &Results,
    terminal: Terminal,
) -> anyhow::Result<()> {
    let output = results.claim(DETECTION, DETECTION_SCHEMA, is_sheet)?;
    let mut dataset = LabelledDataset::read(labelled, own.label_class.as_ref())?;
    dataset.images.truncate(count.unwrap_or(usize::MAX));
    for name in &own.ignore_label {
        if dataset.ignore(name) == 0 {
            bail!(
                "--ignore-label {name}: no label of {} is named so; check the name",
                dataset.name
            );
        }
    }
    say_what_is_left_out(&dataset, terminal);
    let opened = own.open(&dataset, terminal)?;
    let sources: Vec<DetectionSource<'_>> = opened.iter().map(Opened::source).collect();
    let options = DetectionOptions::new(own.threshold, seed);
    let bar = progress::bar(dataset.images.len());
    let (evaluation, matched) = evaluate_detections(&dataset, &sources, &options, &|| bar.inc(1))?;
    bar.finish_and_clear();
    let files = output.stage()?;
    let sheets = sheets(&dataset, &evaluation, &matched, &files)?;
    files.write_text(DETECTION, &json(&evaluation)?)?;
    files.write_text(REPORT, &detection_page(&evaluation, &sheets)?)?;
    files.publish()?;
    results.print(&evaluation, &detection_text::tables(&evaluation, terminal))
}

/// What is measured, ready to run.
struct Opened {
    name: String,
    what: What,
}

enum What {
    Detector(Box<dyn Detector>),
    Boxes(Vec<Vec<Detection>>),
}

impl Opened {
    fn source(&self) -> DetectionSource<'_> {
        let name = self.name.clone();
        match &self.what {
            What::Detector(detector) => DetectionSource::Detector {
                name,
                detector: &**detector,
            },
            What::Boxes(detections) => DetectionSource::Boxes {
                name,
                detections: detections.clone(),
            },
        }
    }
}

impl DetectionArguments {
    /// How networks are run.
    pub(super) fn settings(&self) -> &DetectorSettings {
        &self.settings
    }

    /// Opens the models and reads the boxes, each under a name of its own.
    fn open(&self, dataset: &LabelledDataset, terminal: Terminal) -> anyhow::Result<Vec<Opened>> {
        let models = match (&*self.models, &*self.boxes) {
            ([], []) => &[Model::BuiltIn][..],
            (models, _) => models,
        };
        let count = models.len() + self.boxes.len();
        if self.classes.len() > 1 && self.classes.len() != count {
            bail!(
                "--class stands {} times for {} with models and boxes; give it once for all, or once for each",
                self.classes.len(),
                plural(count, "source")
            );
        }
        let class_of = |number: usize| {
            self.classes.get(number).or(match &*self.classes {
                [one] => Some(one),
                _ => None,
            })
        };
        let mut opened: Vec<Opened> = Vec::new();
        for (number, model) in models.iter().enumerate() {
            let (name, class) = (model_name(model), class_of(number).cloned());
            // What counts at the threshold has to be there.
            let lowest = self.lowest_score.min(self.threshold);
            let options = self.settings.options(model, class, Some(lowest));
            let detector = options.open()?;
            detect::say(&detector.report(), terminal);
            opened.push(Opened {
                name,
                what: What::Detector(detector),
            });
        }
        for (number, path) in self.boxes.iter().enumerate() {
            let detections = read_detections(path, dataset, class_of(models.len() + number))?;
            let mut all = detections.iter().flatten().peekable();
            if all.peek().is_some() && all.all(|d| d.score == 1.0) {
                terminal.note(&format!(
                    "{}: every box has the score 1; without scores there is one point of the curve only",
                    path.display()
                ));
            }
            opened.push(Opened {
                name: stem(path),
                what: What::Boxes(detections),
            });
        }
        for (number, one) in opened.iter().enumerate() {
            if opened[..number].iter().any(|other| other.name == one.name) {
                bail!(
                    "--model and --boxes: `{}` is given twice; give each once, and files names of their own",
                    one.name
                );
            }
        }
        Ok(opened)
    }
}

fn model_name(model: &Model) -> String {
    match model {
        Model::BuiltIn => BUILT_IN.to_owned(),
        Model::File(path) => stem(path),
    }
}

fn say_what_is_left_out(dataset: &LabelledDataset, terminal: Terminal) {
    let name = &dataset.name;
    // One of each kind is said in full: a data set of photographs may have them by the thousand.
    let mut said: Vec<WarningCode> = Vec::new();
    for (file, warning) in &dataset.warnings {
        if said.contains(&warning.code) {
            continue;
        }
        said.push(warning.code);
        terminal.warn(&file.display().to_string(), warning);
        let same = dataset
            .warnings
            .iter()
            .filter(|(_, other)| other.code == warning.code);
        let more = same.count() - 1;
        if more > 0 {
            let files = plural(more, "more file");
            terminal.note(&format!("{name}: the same of {files}"));
        }
    }
    if dataset.without_label_file > 0 {
        terminal.note(&format!(
            "{name}: {} without a label file, taken for background as YOLO has it",
            plural(dataset.without_label_file, "image")
        ));
    }
    if dataset.frames_without_boxes > 0 {
        terminal.note(&format!(
            "{name}: {} without boxes, left out",
            plural(dataset.frames_without_boxes, "frame")
        ));
    }
    if dataset.classes.len() > 1 {
        terminal.note(&format!(
            "{name}: labels of {} count alike; choose one by --label-class",
            plural(dataset.classes.len(), "class").replace("classs", "classes")
        ));
    }
}

/// Writes the pictures of the worst images of each result; their names, empty where nothing is bad.
fn sheets(
    dataset: &LabelledDataset,
    evaluation: &DetectionEvaluation,
    matched: &[Vec<MatchedImage>],
    output: &Staging<'_>,
) -> anyhow::Result<Vec<String>> {
    let mut names = Vec::new();
    for (number, (result, matched)) in evaluation.results.iter().zip(matched).enumerate() {
        let mut pictures = Vec::new();
        for worst in &result.worst {
            let pairs = dataset.images.iter().zip(matched);
            for (image, matched) in pairs.filter(|(image, _)| image.name == worst.image) {
                pictures.push(ContactSheetImage::new(
                    ColorImage::read(&image.path)?,
                    marks(matched, evaluation.threshold),
                    format!(
                        "-{} +{} {}",
                        worst.missed, worst.false_positives, worst.image
                    ),
                ));
            }
        }
        names.push(worst_sheet::write(&pictures, number + 1, output)?);
    }
    Ok(names)
}

/// True positives in green, missed labels in yellow, false positives in red.
fn marks(matched: &MatchedImage, threshold: f64) -> Vec<BoxMark> {
    let detected = |kind| {
        move |d: Detection| {
            BoxMark::new(d.to_pixel_box(String::new()), kind).captioned(format!("{:.2}", d.score))
        }
    };
    let missed = |label: GroundTruthBox| {
        let [x_min, y_min, x_max, y_max] = label.edges;
        let bounds = PixelBox {
            name: String::new(),
            x_min,
            y_min,
            x_max,
            y_max,
            score: 1.0,
        };
        BoxMark::new(bounds, BoxKind::Missed)
    };
    let true_positives = matched
        .true_positives(threshold)
        .into_iter()
        .map(detected(BoxKind::TruePositive));
    let false_positives = matched
        .false_positives(threshold)
        .into_iter()
        .map(detected(BoxKind::FalsePositive));
    let missed = matched.missed(threshold).into_iter().map(missed);
    true_positives
        .chain(missed)
        .chain(false_positives)
        .collect()
}
