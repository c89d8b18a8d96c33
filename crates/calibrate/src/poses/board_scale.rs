//! Whether the camera's distances are those of the robot: a board of another size than its detector was told makes all
//! of them too long or too short by one factor.

use super::refine::{Fit, least_squares};
use super::system::{PosePair, normal_equations};
use pomona_files::{Warning, WarningCode};

/// Standard deviations by which a factor must differ from 1.
const SIGNIFICANT: f64 = 4.0;
/// The least difference that is said: printers and rulers are off by so much.
const LEAST: f64 = 0.003;
/// Half the interval in which the sum of squares is taken for a parabola. It is one in the factor itself; the rotations
/// that adapt to it bend it a little.
const HALF_INTERVAL: f64 = 0.01;
/// The parabola is found again about its own least point, so that large factors are found too.
const ROUNDS: usize = 3;
/// Factors that a wrong board explains; others have another cause.
const POSSIBLE: std::ops::RangeInclusive<f64> = 0.5..=2.0;
/// Unknowns of both transforms, and the factor.
const UNKNOWNS: f64 = 13.0;
/// Components of a residual.
const COMPONENTS: f64 = 6.0;

/// The warning that the distances seen by the camera fit those of the robot after they are multiplied by a factor.
pub(super) fn doubt(pairs: &[PosePair], fit: &Fit) -> Option<Warning> {
    let squares = |factor: f64| -> Option<f64> {
        let scaled: Vec<PosePair> = pairs
            .iter()
            .map(|pair| {
                let mut pair = *pair;
                pair.seen.translation.vector *= factor;
                pair
            })
            .collect();
        let model = least_squares(&scaled, &fit.weights, &fit.model, &fit.noise)?;
        Some(normal_equations(&scaled, &fit.weights, &model, &fit.noise).2)
    };
    let (mut factor, mut curvature) = (1.0, 0.0);
    for _ in 0..ROUNDS {
        let [low, here, high] = [
            squares(factor - HALF_INTERVAL)?,
            squares(factor)?,
            squares(factor + HALF_INTERVAL)?,
        ];
        curvature = (low - 2.0 * here + high) / HALF_INTERVAL.powi(2);
        // Motions that do not tell the factor leave the squares as they are.
        if !(curvature > 0.0) {
            return None;
        }
        factor -= (high - low) / (2.0 * HALF_INTERVAL) / curvature;
        if !POSSIBLE.contains(&factor) {
            return None;
        }
    }
    // The noise was estimated with a factor of 1, and is smaller with the right one.
    let freedom = COMPONENTS * fit.kept().count() as f64 - UNKNOWNS;
    if freedom <= 0.0 {
        return None;
    }
    let variance = squares(factor)? / freedom;
    let sigma = (2.0 * variance / curvature).sqrt();
    let off = (factor - 1.0).abs();
    if !(off > LEAST && off > SIGNIFICANT * sigma) {
        return None;
    }
    let message = format!(
        "the camera's distances fit those of the robot after they are multiplied by {factor:.3} (± {sigma:.3}): the size of \
         the board that was given to its detector, or the focal length, is {:.1} % too {}; measure the board and give its \
         poses again",
        (1.0 / factor - 1.0).abs() * 100.0,
        if factor < 1.0 { "large" } else { "small" }
    );
    Some(Warning::new(WarningCode::BoardScale, message))
}
