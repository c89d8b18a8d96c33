//! Which observations are of one apple.
//!
//! Gating by the Mahalanobis distance of the innovation: Bar-Shalom and Fortmann 1988, Tracking and Data Association,
//! section 3.2. That a new frame's apples are tested jointly, under one motion: Neira and Tardós 2001, doi
//! 10.1109/70.976019.

use crate::joint::{JointEstimate, Track, jacobian, squared_distance};
use crate::observation::{Observation, centroid};
use crate::pairs::mutually_nearest;
use nalgebra::{Matrix3, Matrix6, Vector3};

/// Most rounds in which pairs and estimate are brought into agreement. They agree after two or three; where they alternate,
/// the last pairs stay.
const MAX_ROUNDS: usize = 6;

/// What is the same for all steps.
pub(crate) struct Association<'a> {
    pub(crate) observations: &'a [Observation],
    /// Covariance of each frame's motion about the centroid.
    pub(crate) priors: &'a [Matrix6<f64>],
    /// Bound of a squared Mahalanobis distance.
    pub(crate) gate: f64,
}

/// How far a new observation is from a known apple before the new frame's motion is known.
struct Innovation {
    difference: Vector3<f64>,
    /// Its covariance, the frame's shift left out.
    covariance: Matrix3<f64>,
}

impl<'a> Association<'a> {
    /// The estimate with the apples as its tracks; frames are taken in one after the other.
    ///
    /// `None` where a covariance is not positive definite.
    pub(crate) fn run(&self) -> Option<JointEstimate<'a>> {
        let mut tracks: Vec<Track> = Vec::new();
        for frame in 0..self.priors.len() {
            let new: Vec<usize> = (0..self.observations.len())
                .filter(|&i| self.observations[i].frame == frame)
                .collect();
            let pairs = if tracks.is_empty() {
                vec![None; new.len()]
            } else {
                self.pairs(&tracks, &new)?
            };
            for (&i, pair) in new.iter().zip(&pairs) {
                match pair {
                    Some(a) => tracks[*a].push(i),
                    None => tracks.push(vec![i]),
                }
            }
        }
        self.split_outliers(tracks)
    }

    fn solve(&self, tracks: Vec<Track>) -> Option<JointEstimate<'a>> {
        JointEstimate::solve(
            self.observations,
            tracks,
            self.priors,
            centroid(self.observations),
        )
    }

    /// For each new observation its track.
    fn pairs(&self, tracks: &[Track], new: &[usize]) -> Option<Vec<Option<usize>>> {
        let estimate = self.solve(tracks.to_vec())?;
        let mut pairs = self.first_pairs(&estimate, new);
        for _ in 0..MAX_ROUNDS {
            let mut joined = tracks.to_vec();
            for (&i, pair) in new.iter().zip(&pairs) {
                if let Some(a) = pair {
                    joined[*a].push(i);
                }
            }
            let estimate = self.solve(joined)?;
            let next = mutually_nearest(new.len(), tracks.len(), self.gate, |n, a| {
                estimate.distance(&self.observations[new[n]], a, pairs[n] == Some(a))
            });
            if next == pairs {
                break;
            }
            pairs = next;
        }
        Some(pairs)
    }

    /// The pairs under the one shift of the new frame that brings most observations to known apples.
    ///
    /// Hypotheses are no shift, and each shift that brings one observation onto one apple, as far as the prior allows.
    fn first_pairs(&self, estimate: &JointEstimate<'_>, new: &[usize]) -> Vec<Option<usize>> {
        let Some(&first) = new.first() else {
            return Vec::new();
        };
        let prior = &self.priors[self.observations[first].frame];
        let shift_prior: Matrix3<f64> = prior.fixed_view::<3, 3>(3, 3).into_owned();
        let innovations = self.innovations(estimate, new, prior);
        let mut shifts = vec![(Vector3::zeros(), Matrix3::zeros())];
        for i in &innovations {
            if squared_distance(&i.difference, &(i.covariance + shift_prior)) <= self.gate {
                shifts.push((i.difference, i.covariance));
            }
        }
        let columns = estimate.tracks.len();
        let mut best = (f64::NEG_INFINITY, vec![None; new.len()]);
        for (shift, covariance) in shifts {
            let distance = |n: usize, a: usize| {
                let i = &innovations[n * columns + a];
                squared_distance(&(i.difference - shift), &(i.covariance + covariance))
            };
            let pairs = mutually_nearest(new.len(), columns, self.gate, distance);
            let gain: f64 = pairs
                .iter()
                .enumerate()
                .filter_map(|(n, pair)| pair.map(|a| self.gate - distance(n, a)))
                .sum();
            let score = gain - squared_distance(&shift, &(shift_prior + covariance));
            if score > best.0 {
                best = (score, pairs);
            }
        }
        best.1
    }

    /// Row by row: each new observation against each known apple.
    fn innovations(
        &self,
        estimate: &JointEstimate<'_>,
        new: &[usize],
        prior: &Matrix6<f64>,
    ) -> Vec<Innovation> {
        let mut rotation_prior = Matrix6::zeros();
        rotation_prior
            .fixed_view_mut::<3, 3>(0, 0)
            .copy_from(&prior.fixed_view::<3, 3>(0, 0));
        let mut innovations = Vec::with_capacity(new.len() * estimate.tracks.len());
        for observation in new.iter().map(|&i| &self.observations[i]) {
            let j = jacobian(&observation.center, &estimate.centroid);
            let rotated = j * rotation_prior * j.transpose();
            innovations.extend(estimate.positions.iter().map(|position| Innovation {
                difference: observation.center - position.center,
                covariance: observation.covariance + position.covariance + rotated,
            }));
        }
        innovations
    }

    /// Takes out of each track what lies outside the gate, the worst first; it becomes a track of its own.
    fn split_outliers(&self, mut tracks: Vec<Track>) -> Option<JointEstimate<'a>> {
        loop {
            let estimate = self.solve(tracks)?;
            let mut worst: Option<(f64, usize, usize)> = None;
            for (a, track) in estimate.tracks.iter().enumerate() {
                if track.len() < 2 {
                    continue;
                }
                for (n, &i) in track.iter().enumerate() {
                    let distance = estimate.distance(&self.observations[i], a, true);
                    if distance > self.gate && worst.is_none_or(|w| distance > w.0) {
                        worst = Some((distance, a, n));
                    }
                }
            }
            let Some((_, a, n)) = worst else {
                return Some(estimate);
            };
            tracks = estimate.tracks;
            let outlier = tracks[a].remove(n);
            tracks.push(vec![outlier]);
        }
    }
}
