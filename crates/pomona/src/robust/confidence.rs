//! How sure an answer is, and why there is none.

use super::apple::SeenApple;
use super::branch::Candidate;
use crate::outcome::Status;

/// Coefficients of the logistic model of 'at most 20 degrees off', in the order of the features.
///
/// Fitted to the scenes 200 and up of `orchard`, `harsh` and `harsh-kinect` and the first 75 of `repeat474-dense`; the
/// scenes that the suites are evaluated on are others.
const MODEL: [f64; 9] = [
    -2.234, 2.605, 2.199, 0.199, 0.342, 0.857, 0.76, -0.513, -1.024,
];

/// Probability that the best candidate's direction is at most 20 degrees off.
pub(crate) fn confidence(found: &SeenApple, ranked: &[Candidate]) -> f64 {
    let Some(best) = ranked.first() else {
        return 0.0;
    };
    let r = found.fit.body.radius;
    let tally = &best.tally;
    let looked = (tally.shown + tally.odd + tally.empty + tally.hidden).max(1e-6);
    let features = [
        1.0,
        best.score.clamp(-1.0, 1.2),
        (tally.shown / r).min(2.0),
        (tally.shown_lesser_side / r).min(0.5),
        margin(found, ranked).clamp(0.0, 1.5),
        found.agreement.min(0.8),
        found.visible_share.min(0.7),
        tally.odd / looked,
        tally.empty / looked,
    ];
    let sum: f64 = features.iter().zip(MODEL).map(|(f, m)| f * m).sum();
    1.0 / (1.0 + (-sum).exp())
}

/// By how much the best candidate's score is above that of the next one whose direction differs by over 12 degrees.
fn margin(found: &SeenApple, ranked: &[Candidate]) -> f64 {
    const ALIKE_RAD: f64 = 0.21;
    let center = found.fit.body.center;
    let Some(best) = ranked.first() else {
        return 0.0;
    };
    let direction = best.foot - center;
    let rival = ranked
        .iter()
        .find(|c| (c.foot - center).angle(&direction) > ALIKE_RAD);
    best.score - rival.map_or(-1.0, |c| c.score)
}

/// Why there is no candidate at all.
pub(crate) fn without_candidate(found: &SeenApple) -> Status {
    const LEAST_VISIBLE: f64 = 0.1;
    if found.visible_share < LEAST_VISIBLE {
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
    let tally = &best.tally;
    let looked = tally.shown + tally.odd + tally.empty + tally.hidden;
    let rivals = ranked.len() > 1 && margin(found, ranked) < 0.1;
    if rivals && best.score > -0.3 {
        Status::AmbiguousBranch
    } else if tally.hidden > 0.5 * looked {
        Status::Occluded
    } else if tally.odd > tally.shown && tally.odd > tally.empty {
        Status::LeafLike
    } else {
        Status::NoBranch
    }
}
