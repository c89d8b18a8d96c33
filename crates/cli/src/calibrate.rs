//! `pomona calibrate`: the camera's transform, from samples.

use crate::output_folder::{OutputFolder, RecordFile};
use crate::terminal::{self, FAINT, GOOD, HEADING, REFUSED, Terminal, one_line};
use anyhow::{anyhow, bail};
use clap::{Args, ValueEnum};
use pomona_calibrate::{
    AngleUnit, Calibration, CalibrationKind, CalibrationRecord, LengthUnit, Options, RECORD_SCHEMA,
    RotationForm, SampleOptions, SampleSet, calibrate,
};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::str::FromStr;

const EXAMPLES: &str = "\
Examples:
  pomona calibrate points.csv --out robot_from_camera.json
  pomona calibrate poses.json --kind eye-to-hand --fruit-distance 0.9 --out robot_from_camera.json
  pomona calibrate poses.json --kind eye-in-hand --out flange_from_camera.json
  pomona pick frames/a --transform robot_from_camera.json --out out

SAMPLES is JSON or CSV, keyed by id, or YAML of MoveIt or easy_handeye: points measured by the camera and touched by the robot, or poses of the flange \
and of a target seen by the camera; docs/calibration.md describes the formats and how to take samples. A report on \
every sample is written beside OUT, with the extension .report.json. Samples that do not determine the answer are \
refused.";

#[derive(Clone, Copy, Debug, ValueEnum)]
enum KindName {
    /// Point pairs, camera fixed to the base.
    Points,
    /// Pose pairs AX = XB, camera fixed to the base, target on the flange.
    EyeToHand,
    /// Pose pairs AX = XB, camera on the flange, target fixed.
    EyeInHand,
    /// Pose pairs AX = ZB, camera fixed to the base, target on the flange.
    RobotWorld,
}

impl KindName {
    fn kind(self) -> CalibrationKind {
        match self {
            Self::Points => CalibrationKind::Points,
            Self::EyeToHand => CalibrationKind::EyeToHand,
            Self::EyeInHand => CalibrationKind::EyeInHand,
            Self::RobotWorld => CalibrationKind::RobotWorld,
        }
    }
}

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct CalibrateArguments {
    /// File of samples: JSON, CSV, or YAML of `MoveIt` or `easy_handeye`.
    #[arg(value_name = "SAMPLES")]
    samples: PathBuf,
    /// What to calibrate. Default: points for points, eye-to-hand for poses.
    #[arg(long, value_enum)]
    kind: Option<KindName>,
    /// Where to write the transform; an existing transform file is replaced.
    #[arg(short, long, value_name = "FILE")]
    out: PathBuf,
    /// Distance from the camera to the fruit, metres, at which the error is reported.
    #[arg(long, value_name = "M", default_value_t = Options::default().fruit_distance_m)]
    fruit_distance: f64,
    /// Largest translation residual of an inlier, millimetres.
    #[arg(long, value_name = "MM", default_value_t = Options::default().translation_tolerance_m * 1e3)]
    tolerance_mm: f64,
    /// Largest rotation residual of an inlier, degrees.
    #[arg(long, value_name = "DEG", default_value_t = 2.0)]
    tolerance_deg: f64,
    /// Seed of the search.
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    /// Id of the robot's base frame, in place of the file's. Default: `base_link`.
    #[arg(long, value_name = "ID")]
    robot_frame: Option<String>,
    /// Id of the camera's frame, in place of the file's. Default: `camera_color_optical_frame`.
    #[arg(long, value_name = "ID")]
    camera_frame: Option<String>,
    /// Id of the flange's frame, in place of the file's. Default: flange.
    #[arg(long, value_name = "ID")]
    flange_frame: Option<String>,
    #[command(flatten)]
    form: FormArguments,
    /// Print the record to standard output as JSON instead of the table.
    #[arg(long)]
    json: bool,
}

