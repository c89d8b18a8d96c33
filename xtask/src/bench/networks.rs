//! Networks in both runtimes, beside each other in the same rounds; see `crates/detect/examples/network_bench/` and
//! `crates/segment/examples/segment_bench.rs`.

use super::interval::median;
use crate::workspace::{Workspace, cargo, root};
use anyhow::{Context, Result, ensure};
use serde::{Deserialize, Serialize};
use std::{
    ffi::OsString,
    fmt::Write as _,
    fs,
    path::{Path, PathBuf},
    process::{Command, Stdio},
};

/// One network in one runtime, as the program prints it.
#[derive(Deserialize)]
struct Line {
    name: String,
    runtime: String,
    threads: usize,
    absent: Option<String>,
    #[serde(default)]
    milliseconds: Vec<f64>,
    #[serde(default)]
    processor_milliseconds: Vec<f64>,
    detections: Option<usize>,
    windows: Option<usize>,
    mean_difference: Option<f64>,
}

/// What is written down of it; times in milliseconds.
#[derive(Serialize)]
struct Row {
    name: String,
    runtime: String,
    threads: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    absent: Option<String>,
    rounds: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    elapsed: Option<Times>,
    #[serde(skip_serializing_if = "Option::is_none")]
    processor: Option<Times>,
    #[serde(skip_serializing_if = "Option::is_none")]
    detections: Option<usize>,
    /// How often the network is run.
    #[serde(skip_serializing_if = "Option::is_none")]
    windows: Option<usize>,
    /// How far the probabilities of wood are from those in the middle of the network's input, in the mean.
    #[serde(skip_serializing_if = "Option::is_none")]
    mean_difference: Option<f64>,
}

/// Milliseconds; half of the rounds lie between the quartiles.
#[derive(Serialize, Clone, Copy, Debug, PartialEq)]
struct Times {
    best: f64,
    median: f64,
    quartiles: [f64; 2],
}

/// Our own model, and the peer's for those who have it.
const MODELS: [(&str, &str); 2] = [
    ("ours", "crates/detect/model/apple.onnx"),
    ("yolox-nano", "../shared/models/yolox_nano_coco.onnx"),
];

/// A recorded frame, for those who have it.
const FRAME: &str = "../shared/frames/orchard-1218";

/// Its image.
const COLOR: &str = "color.png";

/// A benchmark of networks.
#[derive(Clone, Copy)]
pub(super) enum Networks {
    /// Those of detectors.
    Detection,
    /// The built-in segmenter.
    Segmentation,
}

impl Networks {
    /// The package and the program in its examples.
    fn example(self) -> (&'static str, &'static str) {
        match self {
            Self::Detection => ("pomona-detect", "network_bench"),
            Self::Segmentation => ("pomona-segment", "segment_bench"),
        }
    }

    fn file(self) -> &'static str {
        match self {
            Self::Detection => "detection.json",
            Self::Segmentation => "segmentation.json",
        }
    }

    /// Arguments that follow the rounds: models and images that are here.
    fn arguments(self) -> Vec<OsString> {
        let frame = root().join(FRAME);
        let frame_is_here = frame.join(COLOR).exists();
        let mut arguments: Vec<OsString> = Vec::new();
        match self {
            Self::Detection => {
                for (name, path) in MODELS {
                    let path = root().join(path);
                    if path.exists() {
                        arguments.push(format!("{name}={}", path.display()).into());
                    } else {
                        println!("absent: {name} ({} is not here)", path.display());
                    }
                }
                if frame_is_here {
                    arguments.extend(["--frame".into(), frame.join(COLOR).into()]);
                }
            }
            Self::Segmentation => arguments.extend(frame_is_here.then(|| frame.into())),
        }
        arguments
    }
}

/// Measures so many rounds, prints a table and writes it as JSON.
pub(super) fn run(workspace: &Workspace, networks: Networks, rounds: u32) -> Result<()> {
    let lines = measure(&build_ours(workspace, networks)?, networks, rounds)?;
    let rows: Vec<Row> = lines.into_iter().map(Row::of).collect();
    println!("{}", table(&rows));
    let folder = workspace.target_directory.join("bench");
    fs::create_dir_all(&folder).with_context(|| format!("cannot make {}", folder.display()))?;
    let path = folder.join(networks.file());
    fs::write(&path, serde_json::to_string_pretty(&rows)?)
        .with_context(|| format!("cannot write {}", path.display()))?;
    println!("all of it: {}", workspace.relative(&path).display());
    Ok(())
}

fn build_ours(workspace: &Workspace, networks: Networks) -> Result<PathBuf> {
    let (package, example) = networks.example();
    let mut command = cargo();
    command.args(["build", "--release", "--quiet", "--package", package]);
    command.args(["--all-features", "--example", example]);
    let built = command.status().context("cannot start cargo")?;
    ensure!(built.success(), "our own program does not build");
    Ok(workspace
        .target_directory
        .join("release/examples")
        .join(example))
}

