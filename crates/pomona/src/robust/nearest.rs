//! The nearest first: the answer is the nearest candidate that is really there, however well others are seen.

use super::branch::Candidate;
use nalgebra::Vector3;
use pomona_geometry::Sphere;

/// A candidate's foot, and how sure it is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    /// From the apple's centre to the foot, metres.
    pub(crate) offset: Vector3<f64>,
    /// Probability that it is wood.
    pub(crate) wood: f64,
}

/// Two candidates are the same branch where their feet are seen from the apple's centre within this angle, radians
/// (25°), …
const SAME_ANGLE_RAD: f64 = 0.44;

/// … at distances that differ by less than this, radii of the apple.
const SAME_DISTANCE_RADII: f64 = 0.5;

/// Score of an axis found in depth at which it is as likely a branch as not, …
///
/// Both were chosen on the tuning scenes (seeds 200 and up of `orchard`, `harsh` and `harsh-kinect`, 50 and up of
/// `row`): of 3810 apples 45 are more than 20 degrees off and 14 more than 50, where ranking by the score alone leaves 48
/// and 18. Between 0.5 and 0.75, and slopes of 15 and 30, hardly anything changes.
const EVEN_SCORE: f64 = 0.7;

/// … and how steeply that changes with the score.
const SCORE_SLOPE: f64 = 15.0;

/// The candidates about an apple, the likeliest to be the nearest branch first; of several that are the same one the best
/// stays. They come with the best score first.
pub(crate) fn ranked(candidates: &[Candidate], apple: &Sphere) -> Vec<Candidate> {
    let places: Vec<Place> = candidates
        .iter()
        .map(|candidate| Place {
            offset: candidate.foot - apple.center,
            wood: 1.0 / (1.0 + (-SCORE_SLOPE * (candidate.score - EVEN_SCORE)).exp()),
        })
        .collect();
    let order = nearest_first(&places, apple.radius);
    order.into_iter().map(|(k, _)| candidates[k]).collect()
}

/// For each distinct candidate the probability that it is the nearest that is there: that it is wood, and none of the
/// nearer ones is. The likeliest first, with its index in `places`.
///
/// Of several that are the same branch the first in `places` counts.
pub(crate) fn nearest_first(places: &[Place], apple_radius: f64) -> Vec<(usize, f64)> {
    let mut distinct: Vec<usize> = Vec::new();
    for (k, place) in places.iter().enumerate() {
        let same = |other: &usize| {
            let other = &places[*other];
            let apart = (place.offset.norm() - other.offset.norm()).abs();
            place.offset.angle(&other.offset) < SAME_ANGLE_RAD
                && apart < SAME_DISTANCE_RADII * apple_radius
        };
        if !distinct.iter().any(same) {
            distinct.push(k);
        }
    }
    distinct.sort_by(|a, b| {
        let distance = |k: &usize| places[*k].offset.norm();
        distance(a).total_cmp(&distance(b))
    });
    let mut none_nearer = 1.0;
    let mut ranked: Vec<(usize, f64)> = distinct
        .into_iter()
        .map(|k| {
            let wood = places[k].wood;
            let nearest = none_nearer * wood;
            none_nearer *= 1.0 - wood;
            (k, nearest)
        })
        .collect();
    ranked.sort_by(|a, b| b.1.total_cmp(&a.1));
    ranked
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place(x: f64, y: f64, wood: f64) -> Place {
        Place {
            offset: Vector3::new(x, y, 0.0),
            wood,
        }
    }

    #[test]
    fn a_sure_nearer_one_wins_over_a_surer_farther_one() {
        let ranked = nearest_first(&[place(0.06, 0.0, 0.99), place(0.0, 0.045, 0.8)], 0.04);
        assert_eq!(ranked[0].0, 1);
        assert!((ranked[0].1 - 0.8).abs() < 1e-12 && (ranked[1].1 - 0.2 * 0.99).abs() < 1e-12);
    }

    #[test]
    fn an_unlikely_nearer_one_does_not() {
        let ranked = nearest_first(&[place(0.06, 0.0, 0.9), place(0.0, 0.045, 0.2)], 0.04);
        assert_eq!(ranked[0].0, 0);
    }

    #[test]
    fn one_branch_found_twice_counts_once() {
        let twice = [place(0.05, 0.0, 0.9), place(0.051, 0.002, 0.85)];
        let ranked = nearest_first(&twice, 0.04);
        assert_eq!(ranked.len(), 1);
        assert!((ranked[0].1 - 0.9).abs() < 1e-12);
    }
}
