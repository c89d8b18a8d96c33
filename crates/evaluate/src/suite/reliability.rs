use crate::apple_row::{AppleRow, values};
use pomona_statistics::{Proportion, Summary};
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// A direction at most this far off is right: what a confidence is the probability of, radians.
pub(crate) const RIGHT_RAD: f64 = PI / 9.0;

/// An answer of less confidence is one that the method itself doubts.
const UNSURE: f64 = 0.5;

/// Bins of the reliability diagram, and of both calibration errors.
const BINS: usize = 10;

/// Most points of the curve of risk over coverage.
const CURVE_POINTS: usize = 60;

/// Confidences and standard deviations against the errors, over the answers that carry a confidence.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Reliability {
    /// Mean of the confidences.
    pub mean_confidence: f64,
    /// Of these answers, those that are right: at most 20° off.
    pub right: Proportion,
    /// Expected calibration error: mean distance of confidence and share of right answers over ten bins of equal
    /// width (Guo et al. 2017, arXiv 1706.04599), each weighted by its answers.
    pub calibration_error: f64,
    /// The same over ten bins of equal count.
    pub calibration_error_equal_count: f64,
    /// Mean squared distance of confidence and outcome (Brier 1950); less is better.
    pub brier: f64,
    /// The reliability diagram: bins of equal width that hold answers.
    pub bins: Vec<ConfidenceBin>,
    /// Of the wrong answers, those with a confidence under 0.5.
    pub doubted_of_wrong: Proportion,
    /// Of the right answers, those with a confidence under 0.5.
    pub doubted_of_right: Proportion,
    /// What would be left if answers under a threshold were refused, from no answers to all.
    pub risk_coverage: Vec<RiskPoint>,
    /// The standard deviations of the directions, where they are given.
    pub direction_sd: Option<SdCalibration>,
}

/// The answers whose confidence lies in `from..to`, 1 belonging to the last bin.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct ConfidenceBin {
    /// Least confidence.
    pub from: f64,
    /// Upper bound.
    pub to: f64,
    /// Mean of the confidences.
    pub mean_confidence: f64,
    /// How many of them are right.
    pub right: Proportion,
}

/// What is left when answers of less confidence are refused.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct RiskPoint {
    /// Least confidence among those left.
    pub confidence: f64,
    /// Answers left, of all apples asked for.
    pub coverage: f64,
    /// Of these, the wrong ones.
    pub wrong: Proportion,
    /// Mean angle error of these.
    pub angle_mean: f64,
}

/// Angle errors in units of the standard deviation that was given with each.
///
/// That is the standard deviation along each of two axes across the direction, so that the ratio of calibrated
/// answers has a Rayleigh distribution: 39.3 % within 1, 86.5 % within 2, median 1.18, root mean square √2.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct SdCalibration {
    /// Error over standard deviation, of the right answers: that of a wrong one is not meant to hold.
    pub ratio: Summary,
    /// Root mean square of these ratios; √2 if calibrated.
    pub ratio_rms: f64,
    /// Of the right answers, those within one standard deviation.
    pub within_1_sd: Proportion,
    /// Of the right answers, those within two.
    pub within_2_sd: Proportion,
    /// Of all answers, right and wrong, those within two.
    pub all_within_2_sd: Proportion,
}

/// One answer: confidence and error.
type Answer = (f64, f64);

impl Reliability {
    /// Draws it up; `None` where no answer carries a confidence.
    pub(crate) fn of(rows: &[&AppleRow]) -> Option<Self> {
        let mut answers: Vec<Answer> = rows
            .iter()
            .filter_map(|row| Some((row.confidence?, row.angle_error?)))
            .collect();
        if answers.is_empty() {
            return None;
        }
        answers.sort_by(|a, b| a.0.total_cmp(&b.0));
        let n = answers.len();
        let bins = bins_of_equal_width(&answers);
        let chunks = (0..BINS).map(|i| &answers[n * i / BINS..n * (i + 1) / BINS]);
        let equal_count: Vec<_> = chunks.filter_map(summed_up).collect();
        let brier = answers
            .iter()
            .map(|a| (a.0 - f64::from(u8::from(is_right(a)))).powi(2))
            .sum::<f64>()
            / n as f64;
        let (mean_confidence, right) = summed_up(&answers)?;
        let doubted = |want: bool| {
            let of = answers.iter().filter(|a| is_right(a) == want);
            Proportion::new(of.clone().filter(|a| a.0 < UNSURE).count(), of.count())
        };
        let of_bins: Vec<_> = bins.iter().map(|b| (b.mean_confidence, b.right)).collect();
        Some(Self {
            mean_confidence,
            right,
            calibration_error: calibration_error(&of_bins, n),
            calibration_error_equal_count: calibration_error(&equal_count, n),
            brier,
            bins,
            doubted_of_wrong: doubted(false),
            doubted_of_right: doubted(true),
            risk_coverage: risk_coverage(&answers, rows.len()),
            direction_sd: SdCalibration::of(rows),
        })
    }
}

