use super::angle_errors::AngleErrors;
use super::base_result::BaseResult;
use super::grouping::Grouping;
use super::lab::LabRow;
use super::reliability::Reliability;
use super::repeatability::Repeatability;
use crate::apple_row::{AppleRow, NO_BOX, mean_of, values};
use pomona_statistics::{MeanSd, Proportion, Summary};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A direction at most this far off is a hit, radians: 10°, the first of the shares in section 3 of the paper.
const HIT_RAD: f64 = std::f64::consts::PI / 18.0;

/// One method over one suite; only target apples count.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct SuiteResult {
    /// Suite, or folder of frames.
    pub suite: String,
    /// Method.
    pub method: String,
    /// Frames.
    pub cases: usize,
    /// Apples that were asked for.
    pub apples: usize,
    /// Apples that got a direction.
    pub answered: Proportion,
    /// Angle to the true direction, over the answered apples.
    pub angle: Option<AngleErrors>,
    /// Distance from the true centre, over the apples with a sphere.
    pub center_error: Option<Summary>,
    /// Mean of the centre given less the true one, in the camera's frame.
    pub center_bias: Option<[f64; 3]>,
    /// Radius given less the true one: its mean is the bias.
    pub radius_error: Option<Summary>,
    /// The same without its sign.
    pub radius_error_absolute: Option<Summary>,
    /// Distance of the foot from the true nearest point of the branch's axis.
    pub foot_error: Option<Summary>,
    /// Answers and refusals against what the camera could see.
    pub refusals: Refusals,
    /// Confidences against errors; absent for methods that give none.
    #[serde(default)]
    pub reliability: Option<Reliability>,
    /// The gripper in the base's frame, where a robot was simulated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub base: Option<BaseResult>,
    /// Time of each stage.
    pub timing_ms: Option<Timing>,
    /// Errors against what makes an apple hard.
    pub groupings: Vec<Grouping>,
    /// The paper's own measure, for suites that repeat one scene.
    pub repeatability: Option<Repeatability>,
    /// The rows of the paper's Tables 1–3, for the lab suites.
    pub lab: Vec<LabRow>,
    /// Picks that belong to no apple of the truth.
    pub stray_picks: usize,
}

/// Answers and refusals against what the camera could see.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Refusals {
    /// Of the apples asked for, the hits: a direction at most 10° off. A refusal is no hit.
    pub hits: Proportion,
    /// Refused, and apple or branch could not be seen.
    pub right: usize,
    /// Refused, though both could be seen.
    pub wrong: usize,
    /// Refused, and the truth does not say what could be seen.
    pub unjudged: usize,
    /// Answered, though apple or branch could not be seen.
    pub answered_unseen: usize,
    /// How many apples ended in which status.
    pub by_status: BTreeMap<String, usize>,
}

/// Time of each stage, milliseconds, over the answered apples, as in Table 4 of the paper.
///
/// With several threads the stages of several apples share the cores.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Timing {
    /// Cutting the box out of the depth image.
    pub crop: MeanSd,
    /// Fitting the sphere.
    pub sphere: MeanSd,
    /// Collecting the shell, fitting the branch, direction.
    pub branch: MeanSd,
    /// All of it.
    pub total: MeanSd,
}

impl SuiteResult {
    /// Draws up the statistics of one suite under one method.
    pub(crate) fn of(
        suite: &str,
        method: &str,
        cases: usize,
        stray: usize,
        rows: &[AppleRow],
    ) -> Self {
        let rows: Vec<&AppleRow> = rows.iter().filter(|row| row.target).collect();
        let rows = rows.as_slice();
        let answered = rows.iter().filter(|row| row.is_answered()).count();
        let radius_errors = values(rows, |row| row.radius_error);
        let absolute: Vec<_> = radius_errors
            .iter()
            .map(|&(case, e)| (case, e.abs()))
            .collect();
        Self {
            suite: suite.to_owned(),
            method: method.to_owned(),
            cases,
            apples: rows.len(),
            answered: Proportion::new(answered, rows.len()),
            angle: AngleErrors::of(&values(rows, |row| row.angle_error)),
            center_error: Summary::of(&values(rows, |row| row.center_error)),
            center_bias: center_bias(rows),
            radius_error: Summary::of(&radius_errors),
            radius_error_absolute: Summary::of(&absolute),
            foot_error: Summary::of(&values(rows, |row| row.foot_error)),
            refusals: Refusals::of(rows),
            reliability: Reliability::of(rows),
            base: BaseResult::of(rows),
            timing_ms: Timing::of(rows),
            groupings: Grouping::all(rows),
            repeatability: Repeatability::of(rows),
            lab: LabRow::all(rows),
            stray_picks: stray,
        }
    }
}

fn center_bias(rows: &[&AppleRow]) -> Option<[f64; 3]> {
    let offsets: Vec<[f64; 3]> = rows.iter().filter_map(|row| row.center_offset).collect();
    mean_of(&offsets)
}

impl Refusals {
    fn of(rows: &[&AppleRow]) -> Self {
        let close = |row: &&&AppleRow| row.angle_error.is_some_and(|e| e <= HIT_RAD);
        let mut refusals = Self {
            hits: Proportion::new(rows.iter().filter(close).count(), rows.len()),
            right: 0,
            wrong: 0,
            unjudged: 0,
            answered_unseen: 0,
            by_status: BTreeMap::new(),
        };
        for row in rows {
            *refusals.by_status.entry(row.status.clone()).or_insert(0) += 1;
            match (row.is_answered(), row.answerable) {
                (true, Some(false)) => refusals.answered_unseen += 1,
                (true, _) => {}
                // Nobody asked the method.
                (false, _) if row.status == NO_BOX => {}
                (false, Some(false)) => refusals.right += 1,
                (false, Some(true)) => refusals.wrong += 1,
                (false, None) => refusals.unjudged += 1,
            }
        }
        refusals
    }
}

impl Timing {
    fn of(rows: &[&AppleRow]) -> Option<Self> {
        let timings: Vec<_> = rows
            .iter()
            .filter(|row| row.is_answered())
            .filter_map(|row| row.timing_ms)
            .collect();
        let spread = |stage: fn(&pomona::record::StageTimesRecord) -> f64| {
            MeanSd::of(&timings.iter().map(stage).collect::<Vec<_>>())
        };
        Some(Self {
            crop: spread(|t| t.crop)?,
            sphere: spread(|t| t.sphere)?,
            branch: spread(|t| t.branch)?,
            total: spread(|t| t.total)?,
        })
    }
}
