//! How probably a candidate is wood: a logistic model of what its cross-sections show.
//!
//! What counts is evidence for and against, not evidence missing: a branch of which half is hidden is no less wood.

use super::branch::Candidate;
use crate::outcome::WOOD_FEATURES;
use pomona_geometry::Sphere;

/// Number of features.
const N: usize = WOOD_FEATURES.len();

/// Coefficients of the logistic model of 'its foot is that of a branch', in the order of [`WOOD_FEATURES`].
///
/// Fitted to the scenes 200 and up of `rivals`, `orchard`, `harsh` and `harsh-kinect`, 1000 and up of
/// `repeat474-dense` (4400 in all); the scenes that the suites are evaluated on are others. `cargo xtask fit-wood` fits them again.
pub const WOOD_MODEL: [f64; N] = [
    0.170, 0.487, 0.566, 0.097, 0.489, -0.156, 2.901, 0.092, 3.064, 1.437, -0.851, 0.465, -5.535,
    -0.647, 2.098, -2.458, -0.554, -4.560, -0.834, 0.086, -1.782, -0.764, -2.426, -2.857, -1.527,
    -0.225, -26.484, 0.834, 1.409, -1.065, 1.393, -1.741, -2.756, -2.211,
];

/// Offset within logarithms of lengths, radii of the apple.
const LEAST_LENGTH: f64 = 0.05;

/// Radius that the branch's is compared with, metres.
const TYPICAL_RADIUS_M: f64 = 0.005;

/// Logarithm of a radius over [`TYPICAL_RADIUS_M`] below which wood is thin: 2.5 mm.
const LOG_THIN: f64 = -std::f64::consts::LN_2;

/// Standard deviations of a reading for which the roundness counts linearly.
const ROUNDNESS_SCALE: f64 = 3.0;

/// Share of the visible length with both edges from which the unevenness of the width is known.
const LEAST_WHOLE_SHARE: f64 = 0.1;

/// Room between the apple and the branch's surface from which on there is no doubt, radii of the apple.
const LEAST_ROOM: f64 = 0.05;

/// What the probability is computed from. `sigma` is the standard deviation of a reading at the apple's depth.
pub(crate) fn features(candidate: &Candidate, apple: &Sphere, sigma: f64) -> [f64; N] {
    let r = apple.radius;
    let support = &candidate.support;
    let [
        visible,
        shorter,
        atypical,
        empty,
        occluded,
        whole,
        shared,
        longest,
    ] = [
        support.visible,
        support.visible_shorter_side,
        support.atypical,
        support.empty,
        support.occluded,
        support.whole,
        support.shared,
        support.longest,
    ]
    .map(|length| length / r);
    let empty_shorter = support.empty_shorter_side / r;
    let looked_at = visible + atypical + empty + LEAST_LENGTH;
    let shown = visible + LEAST_LENGTH;
    let whole_share = (whole / shown).min(1.0);
    let log_radius = (candidate.axis.radius / TYPICAL_RADIUS_M).ln();
    let sine = candidate
        .foot
        .coords
        .normalize()
        .cross(&candidate.tangent)
        .norm();
    // By how much the readings are likelier for something round than for something flat, in standard deviations.
    let roundness = (support.roundness.product - 0.5 * support.roundness.square) / (sigma * sigma);
    let uneven = (support.uneven / support.whole.max(1e-6)).sqrt();
    let room = candidate.distance / r - 1.0 - candidate.axis.radius / r;
    [
        1.0,
        visible.min(4.0),
        shown.ln(),
        shorter.min(1.5),
        atypical.min(2.0),
        empty.min(2.0),
        empty_shorter.min(1.0),
        occluded.min(5.0),
        visible / looked_at,
        whole_share,
        (support.visible_at_foot / r).min(1.2),
        (support.missing_at_foot / r).min(1.2),
        (candidate.rms / sigma).min(4.0),
        (candidate.foot_sd / r).clamp(1e-3, 1.0).ln(),
        sine,
        log_radius,
        log_radius * log_radius,
        candidate.distance / r,
        candidate.score,
        (roundness / ROUNDNESS_SCALE).asinh().clamp(-4.0, 8.0),
        shared.min(4.0),
        (shared / shown).min(1.3),
        empty_shorter.min(2.0).sqrt(),
        empty.sqrt(),
        atypical.sqrt(),
        if whole_share > LEAST_WHOLE_SHARE {
            (0.02 + uneven).ln()
        } else {
            0.0
        },
        (LEAST_ROOM - room).clamp(0.0, 0.3),
        (visible - shared).max(0.0) / looked_at,
        (support.stretches as f64 + 1.0).ln(),
        longest / shown,
        (candidate.axis.radius / support.pixel.max(1e-6))
            .max(0.1)
            .ln(),
        (LOG_THIN - log_radius).max(0.0),
        support.outdone[0],
        support.outdone[1],
    ]
}