/// How a table of samples is written, where its columns do not say it.
#[derive(Debug, Args)]
#[command(next_help_heading = "Form of the samples (CSV)")]
struct FormArguments {
    /// How rotations are written: quaternion-xyzw, quaternion-wxyz, rotation-vector, kuka, rpy, or the axes of three angles:
    /// ZYX about moving axes, xyz about fixed ones.
    #[arg(long, value_name = "FORM", value_parser = RotationForm::from_str)]
    rotations: Option<RotationForm>,
    /// The unit of lengths.
    #[arg(long, value_enum)]
    lengths: Option<Lengths>,
    /// The unit of angles.
    #[arg(long, value_enum)]
    angles: Option<Angles>,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Lengths {
    /// Metres.
    M,
    /// Millimetres.
    Mm,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Angles {
    /// Radians.
    Rad,
    /// Degrees.
    Deg,
}

impl FormArguments {
    fn options(&self) -> SampleOptions {
        let mut options = SampleOptions::default();
        options.rotations = self.rotations;
        options.lengths = self.lengths.map(|unit| match unit {
            Lengths::M => LengthUnit::Metres,
            Lengths::Mm => LengthUnit::Millimetres,
        });
        options.angles = self.angles.map(|unit| match unit {
            Angles::Rad => AngleUnit::Radians,
            Angles::Deg => AngleUnit::Degrees,
        });
        options
    }
}

pub(crate) fn run(arguments: &CalibrateArguments, terminal: Terminal) -> anyhow::Result<()> {
    let files = Files::claim(&arguments.out)?;
    let mut set = SampleSet::read_with(&arguments.samples, &arguments.form.options())?;
    for (given, id) in [
        (&arguments.robot_frame, &mut set.frames.robot),
        (&arguments.camera_frame, &mut set.frames.camera),
        (&arguments.flange_frame, &mut set.frames.flange),
    ] {
        if given.is_some() {
            id.clone_from(given);
        }
    }
    let mut options = Options::default();
    options.fruit_distance_m = arguments.fruit_distance;
    options.translation_tolerance_m = arguments.tolerance_mm * 1e-3;
    options.rotation_tolerance_rad = arguments.tolerance_deg.to_radians();
    let kind = arguments
        .kind
        .map_or_else(|| CalibrationKind::of(&set.samples), KindName::kind);
    let outcome = calibrate(&set, kind, &options, arguments.seed)
        .map_err(|e| anyhow!("{}: {e}", arguments.samples.display()))?;
    let json = serde_json::to_string_pretty(&outcome.record)? + "\n";
    files.write(&outcome, &json)?;
    for warning in &outcome.record.quality.warnings {
        terminal.warn("calibration", warning);
    }
    if arguments.json {
        return terminal::print(&json);
    }
    let text = table(&outcome.record, terminal);
    terminal::print(&format!(
        "{text}\nwritten to {} and {}\n",
        arguments.out.display(),
        arguments.out.with_file_name(&files.report).display()
    ))
}

/// The transform's file and its report, in one folder.
struct Files {
    folder: OutputFolder,
    transform: String,
    report: String,
}

impl Files {
    /// Claims `robot_from_camera.json` and `robot_from_camera.report.json`.
    fn claim(out: &Path) -> anyhow::Result<Self> {
        let Some(name) = out.file_name().filter(|_| !out.is_dir()) else {
            bail!("{}: is a folder; name a file by --out", out.display());
        };
        let parent = out.parent().unwrap_or(Path::new(""));
        if !parent.as_os_str().is_empty() && !parent.is_dir() {
            bail!(
                "{}: cannot be written: there is no folder {}; make it, or name another by --out",
                out.display(),
                parent.display()
            );
        }
        let stem = out.file_stem().unwrap_or_default().to_string_lossy();
        let (transform, report) = (
            name.to_string_lossy().into_owned(),
            format!("{stem}.report.json"),
        );
        let records = [
            RecordFile {
                name: &transform,
                schema: pomona_transforms::SCHEMA,
            },
            RecordFile {
                name: &report,
                schema: RECORD_SCHEMA,
            },
        ];
        let folder = OutputFolder::claim(parent, &records, |_| false)?;
        Ok(Self {
            folder,
            transform,
            report,
        })
    }

    /// Writes both, or neither.
    fn write(&self, outcome: &Calibration, report: &str) -> anyhow::Result<()> {
        let files = self.folder.stage()?;
        outcome.camera.write(files.file(&self.transform))?;
        files.write_text(&self.report, report)?;
        files.publish()
    }
}

fn table(record: &CalibrationRecord, terminal: Terminal) -> String {
    let quality = &record.quality;
    let has_rotation = quality.noise_rotation_rad.is_some();
    let mut text = String::new();
    let camera = &record.camera;
    let title = format!(
        "{} from {}: {}, {} samples",
        one_line(&camera.to),
        one_line(&camera.from),
        record.kind.name(),
        quality.samples.len()
    );
    text += &(terminal.paint(HEADING, &title) + "\n");
    let width = quality
        .samples
        .iter()
        .map(|s| one_line(&s.id).chars().count())
        .chain([2])
        .max()
        .unwrap_or(2);
    let mut header = format!("{:<width$}  {:>8}", "id", "off mm");
    if has_rotation {
        header += "  off deg";
    }
    header += "   sigmas  left out mm  shift at fruit mm";
    text += &(terminal.paint(FAINT, &header) + "\n");
    for sample in &quality.samples {
        let _ = write!(
            text,
            "{:<width$}  {:>8.2}",
            one_line(&sample.id),
            sample.translation_m * 1e3
        );
        if let Some(rotation) = sample.rotation_rad {
            let _ = write!(text, "  {:>7.3}", rotation.to_degrees());
        }
        let _ = write!(text, "  {:>7.1}  ", sample.sigmas);
        match (&sample.rejected, &sample.left_out) {
            (Some(rejected), _) => text += &terminal.paint(REFUSED, &rejected.reason),
            (None, Some(left)) => {
                let _ = write!(
                    text,
                    "{:>11.2}  {:>17.2}",
                    left.translation_m * 1e3,
                    left.shift_at_fruit_m * 1e3
                );
            }
            (None, None) => text += "          -                  -",
        }
        text.push('\n');
    }
    text.push('\n');
    text += &summary(record, terminal);
    text
}

fn summary(record: &CalibrationRecord, terminal: Terminal) -> String {
    let (camera, quality) = (&record.camera, &record.quality);
    let list = |numbers: &[f64], digits: usize| {
        let numbers = numbers.iter().map(|n| format!("{n:.digits$}"));
        numbers.collect::<Vec<_>>().join(" ")
    };
    let mm = |m: &[f64; 3]| m.map(|c| c * 1e3);
    let mut text = format!(
        "translation mm   {}  (sd {})\nquaternion xyzw  {}  (sd deg {})\n",
        list(&mm(&camera.translation_m), 2),
        list(&mm(&camera.sigma_translation_m), 2),
        list(&camera.quaternion_xyzw, 6),
        list(&camera.sigma_rotation_rad.map(f64::to_degrees), 3)
    );
    let rotation = quality.noise_rotation_rad.map_or_else(String::new, |r| {
        format!(" and {:.3} degrees", r.to_degrees())
    });
    let _ = writeln!(
        text,
        "noise            {:.2} mm{rotation} in each component",
        quality.noise_translation_m * 1e3
    );
    let fruit = format!(
        "error at {:.2} m  {:.2} mm (sd from the covariance), {:.2} mm (leaving one out; largest {:.2})",
        quality.fruit_distance_m,
        quality.sigma_at_fruit_m * 1e3,
        quality.leave_one_out.sigma_at_fruit_m * 1e3,
        quality.leave_one_out.largest_shift_at_fruit_m * 1e3
    );
    text + &terminal.paint(GOOD, &fruit) + "\n"
}
