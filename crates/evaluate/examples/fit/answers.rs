//! Observations for the model of the confidence: answers, and whether each is right.

use crate::logistic::Observation;
use crate::scenes::Apple;
use nalgebra::Vector3;
use pomona::CONFIDENCE_FEATURES;

/// An answer is right up to this angle, radians (20°).
const RIGHT_RAD: f64 = 0.349;

/// The answer for an apple, refused or not.
pub(crate) fn of_scene(apple: &Apple<'_>) -> Vec<Observation<{ CONFIDENCE_FEATURES.len() }>> {
    let observation = || {
        let features = apple.answer.evidence.confidence_features?;
        let direction = Vector3::from(apple.truth.direction?);
        let pick = apple.answer.pick.as_ref()?;
        Some(Observation {
            scene: apple.scene,
            suite: apple.suite,
            features: features.into(),
            right: pick.direction.vector().angle(&direction) <= RIGHT_RAD,
        })
    };
    observation().into_iter().collect()
}
