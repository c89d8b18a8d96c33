//! What the command line says.

use super::detection::DetectionArguments;
use super::real_arguments::RealArguments;
use super::results::Results;
use super::robot::RobotArguments;
use super::segmentation::SegmentationArguments;
use crate::settings::SettingValues;
use clap::Args;
use clap::builder::PossibleValuesParser;
use pomona::Method;
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  pomona evaluate lab150 --out out                    the paper's fifteen orientations, ten noise draws each
  pomona evaluate lab15 frames/a --out out            suites and frames with truth.json
  pomona evaluate orchard@1000 --method paper --method robust --out out
                                                      other scenes: seeds 1000, 1001, ...
  pomona evaluate orchard --count 50 --json --out out | jq '.results[].angle.error.mean'
  pomona evaluate orchard --set robust.blocks=12 --out out
  pomona evaluate orchard --robot --out out           the gripper in the base frame, after a simulated calibration
  pomona evaluate --calipers calipers.csv frames/a frames/b --out out
  pomona evaluate --detection tiles --out out         the built-in model on images with labels
  pomona evaluate --detection tiles --model built-in --model mine.onnx --boxes theirs.json --out out
                                                      several in one run, compared in pairs
  pomona evaluate --segmentation tiles --strokes strokes.txt --out out
                                                      wood of the built-in model on strokes drawn by eye
  pomona evaluate --real frames/a frames/b --strokes strokes.txt --out out
                                                      directions on real frames against such strokes

Writes evaluation.json, apples.csv and report.html into DIR; with --calipers calipers.json and report.html; with \
--detection detection.json, report.html and a sheet of each detector's worst images, worst-N.png; with --segmentation \
segmentation.json and the same; with --real real.json, real.csv and report.html.
A frame without ground truth can be evaluated with --calipers, a CSV with the columns box_name and diameter_mm, and with \
--real, strokes of the wood that a person sees.";

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct EvaluateArguments {
    /// Suites (see `pomona scenes --list`), SUITE@N for scenes from seed N on, frames with truth.json, or
    /// folders of such frames; with --calipers and --real any frames.
    #[arg(required_unless_present_any = ["detection", "segmentation"], value_name = "SUITE|FRAME")]
    pub(super) subjects: Vec<String>,
    #[command(flatten)]
    pub(super) results: Results,
    /// A method; may be repeated to compare methods under the same settings. Default: the method of the settings.
    #[arg(long = "method", value_name = "NAME", value_parser = PossibleValuesParser::new(Method::ALL.map(Method::name)))]
    pub(super) methods: Vec<String>,
    /// Further settings to compare with the methods: a TOML file, named in the result by its file name without
    /// extension; may be repeated. The options under Settings do not change it.
    #[arg(long = "variant", value_name = "FILE")]
    pub(super) variants: Vec<PathBuf>,
    /// Seed of the methods, or of the intervals with --detection and --segmentation; scenes have their own seeds.
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(super) seed: u64,
    /// Only the first N frames of each suite, or images with --detection and --segmentation.
    #[arg(long, value_name = "N")]
    pub(super) count: Option<usize>,
    /// Measured diameters (CSV), by box name: compares fitted radii with them, and the centres of each pair of frames.
    #[arg(long, value_name = "FILE", conflicts_with = "count")]
    pub(super) calipers: Option<PathBuf>,
    #[command(flatten)]
    pub(super) robot: RobotArguments,
    #[command(flatten)]
    pub(super) real: RealArguments,
    #[command(flatten)]
    pub(super) detection: DetectionArguments,
    #[command(flatten)]
    pub(super) segmentation: SegmentationArguments,
    #[command(flatten)]
    pub(super) settings: SettingValues,
}