/// Score at which a candidate in smeared depth is as likely wood as not, and how steeply that changes with the score.
///
/// The model above was fitted to sharp depth, and what it has learned of edges and roundness does not hold in smeared depth.
/// Chosen on two time-of-flight frames, where 13 of 28 answers are right with it, and 7 of 29 with the model alone.
const SMEARED_EVEN_SCORE: f64 = 0.0;
const SMEARED_SLOPE: f64 = 15.0;

/// Probability that a candidate with these features and this score is wood, in depth that is smeared from 0, not at
/// all, to 1.
pub(crate) fn probability(features: &[f64; N], score: f64, smear: f64) -> f64 {
    let sum: f64 = features.iter().zip(WOOD_MODEL).map(|(f, m)| f * m).sum();
    let by_score = SMEARED_SLOPE * (score - SMEARED_EVEN_SCORE);
    (1.0 - smear) * logistic(sum) + smear * logistic(by_score)
}

fn logistic(log_odds: f64) -> f64 {
    1.0 / (1.0 + (-log_odds).exp())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robust::axis::BranchAxis;
    use crate::robust::axis_fit::AxisSupport;
    use nalgebra::{Point3, Vector3};
    use pomona_geometry::Line;

    const APPLE: Sphere = Sphere {
        center: Point3::new(0.0, 0.0, 1.0),
        radius: 0.04,
    };

    /// How probably a horizontal candidate above the apple is wood that shows on the half of its length and of whose
    /// other half so much is occluded and empty.
    fn probability_with(distance: f64, occluded: f64, empty: f64) -> f64 {
        let foot = APPLE.center - Vector3::y() * distance;
        let line = Line::new(foot, Vector3::x()).unwrap();
        let support = AxisSupport {
            visible: 0.1,
            whole: 0.09,
            visible_at_foot: 0.02,
            longest: 0.09,
            stretches: 2,
            pixel: 0.001,
            occluded,
            empty,
            ..AxisSupport::default()
        };
        let candidate = Candidate {
            axis: BranchAxis::straight(&line, &APPLE.center, 0.005).unwrap(),
            foot,
            tangent: line.direction,
            distance,
            support,
            score: support.score() / (0.1 + occluded + empty),
            foot_sd: 0.0005,
            rms: 0.0006,
        };
        probability(&features(&candidate, &APPLE, 0.0015), candidate.score, 0.0)
    }

    #[test]
    fn what_is_hidden_is_no_evidence_against_a_branch_and_what_is_empty_is() {
        let hidden = probability_with(0.055, 0.1, 0.0);
        let empty = probability_with(0.055, 0.0, 0.1);
        let odds = |p: f64| p / (1.0 - p);
        assert!(hidden > 0.9, "{hidden}");
        assert!(odds(empty) < 0.2 * odds(hidden), "{empty} {hidden}");
    }

    #[test]
    fn nothing_passes_through_the_apple() {
        let (outside, inside) = (
            probability_with(0.055, 0.1, 0.0),
            probability_with(0.034, 0.1, 0.0),
        );
        assert!(inside < outside, "{inside} {outside}");
    }
}
