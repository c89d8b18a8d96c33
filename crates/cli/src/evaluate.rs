//! `pomona evaluate`: methods against truth, fitted radii against calipers, and detectors against labels.

mod detection;
mod detection_text;
mod text;

use crate::output_folder::{OutputFolder, RecordFile};
use crate::pick::PICKS;
use crate::progress;
use crate::settings::SettingValues;
use crate::terminal::{self, Terminal};
use anyhow::{anyhow, bail};
use clap::Args;
use clap::builder::PossibleValuesParser;
use pomona::{
    ApproachConfig, CheckedFrame, Config, FrameAnswer, Method, PickError, Picker, Robot,
    RobotFromCamera,
};
use pomona_cloud::Frame;
use pomona_evaluate::{
    CALIPER_SCHEMA, CalibrationNoise, PickMethod, RobotTrial, SCHEMA, Subject, apples_csv,
    caliper_page, evaluate, evaluate_with_robot, measure_calipers, read_calipers, report_page,
};
use serde::Serialize;
use std::path::{Path, PathBuf};

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

Writes evaluation.json, apples.csv and report.html into DIR; with --calipers calipers.json and report.html; with \
--detection detection.json, report.html and a sheet of each detector's worst images, worst-N.png.
A frame without ground truth can only be evaluated with --calipers: a CSV with the columns box_name and diameter_mm.";

/// The results, by their names in the folder.
const EVALUATION: &str = "evaluation.json";
const CALIPERS: &str = "calipers.json";
const APPLES: &str = "apples.csv";
const DETECTION: &str = "detection.json";
const REPORT: &str = "report.html";

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct EvaluateArguments {
    /// Suites (see `pomona scenes --list`), SUITE@N for scenes from seed N on, frames with truth.json, or
    /// folders of such frames; with --calipers any frames.
    #[arg(required_unless_present = "detection", value_name = "SUITE|FRAME")]
    subjects: Vec<String>,
    /// Output folder. Files of earlier runs are replaced.
    #[arg(short, long, value_name = "DIR")]
    out: PathBuf,
    /// A method; may be repeated to compare methods. Default: that of the settings.
    #[arg(long = "method", value_name = "NAME", value_parser = PossibleValuesParser::new(Method::ALL.map(Method::name)))]
    methods: Vec<String>,
    /// Further settings to compare with the methods: a TOML file, named in the result by its file name without
    /// extension; may be repeated.
    #[arg(long = "variant", value_name = "FILE")]
    variants: Vec<PathBuf>,
    /// Seed of the methods, or of the intervals with --detection; scenes have their own seeds.
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    /// Only the first N frames of each suite, or images with --detection.
    #[arg(long, value_name = "N")]
    count: Option<usize>,
    /// Measured diameters (CSV), by box name: compares fitted radii with them, and the centres of each pair of frames.
    #[arg(long, value_name = "FILE", conflicts_with = "count")]
    calipers: Option<PathBuf>,
    /// Simulate a robot: for each frame a camera is mounted on it and calibrated from noisy samples, the picks are
    /// planned, and the gripper is compared with the ground truth in the base frame. With =FILE, the settings of a
    /// robot (see `pomona config --robot`).
    #[arg(long, value_name = "FILE", num_args = 0..=1, require_equals = true, conflicts_with = "calipers")]
    #[allow(
        clippy::option_option,
        reason = "an option whose value may be left out, as clap has it"
    )]
    robot: Option<Option<PathBuf>>,
    /// Rotation noise of the calibration samples, root mean square of the angle.
    #[arg(long, value_name = "DEG", default_value_t = 0.2, requires = "robot")]
    calibration_noise_deg: f64,
    /// Translation noise of the calibration samples, root mean square of the length.
    #[arg(long, value_name = "MM", default_value_t = 1.0, requires = "robot")]
    calibration_noise_mm: f64,
    /// Number of calibration samples.
    #[arg(long, value_name = "N", default_value_t = 15, requires = "robot")]
    calibration_poses: usize,
    /// Print the result to standard output as JSON instead of the table.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    detection: detection::DetectionArguments,
    #[command(flatten)]
    settings: SettingValues,
}

pub(crate) fn run(arguments: &EvaluateArguments, terminal: Terminal) -> anyhow::Result<()> {
    if let Some(labelled) = &arguments.detection.detection {
        return detection::run(arguments, labelled, terminal);
    }
    let pickers = pickers(arguments)?;
    let methods: Vec<&dyn PickMethod> = pickers.iter().map(|p| p as &dyn PickMethod).collect();
    match &arguments.calipers {
        Some(calipers) => against_calipers(arguments, calipers, &methods, terminal),
        None => against_truth(arguments, &methods, terminal),
    }
}

/// A method under its settings, and the name that it bears in the result.
struct Named {
    name: String,
    picker: Picker,
}

impl PickMethod for Named {
    fn name(&self) -> &str {
        &self.name
    }

