//! Observations for the model of wood: candidates, and whether each is a branch.

use crate::logistic::Observation;
use crate::scenes::Apple;
use pomona::WOOD_FEATURES;

/// Distance of a candidate's foot from a branch's up to which it is that branch, radii of the apple: 15 degrees at 1.3
/// radii.
const SAME_FOOT_RADII: f64 = 0.35;

/// Every candidate of an apple, but for those that are the same branch as a better one.
pub(crate) fn of_scene(apple: &Apple<'_>) -> Vec<Observation<{ WOOD_FEATURES.len() }>> {
    let Some(fitted) = &apple.answer.apple else {
        return Vec::new();
    };
    let center = fitted.center.point();
    let mut found = vec![false; apple.feet.len()];
    let mut observations = Vec::new();
    for weighed in &apple.answer.evidence.weighed {
        let offset = weighed.foot.point() - center;
        let gap = |foot: &nalgebra::Vector3<f64>| (offset - foot).norm() / apple.truth.radius;
        let branch = (0..found.len())
            .min_by(|&a, &b| gap(&apple.feet[a]).total_cmp(&gap(&apple.feet[b])))
            .filter(|&k| gap(&apple.feet[k]) < SAME_FOOT_RADII);
        if branch.is_some_and(|k| std::mem::replace(&mut found[k], true)) {
            continue;
        }
        observations.push(Observation {
            scene: apple.scene,
            suite: apple.suite,
            features: weighed.features.into(),
            right: branch.is_some(),
        });
    }
    observations
}
