//! The frames' directions combined on the sphere.

use crate::sighting::DirectionSighting;
use nalgebra::{UnitVector3, Vector3};

/// Directions that agree, combined.
#[derive(Clone, Debug)]
pub(crate) struct Combined {
    pub(crate) unit: UnitVector3<f64>,
    pub(crate) sd: f64,
    pub(crate) confidence: f64,
    /// Which of the directions agree with it.
    pub(crate) used: Vec<bool>,
}

/// The group of agreeing directions that is most probably right.
///
/// A right direction is off by its standard deviation; a wrong one repeats another wrong one with probability
/// `repeated_error`. Hypotheses are that the directions near one of them are right, or that none is; the confidence is
/// the probability of the best of them (Bayes). `gate` bounds the squared angle over the variances.
pub(crate) fn combine(
    directions: &[DirectionSighting],
    gate: f64,
    repeated_error: f64,
) -> Option<Combined> {
    let mut groups: Vec<(f64, Vec<bool>)> = Vec::new();
    for seed in directions {
        let used: Vec<bool> = directions.iter().map(|d| agree(seed, d, gate)).collect();
        if groups.iter().any(|(_, known)| *known == used) {
            continue;
        }
        let (mut right, mut wrong, mut members) = (1.0, 1.0, 0);
        for (d, used) in directions.iter().zip(&used) {
            if *used {
                right *= d.confidence;
                wrong *= 1.0 - d.confidence;
                members += 1;
            }
        }
        groups.push((right / wrong / repeated_error.powi(members - 1), used));
    }
    let total: f64 = groups.iter().map(|(odds, _)| odds).sum();
    let mut best = groups.first()?;
    for group in &groups {
        if group.0 > best.0 {
            best = group;
        }
    }
    let (odds, used) = best.clone();
    let members: Vec<&DirectionSighting> = directions
        .iter()
        .zip(&used)
        .filter_map(|(d, used)| used.then_some(d))
        .collect();
    let (unit, sd) = mean(&members)?;
    // Groups that share members are not alternatives: the total may exceed what it stands for, never fall below.
    Some(Combined {
        unit,
        sd,
        confidence: odds / (1.0 + total),
        used,
    })
}

fn agree(a: &DirectionSighting, b: &DirectionSighting, gate: f64) -> bool {
    let angle = angle(&a.unit, &b.unit);
    angle.powi(2) <= gate * (a.sd.powi(2) + b.sd.powi(2))
}

/// Angle between two directions, radians.
pub(crate) fn angle(a: &UnitVector3<f64>, b: &UnitVector3<f64>) -> f64 {
    a.cross(b).norm().atan2(a.dot(b))
}

/// Weighted mean on the sphere (Karcher) and its standard deviation, which grows where they scatter by more than they state.
fn mean(members: &[&DirectionSighting]) -> Option<(UnitVector3<f64>, f64)> {
    let weight: f64 = members.iter().map(|d| d.sd.powi(-2)).sum();
    let sum: Vector3<f64> = members
        .iter()
        .map(|d| d.unit.into_inner() * d.sd.powi(-2))
        .sum();
    let mut unit = UnitVector3::try_new(sum, 1e-9 * weight)?;
    for _ in 0..20 {
        let step: Vector3<f64> = members
            .iter()
            .map(|d| tangent(&unit, &d.unit) * d.sd.powi(-2))
            .sum::<Vector3<f64>>()
            / weight;
        let length = step.norm();
        let next = unit.into_inner() * length.cos() + step * sinc(length);
        unit = UnitVector3::try_new(next, 1e-9)?;
        if length < 1e-14 {
            break;
        }
    }
    let squares: f64 = members
        .iter()
        .map(|d| (angle(&unit, &d.unit) / d.sd).powi(2))
        .sum();
    let freedom = 2.0 * (members.len() as f64 - 1.0);
    let scatter = if freedom > 0.0 {
        (squares / freedom).max(1.0)
    } else {
        1.0
    };
    Some((unit, (scatter / weight).sqrt()))
}

/// The way from `base` to `to` on the sphere, as a tangent at `base`.
fn tangent(base: &UnitVector3<f64>, to: &UnitVector3<f64>) -> Vector3<f64> {
    let across = to.into_inner() - base.into_inner() * base.dot(to);
    let sine = across.norm();
    if sine < 1e-12 {
        return across;
    }
    across * (sine.atan2(base.dot(to)) / sine)
}

fn sinc(x: f64) -> f64 {
    if x < 1e-8 { 1.0 } else { x.sin() / x }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(degrees: f64, sd_degrees: f64, confidence: f64) -> DirectionSighting {
        let a = degrees.to_radians();
        DirectionSighting {
            unit: UnitVector3::new_normalize(Vector3::new(a.cos(), a.sin(), 0.0)),
            sd: sd_degrees.to_radians(),
            confidence,
        }
    }

    #[test]
    fn the_mean_leans_to_the_surer_and_is_surer_than_both() {
        let c = combine(&[at(0.0, 2.0, 0.8), at(3.0, 1.0, 0.8)], 13.8, 0.3).unwrap();
        assert!((c.unit.y.atan2(c.unit.x).to_degrees() - 2.4).abs() < 1e-9);
        assert!(c.sd < 1f64.to_radians() && c.confidence > 0.9);
        assert_eq!(c.used, [true, true]);
    }

    #[test]
    fn one_alone_keeps_its_confidence() {
        let c = combine(&[at(0.0, 2.0, 0.6)], 13.8, 0.3).unwrap();
        assert!((c.confidence - 0.6).abs() < 1e-12 && (c.sd - 2f64.to_radians()).abs() < 1e-12);
    }

    #[test]
    fn two_outvote_a_surer_third() {
        let c = combine(
            &[at(0.0, 2.0, 0.7), at(90.0, 2.0, 0.8), at(2.0, 2.0, 0.7)],
            13.8,
            0.3,
        )
        .unwrap();
        assert_eq!(c.used, [true, false, true]);
        assert!(c.confidence > 0.6 && c.confidence < 0.95);
    }

    #[test]
    fn equals_that_contradict_leave_less_than_even_odds() {
        let c = combine(&[at(0.0, 2.0, 0.9), at(180.0, 2.0, 0.9)], 13.8, 0.3).unwrap();
        assert!(c.confidence < 0.5);
        assert!(combine(&[], 13.8, 0.3).is_none());
    }
}