impl SdCalibration {
    fn of(rows: &[&AppleRow]) -> Option<Self> {
        let ratio = |row: &AppleRow| {
            let sd = row.direction_sd.filter(|&sd| sd > 0.0)?;
            Some(row.angle_error? / sd)
        };
        let of_right = values(rows, |row| {
            ratio(row).filter(|_| row.angle_error.is_some_and(|e| e <= RIGHT_RAD))
        });
        let plain: Vec<f64> = of_right.iter().map(|v| v.1).collect();
        let all: Vec<f64> = rows.iter().filter_map(|row| ratio(row)).collect();
        let squares: f64 = plain.iter().map(|v| v * v).sum();
        Some(Self {
            ratio: Summary::of(&of_right)?,
            ratio_rms: (squares / plain.len() as f64).sqrt(),
            within_1_sd: Proportion::of(&plain, |v| v <= 1.0),
            within_2_sd: Proportion::of(&plain, |v| v <= 2.0),
            all_within_2_sd: Proportion::of(&all, |v| v <= 2.0),
        })
    }
}

fn is_right(answer: &Answer) -> bool {
    answer.1 <= RIGHT_RAD
}

/// Mean confidence and share of right answers; `None` of none.
fn summed_up(answers: &[Answer]) -> Option<(f64, Proportion)> {
    let n = answers.len();
    let mean = answers.iter().map(|a| a.0).sum::<f64>() / n as f64;
    let right = answers.iter().filter(|a| is_right(a)).count();
    (n > 0).then(|| (mean, Proportion::new(right, n)))
}

fn bins_of_equal_width(answers: &[Answer]) -> Vec<ConfidenceBin> {
    let number = |a: &Answer| ((a.0 * BINS as f64).max(0.0) as usize).min(BINS - 1);
    let bins = (0..BINS).filter_map(|i| {
        let own: Vec<Answer> = answers.iter().filter(|a| number(a) == i).copied().collect();
        let (mean_confidence, right) = summed_up(&own)?;
        Some(ConfidenceBin {
            from: i as f64 / BINS as f64,
            to: (i + 1) as f64 / BINS as f64,
            mean_confidence,
            right,
        })
    });
    bins.collect()
}

fn calibration_error(bins: &[(f64, Proportion)], n: usize) -> f64 {
    let gaps = bins
        .iter()
        .map(|(confidence, right)| (confidence - right.share).abs() * right.of as f64);
    gaps.sum::<f64>() / n as f64
}

/// `answers` ascend by confidence. Answers of one confidence are kept or refused together.
fn risk_coverage(answers: &[Answer], asked: usize) -> Vec<RiskPoint> {
    let n = answers.len();
    let count = n.min(CURVE_POINTS);
    let mut points: Vec<RiskPoint> = Vec::new();
    for i in 1..=count {
        let least = answers[n - (n * i).div_ceil(count)].0;
        let left = &answers[answers.partition_point(|a| a.0 < least)..];
        if points.last().is_some_and(|p| p.confidence <= least) {
            continue;
        }
        let wrong = left.iter().filter(|a| !is_right(a)).count();
        points.push(RiskPoint {
            confidence: least,
            coverage: left.len() as f64 / asked as f64,
            wrong: Proportion::new(wrong, left.len()),
            angle_mean: left.iter().map(|a| a.1).sum::<f64>() / left.len() as f64,
        });
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Answers of these confidences and errors in degrees, in the order of confidence.
    fn answers(of: &[(f64, f64)]) -> Vec<Answer> {
        of.iter().map(|&(c, e)| (c, e.to_radians())).collect()
    }

    #[test]
    fn calibrated_bins_have_no_error_and_overconfident_ones_have_theirs() {
        // Four at 0.75, three of them right: nothing to mend. Two at 0.95, one right: 0.45 too much.
        let of = answers(&[
            (0.75, 1.0),
            (0.75, 2.0),
            (0.75, 19.9),
            (0.75, 90.0),
            (0.95, 20.0),
            (0.95, 20.1),
        ]);
        let bins = bins_of_equal_width(&of);
        assert_eq!(bins.len(), 2);
        assert_eq!((bins[0].from, bins[0].to), (0.7, 0.8));
        assert_eq!((bins[1].right.count, bins[1].right.of), (1, 2));
        let pairs: Vec<_> = bins.iter().map(|b| (b.mean_confidence, b.right)).collect();
        assert!((calibration_error(&pairs, 6) - 2.0 * 0.45 / 6.0).abs() < 1e-12);
        let outermost = bins_of_equal_width(&answers(&[(0.0, 1.0), (1.0, 1.0)]));
        assert_eq!((outermost[0].from, outermost[1].to), (0.0, 1.0));
    }

    #[test]
    fn refusing_the_unsure_trades_coverage_for_risk() {
        let of = answers(&[(0.4, 90.0), (0.6, 5.0), (0.9, 1.0), (0.9, 3.0)]);
        let curve = risk_coverage(&of, 5);
        let shares: Vec<_> = curve.iter().map(|p| (p.coverage, p.wrong.count)).collect();
        assert_eq!(shares, [(0.4, 0), (0.6, 0), (0.8, 1)]);
        assert!((curve[1].angle_mean.to_degrees() - 3.0).abs() < 1e-9);
    }
}