fn measure(program: &Path, networks: Networks, rounds: u32) -> Result<Vec<Line>> {
    let mut command = Command::new(program);
    command.arg(rounds.to_string()).args(networks.arguments());
    let output = command
        .stderr(Stdio::inherit())
        .output()
        .with_context(|| format!("cannot start {}", program.display()))?;
    ensure!(output.status.success(), "the benchmark failed");
    let text = String::from_utf8(output.stdout).context("the benchmark printed no text")?;
    let parse =
        |line| serde_json::from_str(line).with_context(|| format!("not understood: {line}"));
    text.lines().map(parse).collect()
}

impl Row {
    fn of(line: Line) -> Self {
        Self {
            rounds: line.milliseconds.len(),
            elapsed: Times::of(&line.milliseconds),
            processor: Times::of(&line.processor_milliseconds),
            name: line.name,
            runtime: line.runtime,
            threads: line.threads,
            absent: line.absent,
            detections: line.detections,
            windows: line.windows,
            mean_difference: line.mean_difference,
        }
    }
}

impl Times {
    /// `None` without any.
    fn of(milliseconds: &[f64]) -> Option<Self> {
        let mut sorted = milliseconds.to_vec();
        sorted.sort_by(f64::total_cmp);
        let half = sorted.len().div_ceil(2);
        Some(Self {
            best: *sorted.first()?,
            median: median(&sorted),
            quartiles: [
                median(&sorted[..half]),
                median(&sorted[sorted.len() - half..]),
            ],
        })
    }
}

fn table(rows: &[Row]) -> String {
    let width = |field: fn(&Row) -> &str| rows.iter().map(|row| field(row).chars().count()).max();
    let name = width(|row| &row.name).unwrap_or(0);
    let runtime = width(|row| &row.runtime).unwrap_or(0);
    let mut text = format!(
        "{:name$}  {:runtime$}  threads  {:^29}  {:^29}\n{:name$}  {:runtime$}           {}  {}\n",
        "",
        "",
        "elapsed, ms",
        "on the processor, ms",
        "",
        "",
        "best  median  [quartiles]    ",
        "best  median  [quartiles]    "
    );
    for row in rows {
        let times = match (&row.absent, row.elapsed) {
            (Some(reason), _) => format!("absent: {reason}"),
            (None, elapsed) => format!("{}  {}", cell(elapsed), cell(row.processor)),
        };
        let mut found = row
            .detections
            .map_or_else(String::new, |count| format!("  {count} detections"));
        if let Some(windows) = row.windows {
            let _ = write!(found, "  {windows} runs");
        }
        let _ = writeln!(
            text,
            "{:name$}  {:runtime$}  {:>7}  {times}{found}",
            row.name, row.runtime, row.threads
        );
    }
    for row in rows {
        if let Some(difference) = row.mean_difference {
            let _ = writeln!(
                text,
                "seams: mean difference {difference:.4}, {}, {}",
                row.name, row.runtime
            );
        }
    }
    text + "Time on the processor is what one quiet core would take or a little more; on a busy machine the \
            elapsed time is not.\n"
}

fn cell(times: Option<Times>) -> String {
    let text = times.map(|times| {
        let [low, high] = times.quartiles;
        let quartiles = format!("[{low:.1}, {high:.1}]");
        format!("{:5.1}  {:6.1}  {quartiles}", times.best, times.median)
    });
    format!("{:29}", text.unwrap_or_default())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quartiles_hold_half_of_the_rounds() {
        assert_eq!(Times::of(&[]), None);
        let times = Times::of(&[5.0, 1.0, 2.0, 4.0, 3.0]).unwrap();
        assert_eq!(
            (times.best, times.median, times.quartiles),
            (1.0, 3.0, [2.0, 4.0])
        );
        assert_eq!(Times::of(&[7.0]).unwrap().quartiles, [7.0, 7.0]);
    }

    #[test]
    fn a_runtime_that_is_not_there_says_so() {
        let line =
            r#"{"name": "ours", "runtime": "onnxruntime", "threads": 1, "absent": "none found"}"#;
        let row = Row::of(serde_json::from_str(line).unwrap());
        assert!(table(&[row]).contains("absent: none found"));
        let line =
            r#"{"name": "ours", "runtime": "embedded", "threads": 1, "milliseconds": [3.0, 2.0]}"#;
        let row = Row::of(serde_json::from_str(line).unwrap());
        assert!(table(&[row]).contains("2.0     2.5  [2.0, 3.0]"));
        let line = r#"{"name": "a frame", "runtime": "embedded", "threads": 2, "windows": 18, "mean_difference": 0.01234}"#;
        let text = table(&[Row::of(serde_json::from_str(line).unwrap())]);
        assert!(text.contains("18 runs"), "{text}");
        assert!(
            text.contains("seams: mean difference 0.0123, a frame, embedded"),
            "{text}"
        );
    }
}
