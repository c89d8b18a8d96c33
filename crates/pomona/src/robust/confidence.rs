//! The confidence of an answer, and the reason of a refusal.

use super::apple::SeenApple;
use super::nearest::Ranked;
use crate::outcome::{CONFIDENCE_FEATURES, Status};

/// Coefficients of the logistic model of 'at most 20 degrees off', in the order of [`CONFIDENCE_FEATURES`].
///
/// Fitted to the scenes 200 and up of `rivals`, `orchard`, `harsh` and `harsh-kinect`, 1000 and up of
/// `repeat474-dense`; the scenes that the suites are evaluated on are others. `cargo xtask fit-confidence` fits them again.
pub const CONFIDENCE_MODEL: [f64; CONFIDENCE_FEATURES.len()] =
    [1.492, 0.579, -0.031, 0.573, 0.459, -1.679, 3.980];

/// Visible share of an apple below which it is called occluded.
const LEAST_VISIBLE_SHARE: f64 = 0.1;

/// Probability of being the nearest wood, as a share of the best candidate's, from which another one makes the answer
/// ambiguous.
const AMBIGUOUS_SHARE: f64 = 0.5;

/// Range of the logarithms of odds.
const MOST_LOG_ODDS: f64 = 8.0;

/// Share of the inspected length from which a candidate is called occluded.
const OCCLUDED_SHARE: f64 = 0.5;

/// What the confidence is computed from; `None` where there is no candidate. `sd` is the standard deviation of the
/// direction, radians.
pub(crate) fn features(
    found: &SeenApple,
    ranked: &[Ranked],
    sd: f64,
) -> Option<[f64; CONFIDENCE_FEATURES.len()]> {
    let best = ranked.first()?;
    let r = found.fit.spheroid.radius;
    let support = &best.candidate.support;
    let log_odds = |p: f64| {
        let odds = (p / (1.0 - p).max(1e-12)).max(1e-12);
        odds.ln().clamp(-MOST_LOG_ODDS, MOST_LOG_ODDS)
    };
    Some([
        1.0,
        log_odds(best.nearest),
        log_odds(best.wood),
        (support.visible / r).min(2.0),
        sd.clamp(1e-3, 1.0).ln(),
        found.agreement.min(0.8),
        found.visible_share.min(0.7),
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

/// Why there is no candidate at all.
pub(crate) fn without_candidate(found: &SeenApple) -> Status {
    if found.visible_share < LEAST_VISIBLE_SHARE {
        Status::Occluded
    } else {
        Status::NoBranch
    }
}

/// Why the best candidate is not sure enough.
pub(crate) fn refusal(found: &SeenApple, ranked: &[Ranked]) -> Status {
    let Some(best) = ranked.first() else {
        return without_candidate(found);
    };
    let support = &best.candidate.support;
    let inspected = support.inspected();
    let rival = ranked.get(1);
    if rival.is_some_and(|rival| rival.nearest > AMBIGUOUS_SHARE * best.nearest) {
        Status::AmbiguousBranch
    } else if support.occluded > OCCLUDED_SHARE * inspected {
        Status::Occluded
    } else if support.atypical > support.visible && support.atypical > support.empty {
        Status::LeafLike
    } else {
        Status::NoBranch
    }
}
