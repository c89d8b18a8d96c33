//! Whether depth tells a detector's right boxes from its wrong ones: seeded boxes whose truth is known.

use crate::boxes::{self, Kind, Made};
use crate::fixed_detector::find;
use crate::{poster, search, splits};
use pomona::{Config, Mark, PickError};
use pomona_cloud::Frame;
use pomona_evaluate::{EvaluateError, Subject};
use pomona_scenes::AppleTruth;
use rayon::prelude::*;
use serde::Serialize;
use std::collections::BTreeMap;

use crate::search::SearchCounts;
use crate::splits::MergeCounts;

/// Boxes of one kind, and how depth marked them.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub(crate) struct MarkCounts {
    /// How many.
    pub(crate) boxes: usize,
    /// How many of them depth refuses.
    pub(crate) refused: usize,
    /// How many have too few readings for depth to say anything.
    pub(crate) no_depth: usize,
    /// How many have each mark.
    pub(crate) marks: BTreeMap<String, usize>,
}

impl MarkCounts {
    fn add(&mut self, mark: Mark) {
        self.boxes += 1;
        self.refused += usize::from(mark.refuses());
        self.no_depth += usize::from(mark == Mark::NoDepth);
        *self.marks.entry(mark.name().to_owned()).or_default() += 1;
    }

    fn join(&mut self, other: &Self) {
        self.boxes += other.boxes;
        self.refused += other.refused;
        self.no_depth += other.no_depth;
        for (name, count) in &other.marks {
            *self.marks.entry(name.clone()).or_default() += count;
        }
    }
}

/// What depth was worth on the frames of one suite.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub(crate) struct DepthCheckResult {
    /// The suite.
    pub(crate) suite: String,
    /// Frames.
    pub(crate) frames: usize,
    /// How boxes were marked, by kind: `true_*` by how much of the apple shows; false ones by where they were put.
    pub(crate) marks: BTreeMap<String, MarkCounts>,
    /// How boxes were joined.
    pub(crate) merging: MergeCounts,
    /// What the search in depth found of apples whose boxes were withheld.
    pub(crate) search: SearchCounts,
    /// Milliseconds of one thread for a box, the mean.
    pub(crate) box_ms: f64,
}

impl DepthCheckResult {
    fn join(&mut self, other: &Self) {
        let boxes = |r: &Self| r.marks.values().map(|m| m.boxes).sum::<usize>() as f64;
        let (own, more) = (boxes(self), boxes(other));
        if own + more > 0.0 {
            self.box_ms = (self.box_ms * own + other.box_ms * more) / (own + more);
        }
        self.frames += other.frames;
        for (kind, counts) in &other.marks {
            self.marks.entry(kind.clone()).or_default().join(counts);
        }
        self.merging.join(&other.merging);
        self.search.join(&other.search);
    }
}

/// Marks, merging and search measured on frames with truth, under the settings given; the same boxes for the same seed.
///
/// # Errors
///
/// The first subject that cannot be loaded, or whose parts contradict each other.
pub(crate) fn measure_depth_checks(
    subjects: &[Subject],
    config: &Config,
    seed: u64,
    done: &(dyn Fn() + Sync),
) -> Result<Vec<DepthCheckResult>, EvaluateError> {
    let measured: Vec<DepthCheckResult> = subjects
        .par_iter()
        .enumerate()
        .map(|(number, subject)| {
            let result = measure(subject, config, seed.wrapping_add(number as u64));
            done();
            result
        })
        .collect::<Result<_, _>>()?;
    let mut suites: Vec<DepthCheckResult> = Vec::new();
    for (subject, result) in subjects.iter().zip(&measured) {
        match suites.iter_mut().find(|s| s.suite == subject.suite) {
            Some(suite) => suite.join(result),
            None => suites.push(DepthCheckResult {
                suite: subject.suite.clone(),
                ..result.clone()
            }),
        }
    }
    Ok(suites)
}

fn measure(
    subject: &Subject,
    config: &Config,
    seed: u64,
) -> Result<DepthCheckResult, EvaluateError> {
    let scene = subject.load()?;
    Ok(of_frame(&scene.frame, &scene.truth.apples, config, seed)?)
}

/// The same on a frame without truth: its boxes are taken for those of its apples, at the depth in their middle.
/// What has no box counts as no apple.
///
/// # Errors
///
/// [`EvaluateError::Pick`] where the frame's parts contradict each other.
pub(crate) fn measure_boxed_frame(
    frame: &Frame,
    config: &Config,
    seed: u64,
) -> Result<DepthCheckResult, EvaluateError> {
    let apples: Vec<AppleTruth> = frame
        .boxes
        .iter()
        .flatten()
        .map(|bounds| boxes::presumed(frame, bounds))
        .collect();
    let mut result = of_frame(frame, &apples, config, seed)?;
    result.suite.clone_from(&frame.id);
    Ok(result)
}

fn of_frame(
    frame: &Frame,
    apples: &[AppleTruth],
    config: &Config,
    seed: u64,
) -> Result<DepthCheckResult, PickError> {
    let mut result = DepthCheckResult {
        frames: 1,
        ..DepthCheckResult::default()
    };
    let mut single = config.clone();
    single.detection.merge_distance = 0.0;
    single.detection.depth_search = false;
    for kind in Kind::ALL {
        let made = boxes::make(kind, frame, apples, seed);
        if made.is_empty() {
            continue;
        }
        let postered;
        let shown = if kind == Kind::Poster {
            postered = poster::with_posters(frame, &made, seed);
            &postered
        } else {
            frame
        };
        let found = find(shown, made.iter().map(|m| m.detection).collect(), &single)?;
        let before: usize = result.marks.values().map(|m| m.boxes).sum();
        let (old, new) = (before as f64, made.len() as f64);
        let ms = 1e3 * found.summary.times.depth_check.as_secs_f64() / new;
        result.box_ms = (result.box_ms * old + ms * new) / (old + new);
        for found in &found.boxes {
            let Some(Made { group, .. }) = found
                .bounds
                .name
                .parse::<usize>()
                .ok()
                .and_then(|i| made.get(i))
            else {
                continue;
            };
            let counts = result.marks.entry((*group).to_owned()).or_default();
            counts.add(found.origin.mark);
        }
    }
    result.merging = splits::measure(frame, apples, config, seed)?;
    result.search = search::measure(frame, apples, config, seed)?;
    Ok(result)
}
