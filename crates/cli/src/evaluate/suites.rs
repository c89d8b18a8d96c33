//! Methods against ground truth, in suites of scenes and in frames.

use super::arguments::EvaluateArguments;
use super::results::{REPORT, json};
use super::suites_text;
use crate::progress;
use crate::terminal::Terminal;
use anyhow::bail;
use pomona_evaluate::{
    PickMethod, SCHEMA, Subject, apples_csv, evaluate, evaluate_with_robot, report_page,
};

pub(super) const EVALUATION: &str = "evaluation.json";
pub(super) const APPLES: &str = "apples.csv";

pub(super) fn run(
    arguments: &EvaluateArguments,
    methods: &[&dyn PickMethod],
    terminal: Terminal,
) -> anyhow::Result<()> {
    let output = arguments
        .results
        .claim(EVALUATION, SCHEMA, |n| n == APPLES)?;
    let trial = arguments.robot.trial()?;
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
    arguments
        .results
        .print(&evaluation, &suites_text::tables(&evaluation, terminal))
}
