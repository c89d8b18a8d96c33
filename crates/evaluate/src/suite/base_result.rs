use super::reliability::RIGHT_RAD;
use crate::apple_row::AppleRow;
use crate::robot::{BaseRow, DirectionTerms, PositionTerms, Term};
use pomona_statistics::{Proportion, Summary, chi_square_critical};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// One method over one suite in the base's frame: error budget, and whether what is stated holds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct BaseResult {
    /// Answered apples, to which a gripper is sent.
    pub apples: usize,
    /// Error of the tool's place, its parts first and `total` last, over all answered apples; metres.
    pub position: Vec<BudgetTerm>,
    /// Error of the tool's direction, likewise, over the answers that are right in the camera's frame (at most 20°
    /// off); radians. A wrong branch is no measurement error.
    pub direction: Vec<BudgetTerm>,
    /// Error of the tool's direction over all answers, right and wrong; radians.
    pub direction_of_all: Option<Summary>,
    /// The stated covariance of the place against its errors, over all answers.
    pub position_coverage: Option<Coverage>,
    /// That of the direction, over the right answers.
    pub direction_coverage: Option<Coverage>,
    /// What the robot's plans make of the answers.
    pub planned: Planned,
}

/// A part of an error budget, over apples.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct BudgetTerm {
    /// Name of the part.
    pub name: String,
    /// Its size.
    pub error: Summary,
    /// Root mean square: what adds up in squares where parts are independent.
    pub rms: f64,
    /// Root mean square of what method and calibration state for it; absent where they state nothing.
    pub stated_rms: Option<f64>,
}

/// Errors against the covariances stated for them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Coverage {
    /// Degrees of freedom: the mean of the normalised squared errors, if calibrated.
    pub freedom: usize,
    /// Normalised squared errors.
    pub normalized: Summary,
    /// Errors within the ellipsoids that should hold half of them.
    pub within_50: Proportion,
    /// Errors within the ellipsoids that should hold 95 % of them.
    pub within_95: Proportion,
}

/// What the robot's plans make of the answers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Planned {
    /// Answers with a way to the apple.
    pub with_way: Proportion,
    /// How many answers ended in which status.
    pub by_status: BTreeMap<String, usize>,
    /// Distance of the planned tool from the apple's true centre, metres.
    pub position_error: Option<Summary>,
    /// Angle of the planned approach to the true direction, tilts and other candidates included, radians.
    pub direction_error: Option<Summary>,
}

/// A row and the number of its case.
type Row<'a> = (usize, &'a BaseRow);
type Part<T> = (&'static str, fn(&T) -> Term);

const POSITION: [Part<PositionTerms>; 5] = [
    ("sphere_center", |t| t.sphere_center),
    ("calibration_rotation", |t| t.calibration_rotation),
    ("calibration_translation", |t| t.calibration_translation),
    ("calibration", |t| t.calibration),
    ("total", |t| t.total),
];

const DIRECTION: [Part<DirectionTerms>; 5] = [
    ("sphere_center", |t| t.sphere_center),
    ("branch", |t| t.branch),
    ("camera", |t| t.camera),
    ("calibration", |t| t.calibration),
    ("total", |t| t.total),
];

impl BaseResult {
    /// Draws it up; `None` where nothing was measured in the base's frame.
    pub(crate) fn of(rows: &[&AppleRow]) -> Option<Self> {
        let own: Vec<Row<'_>> = rows
            .iter()
            .filter_map(|row| Some((row.case_number, row.base.as_ref()?)))
            .collect();
        if own.is_empty() {
            return None;
        }
        let right: Vec<Row<'_>> = own
            .iter()
            .filter(|(_, row)| row.direction.is_some_and(|d| d.camera.error <= RIGHT_RAD))
            .copied()
            .collect();
        let all = |field: fn(&BaseRow) -> Option<f64>| Summary::of(&values(&own, field));
        let planned = own.iter().filter_map(|(_, row)| row.planned.as_ref());
        let mut by_status = BTreeMap::new();
        for plan in planned.clone() {
            *by_status.entry(plan.status.clone()).or_insert(0) += 1;
        }
        let with_way = planned.filter(|plan| plan.tilt.is_some()).count();
        Some(Self {
            apples: own.len(),
            position: budget(&own, &POSITION, |row| Some(row.position)),
            direction: budget(&right, &DIRECTION, |row| row.direction),
            direction_of_all: all(|row| Some(row.direction?.total.error)),
            position_coverage: Coverage::of(3, &values(&own, |row| row.position_nees)),
            direction_coverage: Coverage::of(2, &values(&right, |row| row.direction_nees)),
            planned: Planned {
                with_way: Proportion::new(with_way, own.len()),
                by_status,
                position_error: all(|row| row.planned.as_ref()?.position_error),
                direction_error: all(|row| row.planned.as_ref()?.direction_error),
            },
        })
    }
}

impl Coverage {
    fn of(freedom: u32, squares: &[(usize, f64)]) -> Option<Self> {
        let plain: Vec<f64> = squares.iter().map(|v| v.1).collect();
        let [half, most] = [0.5, 0.05].map(|rate| chi_square_critical(rate, freedom));
        Some(Self {
            freedom: freedom as usize,
            normalized: Summary::of(squares)?,
            within_50: Proportion::of(&plain, |v| v <= half),
            within_95: Proportion::of(&plain, |v| v <= most),
        })
    }
}

fn values(rows: &[Row<'_>], field: impl Fn(&BaseRow) -> Option<f64>) -> Vec<(usize, f64)> {
    rows.iter()
        .filter_map(|&(case, row)| Some((case, field(row)?)))
        .collect()
}

fn budget<T>(
    rows: &[Row<'_>],
    parts: &[Part<T>],
    terms: impl Fn(&BaseRow) -> Option<T>,
) -> Vec<BudgetTerm> {
    let root_mean_square = |values: &[f64]| {
        let sum: f64 = values.iter().map(|v| v * v).sum();
        (sum / values.len() as f64).sqrt()
    };
    parts
        .iter()
        .filter_map(|(name, part)| {
            let errors = values(rows, |row| Some(part(&terms(row)?).error));
            let stated: Vec<f64> = values(rows, |row| part(&terms(row)?).stated)
                .into_iter()
                .map(|v| v.1)
                .collect();
            let plain: Vec<f64> = errors.iter().map(|v| v.1).collect();
            Some(BudgetTerm {
                name: (*name).to_owned(),
                error: Summary::of(&errors)?,
                rms: root_mean_square(&plain),
                stated_rms: (stated.len() == plain.len()).then(|| root_mean_square(&stated)),
            })
        })
        .collect()
}