    fn answer(&self, frame: &CheckedFrame<'_>, seed: u64) -> Result<FrameAnswer, PickError> {
        self.picker.answer(frame, seed)
    }

    fn answer_for_robot(
        &self,
        frame: &CheckedFrame<'_>,
        seed: u64,
        robot_from_camera: &RobotFromCamera,
    ) -> Result<FrameAnswer, PickError> {
        self.picker.answer_for_robot(frame, seed, robot_from_camera)
    }
}

/// The robot that is asked for.
fn trial(arguments: &EvaluateArguments) -> anyhow::Result<Option<RobotTrial>> {
    let config = match &arguments.robot {
        None => return Ok(None),
        Some(None) => ApproachConfig::default(),
        Some(Some(path)) => ApproachConfig::read(path)?,
    };
    Ok(Some(RobotTrial {
        robot: Robot::new(config)?,
        noise: CalibrationNoise {
            poses: arguments.calibration_poses,
            rotation_rad: arguments.calibration_noise_deg.to_radians(),
            translation_m: arguments.calibration_noise_mm / 1e3,
        },
    }))
}

/// The methods that are asked for, and after them the variants.
fn pickers(arguments: &EvaluateArguments) -> anyhow::Result<Vec<Named>> {
    let mut named: Vec<Named> = methods(arguments)?
        .into_iter()
        .map(|picker| Named {
            name: picker.name().to_owned(),
            picker,
        })
        .collect();
    for path in &arguments.variants {
        let stem = path.file_stem().unwrap_or_default();
        let name = stem.to_string_lossy().into_owned();
        if named.iter().any(|other| other.name == name) {
            bail!(
                "--variant {}: `{name}` is given twice; rename the file",
                path.display()
            );
        }
        let picker = Picker::new(Config::read(path)?)?;
        named.push(Named { name, picker });
    }
    Ok(named)
}

fn methods(arguments: &EvaluateArguments) -> anyhow::Result<Vec<Picker>> {
    let config = arguments.settings.config()?;
    if arguments.methods.is_empty() {
        return Ok(vec![Picker::new(config)?]);
    }
    let mut pickers: Vec<Picker> = Vec::new();
    for name in &arguments.methods {
        let method = Method::from_name(name)
            .ok_or_else(|| anyhow!("--method {name}: there is no such method"))?;
        if pickers.iter().any(|p| p.config().method == method) {
            bail!("--method {name} is given twice; give each method once");
        }
        pickers.push(Picker::new(Config {
            method,
            ..config.clone()
        })?);
    }
    Ok(pickers)
}

fn against_truth(
    arguments: &EvaluateArguments,
    methods: &[&dyn PickMethod],
    terminal: Terminal,
) -> anyhow::Result<()> {
    let output = claim(&arguments.out, EVALUATION, SCHEMA, |n| n == APPLES)?;
    let trial = trial(arguments)?;
    let mut subjects: Vec<Subject> = Vec::new();
    for name in &arguments.subjects {
        for subject in Subject::named(name, arguments.count)? {
            let twice =
                |other: &Subject| (&other.suite, &other.name) == (&subject.suite, &subject.name);
            if subjects.iter().any(twice) {
                bail!(
                    "{name}: {} of {} is given twice; give each suite and folder once",
                    subject.name,
                    subject.suite
                );
            }
            subjects.push(subject);
        }
    }
    let bar = progress::bar(subjects.len());
    let (seed, done) = (arguments.seed, || bar.inc(1));
    let evaluation = match &trial {
        Some(trial) => evaluate_with_robot(&subjects, methods, seed, trial, &done)?,
        None => evaluate(&subjects, methods, seed, &done)?,
    };
    bar.finish_and_clear();
    let files = output.stage()?;
    files.write_text(EVALUATION, &json(&evaluation)?)?;
    files.write_text(APPLES, &apples_csv(&evaluation)?)?;
    files.write_text(REPORT, &report_page(&evaluation)?)?;
    files.publish()?;
    say(
        arguments,
        &evaluation,
        &text::evaluation(&evaluation, terminal),
    )
}

fn against_calipers(
    arguments: &EvaluateArguments,
    calipers: &Path,
    methods: &[&dyn PickMethod],
    terminal: Terminal,
) -> anyhow::Result<()> {
    let output = claim(&arguments.out, CALIPERS, CALIPER_SCHEMA, |_| false)?;
    let calipers = read_calipers(calipers)?;
    let frames: Vec<Frame> = arguments
        .subjects
        .iter()
        .map(Frame::read)
        .collect::<Result<_, _>>()?;
    let report = measure_calipers(&frames, &calipers, methods, arguments.seed)?;
    let files = output.stage()?;
    files.write_text(CALIPERS, &json(&report)?)?;
    files.write_text(REPORT, &caliper_page(&report)?)?;
    files.publish()?;
    say(arguments, &report, &text::calipers(&report, terminal))
}

