use crate::apple_row::AppleRow;
use crate::error::EvaluateError;
use crate::evaluation::{Evaluation, SCHEMA};
use crate::matching::match_answers;
use crate::method::PickMethod;
use crate::robot::{BaseRow, RobotTrial};
use crate::subject::Subject;
use crate::suite::{SuiteResult, compare};
use pomona::CheckedFrame;
use rayon::prelude::*;

/// What one method said of one frame.
struct Answered {
    rows: Vec<AppleRow>,
    /// Picks that belong to no apple of the truth.
    stray: usize,
}

/// Runs every method over every subject, subjects in parallel, and draws up the statistics.
///
/// `done` is called once for each subject, from any thread. Timings aside, the outcome depends on
/// subjects, methods and seed alone, whatever the number of threads.
///
/// # Errors
///
/// The first subject that cannot be loaded, or that a method cannot work on at all.
pub fn evaluate(
    subjects: &[Subject],
    methods: &[&dyn PickMethod],
    seed: u64,
    done: &(dyn Fn() + Sync),
) -> Result<Evaluation, EvaluateError> {
    run(subjects, methods, seed, None, done)
}

/// The same with a robot that is sent to the apples: a camera is mounted on it and calibrated for each subject, and
/// where the gripper ends up is compared with the truth in the base's frame.
///
/// # Errors
///
/// As [`evaluate`], and [`EvaluateError::Noise`], [`EvaluateError::Calibration`].
pub fn evaluate_with_robot(
    subjects: &[Subject],
    methods: &[&dyn PickMethod],
    seed: u64,
    trial: &RobotTrial,
    done: &(dyn Fn() + Sync),
) -> Result<Evaluation, EvaluateError> {
    run(subjects, methods, seed, Some(trial), done)
}

fn run(
    subjects: &[Subject],
    methods: &[&dyn PickMethod],
    seed: u64,
    trial: Option<&RobotTrial>,
    done: &(dyn Fn() + Sync),
) -> Result<Evaluation, EvaluateError> {
    let suites = suite_names(subjects);
    let numbers = numbers(subjects);
    let answered: Vec<Vec<Answered>> = subjects
        .par_iter()
        .zip(&numbers)
        .map(|(subject, &number)| {
            let answered = answer(subject, number, methods, seed, trial);
            done();
            answered
        })
        .collect::<Result<_, _>>()?;

    let mut results = Vec::new();
    let mut rows = Vec::new();
    for suite in &suites {
        for (m, method) in methods.iter().enumerate() {
            let of_suite = subjects
                .iter()
                .zip(&answered)
                .filter(|(s, _)| s.suite == *suite);
            let (mut own, mut cases, mut stray) = (Vec::new(), 0, 0);
            for (_, methods) in of_suite {
                own.extend(methods[m].rows.iter().cloned());
                stray += methods[m].stray;
                cases += 1;
            }
            results.push(SuiteResult::of(suite, method.name(), cases, stray, &own));
            rows.extend(own);
        }
    }
    let comparisons = compare(&rows);
    Ok(Evaluation {
        schema: SCHEMA.to_owned(),
        version: env!("CARGO_PKG_VERSION").to_owned(),
        seed,
        results,
        comparisons,
        apples: rows,
    })
}

fn answer(
    subject: &Subject,
    number: usize,
    methods: &[&dyn PickMethod],
    seed: u64,
    trial: Option<&RobotTrial>,
) -> Result<Vec<Answered>, EvaluateError> {
    let scene = subject.load()?;
    let frame = CheckedFrame::new(&scene.frame)?;
    let mounted = match trial {
        Some(trial) => Some((trial, trial.mounting(subject, seed)?)),
        None => None,
    };
    methods
        .iter()
        .map(|method| {
            let answer = match &mounted {
                Some((trial, mounting)) => trial.answer(*method, &frame, seed, mounting)?,
                None => method.answer(&frame, seed)?,
            };
            let answers = answer.apples;
            let matched = match_answers(&scene.truth.apples, &answers);
            let rows = scene
                .truth
                .apples
                .iter()
                .zip(&matched)
                .map(|(apple, answer)| {
                    let answer = answer.map(|i| &answers[i]);
                    let base = mounted.as_ref().zip(answer);
                    AppleRow {
                        base: base.and_then(|((_, m), answer)| BaseRow::of(m, apple, answer)),
                        ..AppleRow::new(
                            &subject.suite,
                            &subject.name,
                            number,
                            method.name(),
                            apple,
                            answer,
                        )
                    }
                });
            Ok(Answered {
                rows: rows.collect(),
                stray: answers.len() - matched.iter().flatten().count(),
            })
        })
        .collect()
}

/// The suites in the order in which they first appear.
fn suite_names(subjects: &[Subject]) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for subject in subjects {
        if !names.contains(&subject.suite) {
            names.push(subject.suite.clone());
        }
    }
    names
}

/// The number of each subject in its own suite.
fn numbers(subjects: &[Subject]) -> Vec<usize> {
    let mut counts = std::collections::BTreeMap::new();
    subjects
        .iter()
        .map(|subject| {
            let count = counts.entry(subject.suite.as_str()).or_insert(0);
            *count += 1;
            *count - 1
        })
        .collect()
}
