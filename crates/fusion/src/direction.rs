//! The frames' directions combined on the sphere.

use crate::observation::ObservedDirection;
use nalgebra::Vector3;
use pomona_transforms::{Direction, RobotFrame};

/// Most steps to the mean; each squares the error, and three reach the last digit.
const MAX_MEAN_STEPS: usize = 20;

/// The mean is found when a step is shorter than this, radians.
const MEAN_TOLERANCE_RAD: f64 = 1e-14;

/// Directions whose mean vector is shorter than this cancel out: they have no mean.
const MIN_MEAN_LENGTH: f64 = 1e-9;

/// Below this the sine of an angle equals the angle to double precision.
const SMALL_ANGLE_RAD: f64 = 1e-8;

/// Directions that agree, combined.
#[derive(Clone, Debug)]
pub(crate) struct CombinedDirection {
    pub(crate) direction: Direction<RobotFrame>,
    pub(crate) sd_rad: f64,
    pub(crate) confidence: f64,
    /// Which of the directions agree with it.
    pub(crate) agreeing: Vec<bool>,
}

impl CombinedDirection {
    /// How many directions agree with it.
    pub(crate) fn agreeing_count(&self) -> usize {
        self.agreeing.iter().filter(|agrees| **agrees).count()
    }
}

/// The group of agreeing directions that is most probably right.
///
/// A right direction is off by its standard deviation; a wrong one repeats another wrong one with probability
/// `repeated_error`. Hypotheses are that the directions near one of them are right, or that none is; the confidence is
/// the posterior probability of the best of them. `gate` bounds the squared angle over the sum of the variances.
///
/// `None` where there is no direction.
pub(crate) fn combine(
    directions: &[ObservedDirection],
    gate: f64,
    repeated_error: f64,
) -> Option<CombinedDirection> {
    let mut groups: Vec<(f64, Vec<bool>)> = Vec::new();
    for seed in directions {
        let group: Vec<bool> = directions.iter().map(|d| agree(seed, d, gate)).collect();
        if !groups.iter().any(|(_, known)| *known == group) {
            groups.push((odds(directions, &group, repeated_error), group));
        }
    }
    let total: f64 = groups.iter().map(|(odds, _)| odds).sum();
    let mut best = groups.first()?;
    for group in &groups {
        if group.0 > best.0 {
            best = group;
        }
    }
    let (odds, agreeing) = best.clone();
    let members: Vec<&ObservedDirection> = directions
        .iter()
        .zip(&agreeing)
        .filter_map(|(d, agrees)| agrees.then_some(d))
        .collect();
    let (direction, sd_rad) = mean(&members)?;
    // Groups that share members are not alternatives: the total may exceed the true one but never fall below it.
    Some(CombinedDirection {
        direction,
        sd_rad,
        confidence: odds / (1.0 + total),
        agreeing,
    })
}

/// Odds that the members of a group are all right, against all directions being wrong.
fn odds(directions: &[ObservedDirection], group: &[bool], repeated_error: f64) -> f64 {
    let (mut right, mut wrong, mut members) = (1.0, 1.0, 0);
    for (d, member) in directions.iter().zip(group) {
        if *member {
            right *= d.confidence;
            wrong *= 1.0 - d.confidence;
            members += 1;
        }
    }
    right / wrong / repeated_error.powi(members - 1)
}

fn agree(a: &ObservedDirection, b: &ObservedDirection, gate: f64) -> bool {
    let angle = a.direction.angle_to(&b.direction);
    angle.powi(2) <= gate * (a.sd_rad.powi(2) + b.sd_rad.powi(2))
}

