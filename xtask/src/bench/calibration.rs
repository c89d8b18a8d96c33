//! Calibration of a camera to a robot: ours and OpenCV's, on the same seeded trials.

use super::peers::build;
use crate::workspace::{Workspace, cargo, root};
use anyhow::{Context, Result, ensure};
use pomona_statistics::{median, quantile};
use serde::Deserialize;
use std::{
    fmt::Write as _,
    fs,
    path::{Path, PathBuf},
    process::Command,
};

/// The last 4.x release; 5.0 has no hand-eye solvers on the registry.
const REQUIREMENT: &str = "opencv-python-headless==4.12.0.88";

/// One method's answer to one trial, as the programs print it.
#[derive(Deserialize)]
struct Answer {
    case: String,
    method: String,
    rotation_deg: Option<f64>,
    translation_mm: Option<f64>,
    fruit_mm: Option<f64>,
    milliseconds: f64,
}

/// Makes the trials, lets both sides calibrate them, and prints a table for each case.
pub(super) fn run(workspace: &Workspace, trials: u32, install: bool) -> Result<()> {
    let folder = workspace.target_directory.join("bench");
    fs::create_dir_all(&folder).with_context(|| format!("cannot make {}", folder.display()))?;
    let ours = build_ours(workspace)?;
    let file = folder.join("hand-eye-trials.json");
    let made = Command::new(&ours)
        .arg("export")
        .arg(&file)
        .arg(trials.to_string())
        .status();
    let made = made.with_context(|| format!("cannot start {}", ours.display()))?;
    ensure!(made.success(), "the trials could not be made");

    let mut answers = answers_of(Command::new(&ours).arg("solve").arg(&file))?;
    match opencv(&folder, install) {
        Ok(python) => {
            let mut command = Command::new(python);
            // It reports each trial that it refuses at length.
            command.env("OPENCV_LOG_LEVEL", "SILENT");
            command.arg(root().join("xtask/peers/python/hand_eye.py"));
            answers.extend(answers_of(command.arg(&file))?);
        }
        Err(reason) => println!("absent: OpenCV ({reason})"),
    }
    for case in in_order(answers.iter().map(|a| a.case.as_str())) {
        let of_case: Vec<&Answer> = answers.iter().filter(|a| a.case == case).collect();
        println!("{}", table(case, &of_case));
    }
    Ok(())
}

fn build_ours(workspace: &Workspace) -> Result<PathBuf> {
    let mut command = cargo();
    command.args(["build", "--release", "--quiet", "--package"]);
    command.args(["pomona-calibrate", "--example", "hand_eye_trials"]);
    let built = command.status().context("cannot start cargo")?;
    ensure!(built.success(), "our own program does not build");
    Ok(workspace
        .target_directory
        .join("release/examples/hand_eye_trials"))
}

/// A Python that has OpenCV, fetched only with `install`.
fn opencv(folder: &Path, install: bool) -> Result<PathBuf, String> {
    let environment = folder.join("python");
    let python = environment.join("bin/python");
    if install {
        let mut venv = Command::new("python3");
        build(
            "a Python environment",
            venv.args(["-m", "venv"]).arg(&environment),
        )?;
        let mut pip = Command::new(&python);
        build(
            REQUIREMENT,
            pip.args(["-m", "pip", "install", "--quiet", REQUIREMENT]),
        )?;
    }
    let found = Command::new(&python).args(["-c", "import cv2"]).output();
    if found.is_ok_and(|output| output.status.success()) {
        Ok(python)
    } else {
        Err("not installed; `cargo xtask bench --calibration --install` gets it".into())
    }
}

fn answers_of(command: &mut Command) -> Result<Vec<Answer>> {
    let program = command.get_program().to_string_lossy().into_owned();
    let output = command
        .output()
        .with_context(|| format!("cannot start {program}"))?;
    ensure!(
        output.status.success(),
        "{program} failed:\n{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let text = String::from_utf8_lossy(&output.stdout);
    let lines = text.lines().filter(|line| !line.contains("\"version\""));
    lines
        .map(|line| {
            serde_json::from_str(line).with_context(|| format!("{program} printed: {line}"))
        })
        .collect()
}

/// Each name once, in the order of first mention.
fn in_order<'a>(names: impl Iterator<Item = &'a str>) -> Vec<&'a str> {
    let mut once: Vec<&str> = Vec::new();
    for name in names {
        if !once.contains(&name) {
            once.push(name);
        }
    }
    once
}

fn table(case: &str, answers: &[&Answer]) -> String {
    let mut text = format!(
        "hand-eye calibration, {case}: median and 95th percentile of the errors\n{:<26} {:>8} {:>8} {:>17} {:>19} {:>19} {:>7}\n",
        "method", "answered", "refused", "rotation, deg", "translation, mm", "at fruit, mm", "ms"
    );
    for method in in_order(answers.iter().map(|a| a.method.as_str())) {
        let own: Vec<&&Answer> = answers.iter().filter(|a| a.method == method).collect();
        let pair = |f: fn(&Answer) -> Option<f64>, digits: usize| {
            let mut numbers: Vec<f64> = own.iter().filter_map(|a| f(a)).collect();
            match (median(&mut numbers), quantile(&mut numbers, 0.95)) {
                (Some(m), Some(q)) => format!("{m:.digits$} {q:.digits$}"),
                _ => "-".to_owned(),
            }
        };
        let answered = own.iter().filter(|a| a.rotation_deg.is_some()).count();
        let mut times: Vec<f64> = own.iter().map(|a| a.milliseconds).collect();
        let _ = writeln!(
            text,
            "{method:<26} {answered:>8} {:>8} {:>17} {:>19} {:>19} {:>7.2}",
            own.len() - answered,
            pair(|a| a.rotation_deg, 3),
            pair(|a| a.translation_mm, 2),
            pair(|a| a.fruit_mm, 2),
            median(&mut times).unwrap_or(f64::NAN)
        );
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_method_that_refuses_all_is_in_the_table() {
        let line = r#"{"case":"small","seed":0,"method":"ours","refused":"no","milliseconds":1.5}"#;
        let answer: Answer = serde_json::from_str(line).unwrap();
        let text = table("small", &[&answer, &answer]);
        let row = text.lines().last().unwrap();
        assert_eq!(
            row.split_whitespace().collect::<Vec<_>>(),
            ["ours", "0", "2", "-", "-", "-", "1.50"]
        );
    }
}