fn json(result: &impl Serialize) -> serde_json::Result<String> {
    Ok(serde_json::to_string_pretty(result)? + "\n")
}

fn say(arguments: &EvaluateArguments, result: &impl Serialize, text: &str) -> anyhow::Result<()> {
    if arguments.json {
        return terminal::print(&json(result)?);
    }
    let place = arguments.out.display();
    terminal::print(&format!("{text}\nwritten to {place}\n"))
}

/// Claims the names of an evaluation's record and its page, and those that `writes` knows.
fn claim(
    folder: &Path,
    record: &str,
    schema: &str,
    writes: impl Fn(&str) -> bool,
) -> anyhow::Result<OutputFolder> {
    if folder.join(PICKS).exists() {
        bail!(
            "{}: holds the answers of `pomona pick`; name another folder by --out",
            folder.display()
        );
    }
    let record = RecordFile {
        name: record,
        schema,
    };
    OutputFolder::claim(folder, &[record], |name| name == REPORT || writes(name))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn arguments(methods: &[&str]) -> EvaluateArguments {
        EvaluateArguments {
            subjects: vec!["lab15".to_owned()],
            out: PathBuf::new(),
            methods: methods.iter().map(ToString::to_string).collect(),
            variants: Vec::new(),
            seed: 0,
            count: Some(1),
            calipers: None,
            robot: None,
            calibration_noise_deg: 0.2,
            calibration_noise_mm: 1.0,
            calibration_poses: 15,
            json: false,
            detection: detection::DetectionArguments::default(),
            settings: SettingValues::default(),
        }
    }

    #[test]
    fn each_method_once_and_by_its_name() {
        assert_eq!(pickers(&arguments(&[])).unwrap().len(), 1);
        assert_eq!(pickers(&arguments(&["paper"])).unwrap()[0].name, "paper");
        let Err(twice) = pickers(&arguments(&["paper", "paper"])) else {
            panic!("one method twice");
        };
        assert!(twice.to_string().contains("twice"));
    }

    #[test]
    fn a_variant_bears_the_name_of_its_file() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("no-box.toml");
        std::fs::write(&path, "method = \"robust\"\n[robust]\nbox_weight = 0.0\n").unwrap();
        let mut arguments = arguments(&["robust"]);
        arguments.variants = vec![path.clone()];
        let named = pickers(&arguments).unwrap();
        let names: Vec<&str> = named.iter().map(PickMethod::name).collect();
        assert_eq!(names, ["robust", "no-box"]);
        assert_eq!(named[1].picker.config().robust.box_weight, 0.0);
        arguments.variants.push(path);
        let Err(twice) = pickers(&arguments) else {
            panic!("one name twice");
        };
        assert!(twice.to_string().contains("no-box"));
    }

    #[test]
    fn a_run_writes_its_files_and_may_be_repeated() {
        let dir = tempfile::tempdir().unwrap();
        let mut arguments = arguments(&["paper"]);
        arguments.out = dir.path().join("out");
        arguments.json = true;
        let terminal = Terminal::new(clap::ColorChoice::Never);
        run(&arguments, terminal).unwrap();
        run(&arguments, terminal).unwrap();
        for name in [EVALUATION, APPLES, REPORT] {
            assert!(arguments.out.join(name).is_file(), "{name}");
        }
        arguments.out = dir.path().join("picks");
        std::fs::create_dir(&arguments.out).unwrap();
        std::fs::write(arguments.out.join(PICKS), "{}").unwrap();
        let refused = run(&arguments, terminal).unwrap_err().to_string();
        assert!(
            refused.contains("picks") && refused.contains("--out"),
            "{refused}"
        );
    }

    #[test]
    fn a_robot_is_measured_in_the_base_and_bad_noise_refused() {
        let dir = tempfile::tempdir().unwrap();
        let mut arguments = arguments(&["robust"]);
        arguments.out = dir.path().join("out");
        arguments.robot = Some(None);
        let terminal = Terminal::new(clap::ColorChoice::Never);
        run(&arguments, terminal).unwrap();
        let text = std::fs::read_to_string(arguments.out.join(EVALUATION)).unwrap();
        let evaluation: pomona_evaluate::Evaluation = serde_json::from_str(&text).unwrap();
        let page = text::evaluation(&evaluation, terminal);
        assert!(
            page.contains("sphere center") && page.contains("NEES"),
            "{page}"
        );
        arguments.calibration_noise_mm = -1.0;
        let refused = run(&arguments, terminal).unwrap_err().to_string();
        assert!(refused.contains("-0.001"), "{refused}");
    }

    #[test]
    fn what_is_no_subject_is_refused_with_the_suites() {
        let mut arguments = arguments(&[]);
        arguments.subjects = vec!["lab16".to_owned()];
        let terminal = Terminal::new(clap::ColorChoice::Never);
        let refused = run(&arguments, terminal).unwrap_err().to_string();
        assert!(
            refused.contains("lab16") && refused.contains("lab150"),
            "{refused}"
        );
    }
}