/// Weighted mean on the sphere and its standard deviation, which grows where the directions scatter by more than they state.
///
/// Source: Buss and Fillmore 2001, algorithm A1, doi 10.1145/502122.502124; the factor of the standard deviation is
/// Birge's ratio, √(χ²/ν) where it exceeds 1 (Birge 1932, doi 10.1103/PhysRev.40.207).
fn mean(members: &[&ObservedDirection]) -> Option<(Direction<RobotFrame>, f64)> {
    let weight: f64 = members.iter().map(|d| d.sd_rad.powi(-2)).sum();
    let sum: Vector3<f64> = members
        .iter()
        .map(|d| d.direction.vector() * d.sd_rad.powi(-2))
        .sum();
    if !(sum.norm() > MIN_MEAN_LENGTH * weight) {
        return None;
    }
    let mut mean = Direction::new(sum)?;
    for _ in 0..MAX_MEAN_STEPS {
        let step: Vector3<f64> = members
            .iter()
            .map(|d| tangent(&mean, &d.direction) * d.sd_rad.powi(-2))
            .sum::<Vector3<f64>>()
            / weight;
        let angle = step.norm();
        mean = Direction::new(mean.vector() * angle.cos() + step * sinc(angle))?;
        if angle < MEAN_TOLERANCE_RAD {
            break;
        }
    }
    let squares: f64 = members
        .iter()
        .map(|d| (mean.angle_to(&d.direction) / d.sd_rad).powi(2))
        .sum();
    // Two for each direction, less the two of the mean.
    let degrees_of_freedom = 2.0 * (members.len() as f64 - 1.0);
    let scatter = if degrees_of_freedom > 0.0 {
        (squares / degrees_of_freedom).max(1.0)
    } else {
        1.0
    };
    Some((mean, (scatter / weight).sqrt()))
}

/// The arc from `base` to `to` as a tangent vector at `base`, radians.
fn tangent(base: &Direction<RobotFrame>, to: &Direction<RobotFrame>) -> Vector3<f64> {
    let (base, to) = (base.vector(), to.vector());
    let across = to - base * base.dot(&to);
    let sine = across.norm();
    if sine < SMALL_ANGLE_RAD {
        return across;
    }
    across * (sine.atan2(base.dot(&to)) / sine)
}

fn sinc(angle: f64) -> f64 {
    if angle < SMALL_ANGLE_RAD {
        1.0
    } else {
        angle.sin() / angle
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(degrees: f64, sd_degrees: f64, confidence: f64) -> ObservedDirection {
        let a = degrees.to_radians();
        ObservedDirection {
            direction: Direction::new(Vector3::new(a.cos(), a.sin(), 0.0)).unwrap(),
            sd_rad: sd_degrees.to_radians(),
            confidence,
        }
    }

    #[test]
    fn the_mean_leans_to_the_surer_and_is_surer_than_both() {
        let c = combine(&[at(0.0, 2.0, 0.8), at(3.0, 1.0, 0.8)], 13.8, 0.3).unwrap();
        assert!(
            (c.direction
                .vector()
                .y
                .atan2(c.direction.vector().x)
                .to_degrees()
                - 2.4)
                .abs()
                < 1e-9
        );
        assert!(c.sd_rad < 1f64.to_radians() && c.confidence > 0.9);
        assert_eq!(c.agreeing, [true, true]);
    }

    #[test]
    fn one_alone_keeps_its_confidence() {
        let c = combine(&[at(0.0, 2.0, 0.6)], 13.8, 0.3).unwrap();
        assert!((c.confidence - 0.6).abs() < 1e-12 && (c.sd_rad - 2f64.to_radians()).abs() < 1e-12);
    }

    #[test]
    fn two_outvote_a_surer_third() {
        let c = combine(
            &[at(0.0, 2.0, 0.7), at(90.0, 2.0, 0.8), at(2.0, 2.0, 0.7)],
            13.8,
            0.3,
        )
        .unwrap();
        assert_eq!(c.agreeing, [true, false, true]);
        assert!(c.confidence > 0.6 && c.confidence < 0.95);
    }

    #[test]
    fn equals_that_contradict_leave_less_than_even_odds() {
        let c = combine(&[at(0.0, 2.0, 0.9), at(180.0, 2.0, 0.9)], 13.8, 0.3).unwrap();
        assert!(c.confidence < 0.5);
        assert!(combine(&[], 13.8, 0.3).is_none());
    }
}
