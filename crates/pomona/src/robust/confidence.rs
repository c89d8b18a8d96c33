//! The confidence of an answer, and the reason of a refusal.

use super::apple::SeenApple;
use super::branch::Candidate;
use crate::outcome::{CONFIDENCE_FEATURES, Status};

/// Coefficients of the logistic model of 'at most 20 degrees off', in the order of [`CONFIDENCE_FEATURES`].
///
/// Fitted to the scenes 200 and up of `orchard`, `harsh` and `harsh-kinect` and the first 75 of `repeat474-dense`; the
/// scenes that the suites are evaluated on are others. `cargo xtask fit-confidence` fits them again.
pub const CONFIDENCE_MODEL: [f64; CONFIDENCE_FEATURES.len()] = [
    -2.234, 2.605, 2.199, 0.199, 0.342, 0.857, 0.76, -0.513, -1.024,
];

/// Angle between two directions from which they are different answers, radians (12°).
const ANOTHER_DIRECTION_RAD: f64 = 0.21;

/// Score that stands for the next candidate where there is none: that of an axis with nothing on it.
const NO_RIVAL_SCORE: f64 = -1.0;

/// Visible share of an apple below which it is called occluded.
const LEAST_VISIBLE_SHARE: f64 = 0.1;

/// Margin between two candidates below which they are ambiguous, …
const AMBIGUOUS_MARGIN: f64 = 0.1;

/// … where the better one has at least this score.
const AMBIGUOUS_SCORE: f64 = -0.3;

/// Share of the inspected length from which a candidate is called occluded.
const OCCLUDED_SHARE: f64 = 0.5;

/// What the confidence is computed from; `None` where there is no candidate.
pub(crate) fn features(
    found: &SeenApple,
    ranked: &[Candidate],
) -> Option<[f64; CONFIDENCE_FEATURES.len()]> {
    let best = ranked.first()?;
    let r = found.fit.spheroid.radius;
    let support = &best.support;
    let inspected = support.inspected().max(1e-6);
    Some([
        1.0,
        best.score.clamp(-1.0, 1.2),
        (support.visible / r).min(2.0),
        (support.visible_shorter_side / r).min(0.5),
        margin(found, ranked).clamp(0.0, 1.5),
        found.agreement.min(0.8),
        found.visible_share.min(0.7),
        support.atypical / inspected,
        support.empty / inspected,
    ])
}

/// Probability that the best candidate's direction is at most 20 degrees off.
pub(crate) fn probability(features: &[f64; CONFIDENCE_FEATURES.len()]) -> f64 {
    let sum: f64 = features
        .iter()
        .zip(CONFIDENCE_MODEL)
        .map(|(f, m)| f * m)
        .sum();
    1.0 / (1.0 + (-sum).exp())
}

/// By how much the best candidate's score is above that of the next one whose direction differs by over 12 degrees.
fn margin(found: &SeenApple, ranked: &[Candidate]) -> f64 {
    let center = found.fit.spheroid.center;
    let Some(best) = ranked.first() else {
        return 0.0;
    };
    let direction = best.foot - center;
    let rival = ranked
        .iter()
        .find(|c| (c.foot - center).angle(&direction) > ANOTHER_DIRECTION_RAD);
    best.score - rival.map_or(NO_RIVAL_SCORE, |c| c.score)
}

/// Why there is no candidate at all.
pub(crate) fn without_candidate(found: &SeenApple) -> Status {
    if found.visible_share < LEAST_VISIBLE_SHARE {
        Status::Occluded
    } else {
        Status::NoBranch
    }
}

/// Why the best candidate is not sure enough.
pub(crate) fn refusal(found: &SeenApple, ranked: &[Candidate]) -> Status {
    let Some(best) = ranked.first() else {
        return without_candidate(found);
    };
    let support = &best.support;
    let inspected = support.inspected();
    let rivals = ranked.len() > 1 && margin(found, ranked) < AMBIGUOUS_MARGIN;
    if rivals && best.score > AMBIGUOUS_SCORE {
        Status::AmbiguousBranch
    } else if support.occluded > OCCLUDED_SHARE * inspected {
        Status::Occluded
    } else if support.atypical > support.visible && support.atypical > support.empty {
        Status::LeafLike
    } else {
        Status::NoBranch
    }
}
