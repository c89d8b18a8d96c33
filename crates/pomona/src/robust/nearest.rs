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

/// Standard deviation of a distance beside that of the foot across its axis, radii of the apple: of two branches whose
/// distances differ by less, either may be the nearer one.
const DISTANCE_SD_RADII: f64 = 0.01;

/// A candidate found in depth with what is to be made of it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ranked {
    pub(crate) candidate: Candidate,
    /// Probability that it is wood.
    pub(crate) wood: f64,
    /// Probability that it is the nearest wood.
    pub(crate) nearest: f64,
}

/// The distinct candidates about an apple, the likeliest to be the nearest branch first; `wood` holds the probability of
/// each that it is wood. Unless `nearest_first`, distance does not count, and the likeliest to be wood comes first.
pub(crate) fn ranked(
    candidates: &[Candidate],
    wood: &[f64],
    apple: &Sphere,
    nearest_first: bool,
) -> Vec<Ranked> {
    let mut order: Vec<usize> = (0..candidates.len()).collect();
    order.sort_by(|&a, &b| wood[b].total_cmp(&wood[a]));
    let places: Vec<Place> = order
        .iter()
        .map(|&k| Place {
            offset: candidates[k].foot - apple.center,
            wood: wood[k],
        })
        .collect();
    let distinct = distinct(&places, apple.radius);
    let sd = |k: usize| candidates[order[k]].foot_sd;
    let floor = DISTANCE_SD_RADII * apple.radius;
    let mut ranked: Vec<Ranked> = distinct
        .iter()
        .map(|&k| {
            let none_nearer: f64 = distinct
                .iter()
                .filter(|&&other| other != k && nearest_first)
                .map(|&other| {
                    let farther = places[k].offset.norm() - places[other].offset.norm();
                    let scale = sd(k).hypot(sd(other)).hypot(floor);
                    1.0 - places[other].wood * normal_share(farther / scale)
                })
                .product();
            Ranked {
                candidate: candidates[order[k]],
                wood: places[k].wood,
                nearest: none_nearer * places[k].wood,
            }
        })
        .collect();
    ranked.sort_by(|a, b| b.nearest.total_cmp(&a.nearest));
    ranked
}

/// Factor by which the logistic function comes nearest to the normal distribution, to 0.01 everywhere (Camilli 1994,
/// Journal of Educational and Behavioral Statistics 19, 293-295).
const LOGISTIC_OF_NORMAL: f64 = 1.702;

/// Share of a normal distribution below `z` standard deviations, to 0.01.
fn normal_share(z: f64) -> f64 {
    1.0 / (1.0 + (-LOGISTIC_OF_NORMAL * z).exp())
}

/// For each distinct candidate the probability that it is the nearest that is there: that it is wood, and none of the
/// nearer ones is. The likeliest first, with its index in `places`. Unless `nearest_first`, distance does not count.
///
/// Of several that are the same branch the first in `places` counts.
pub(crate) fn by_distance(
    places: &[Place],
    apple_radius: f64,
    nearest_first: bool,
) -> Vec<(usize, f64)> {
    let mut distinct = distinct(places, apple_radius);
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
            if nearest_first {
                none_nearer *= 1.0 - wood;
            }
            (k, nearest)
        })
        .collect();
    ranked.sort_by(|a, b| b.1.total_cmp(&a.1));
    ranked
}

/// The first of each branch in `places`.
fn distinct(places: &[Place], apple_radius: f64) -> Vec<usize> {
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
    distinct
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robust::axis::BranchAxis;
    use crate::robust::axis_fit::AxisSupport;
    use nalgebra::Point3;
    use pomona_geometry::Line;

    fn place(x: f64, y: f64, wood: f64) -> Place {
        Place {
            offset: Vector3::new(x, y, 0.0),
            wood,
        }
    }

    fn apple() -> Sphere {
        Sphere {
            center: Point3::new(0.0, 0.0, 1.0),
            radius: 0.04,
        }
    }

    /// A candidate across the line of sight with its foot at (x, y) from the apple's centre.
    fn candidate(x: f64, y: f64) -> Candidate {
        let foot = apple().center + Vector3::new(x, y, 0.0);
        let line = Line::new(foot, Vector3::new(-y, x, 0.0)).unwrap();
        Candidate {
            axis: BranchAxis::straight(&line, &apple().center, 0.005).unwrap(),
            foot,
            tangent: line.direction,
            distance: x.hypot(y),
            support: AxisSupport::default(),
            score: 0.0,
            foot_sd: 0.0002,
            rms: 0.0,
        }
    }

    #[test]
    fn of_two_that_are_equally_near_neither_is_sure_and_the_likelier_leads() {
        let both = [candidate(0.05, 0.0), candidate(0.0, 0.05)];
        let ranked = ranked(&both, &[0.9, 0.96], &apple(), true);
        assert_eq!(ranked[0].candidate.foot, both[1].foot);
        assert!((ranked[0].nearest - 0.96 * 0.55).abs() < 1e-9);
        assert!((ranked[1].nearest - 0.9 * 0.52).abs() < 1e-9);
    }

    #[test]
    fn distance_counts_only_where_it_is_asked_for() {
        let both = [candidate(0.07, 0.0), candidate(0.0, 0.05)];
        let first = |nearest_first| {
            let ranked = ranked(&both, &[0.99, 0.8], &apple(), nearest_first);
            (ranked[0].candidate.foot, ranked[0].nearest)
        };
        let (foot, nearest) = first(true);
        assert!(foot == both[1].foot && (nearest - 0.8).abs() < 1e-6);
        let (foot, likeliest) = first(false);
        assert!(foot == both[0].foot && (likeliest - 0.99).abs() < 1e-12);
    }

    #[test]
    fn shares_of_the_normal_distribution_hold_to_a_hundredth() {
        for (z, share) in [(0.0, 0.5), (1.0, 0.8413), (-2.0, 0.0228)] {
            assert!((normal_share(z) - share).abs() < 0.01, "{z}");
        }
    }

    #[test]
    fn a_sure_nearer_one_wins_over_a_surer_farther_one() {
        let ranked = by_distance(
            &[place(0.06, 0.0, 0.99), place(0.0, 0.045, 0.8)],
            0.04,
            true,
        );
        assert_eq!(ranked[0].0, 1);
        let sure = [place(0.06, 0.0, 0.99), place(0.0, 0.045, 0.8)];
        assert_eq!(by_distance(&sure, 0.04, false)[0], (0, 0.99));
        assert!((ranked[0].1 - 0.8).abs() < 1e-12 && (ranked[1].1 - 0.2 * 0.99).abs() < 1e-12);
    }

    #[test]
    fn an_unlikely_nearer_one_does_not() {
        let ranked = by_distance(&[place(0.06, 0.0, 0.9), place(0.0, 0.045, 0.2)], 0.04, true);
        assert_eq!(ranked[0].0, 0);
    }

    #[test]
    fn one_branch_found_twice_counts_once() {
        let twice = [place(0.05, 0.0, 0.9), place(0.051, 0.002, 0.85)];
        let ranked = by_distance(&twice, 0.04, true);
        assert_eq!(ranked.len(), 1);
        assert!((ranked[0].1 - 0.9).abs() < 1e-12);
    }
}
