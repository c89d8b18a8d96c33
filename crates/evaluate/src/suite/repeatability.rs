use super::angle_errors::AngleErrors;
use crate::apple_row::{AppleRow, mean_of};
use nalgebra::Vector3;
use pomona_geometry::angle_between;
use pomona_statistics::MeanSd;
use serde::{Deserialize, Serialize};

/// Fewest repeats that make a suite one of repeats.
const LEAST_REPEATS: usize = 10;

/// Unit vectors nearer than this are one direction, but for rounding.
const SAME_DIRECTION: f64 = 1e-6;

/// How much the answers scatter when one scene is taken again and again: the measure of the
/// paper's section 3 (Figures 13–15).
///
/// It says nothing of the truth: its expected direction is the vector from the mean centre to
/// the mean foot of these very answers, so that a method that is wrong the same way each
/// time repeats perfectly.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Repeatability {
    /// Answers.
    pub repeats: usize,
    /// Mean of the centres O.
    pub mean_center: [f64; 3],
    /// Mean of the feet C.
    pub mean_foot: [f64; 3],
    /// Standard deviation of each coordinate of O.
    pub center_sd: [f64; 3],
    /// Standard deviation of each coordinate of C.
    pub foot_sd: [f64; 3],
    /// The radii.
    pub radius: MeanSd,
    /// Angle of each OC to the vector from the mean O to the mean C.
    pub angle_to_mean: AngleErrors,
}

impl Repeatability {
    /// The scatter of the answers; `None` where the rows are not repeats of one apple.
    pub(crate) fn of(rows: &[&AppleRow]) -> Option<Self> {
        if rows.len() < LEAST_REPEATS || !are_repeats(rows) {
            return None;
        }
        let answered: Vec<&&AppleRow> = rows.iter().filter(|row| row.is_answered()).collect();
        let centers: Vec<[f64; 3]> = answered.iter().filter_map(|row| row.center).collect();
        let feet: Vec<[f64; 3]> = answered.iter().filter_map(|row| row.foot).collect();
        let radii: Vec<f64> = answered.iter().filter_map(|row| row.radius).collect();
        let (mean_center, mean_foot) = (mean_of(&centers)?, mean_of(&feet)?);
        let expected = Vector3::from(mean_foot) - Vector3::from(mean_center);
        let angles: Vec<(usize, f64)> = answered
            .iter()
            .filter_map(|row| {
                let angle = angle_between(&Vector3::from(row.direction?), &expected)?;
                Some((row.case_number, angle))
            })
            .collect();
        Some(Self {
            repeats: answered.len(),
            mean_center,
            mean_foot,
            center_sd: sd_of(&centers),
            foot_sd: sd_of(&feet),
            radius: MeanSd::of(&radii)?,
            angle_to_mean: AngleErrors::of(&angles)?,
        })
    }
}

/// Whether all rows are of one apple: the same radius and direction, the centres together but for some sway.
fn are_repeats(rows: &[&AppleRow]) -> bool {
    let Some(first) = rows.first() else {
        return false;
    };
    let apart = |a: [f64; 3], b: [f64; 3]| (Vector3::from(a) - Vector3::from(b)).norm();
    rows.iter().all(|row| {
        let turned = match (row.true_direction, first.true_direction) {
            (Some(a), Some(b)) => apart(a, b) > SAME_DIRECTION,
            (a, b) => a != b,
        };
        !turned
            && row.true_radius == first.true_radius
            && apart(row.true_center, first.true_center) < first.true_radius
    })
}

fn sd_of(points: &[[f64; 3]]) -> [f64; 3] {
    [0, 1, 2].map(|axis| {
        let values: Vec<f64> = points.iter().map(|p| p[axis]).collect();
        MeanSd::of(&values).unwrap_or_default().sd
    })
}
