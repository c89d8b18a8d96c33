//! Which sightings are of one apple.

use crate::joint::{Joint, Track, jacobian, middle_of, squared_distance};
use crate::sighting::Sighting;
use nalgebra::{Matrix3, Matrix6, Vector3};

/// Rounds in which pairs and estimate are brought into agreement.
const ROUNDS: usize = 6;

/// What is the same for all steps.
pub(crate) struct Association<'a> {
    pub(crate) sightings: &'a [Sighting],
    /// Covariance of each frame's motion about the middle.
    pub(crate) priors: &'a [Matrix6<f64>],
    /// Bound of a squared Mahalanobis distance.
    pub(crate) gate: f64,
}

impl Association<'_> {
    /// The apples, each with its sightings, and the estimate; frames are taken in one after the other.
    ///
    /// `None` where a covariance is none.
    pub(crate) fn run(&self) -> Option<(Vec<Track>, Joint)> {
        let mut tracks: Vec<Track> = Vec::new();
        for frame in 0..self.priors.len() {
            let new: Vec<usize> = (0..self.sightings.len())
                .filter(|&i| self.sightings[i].frame == frame)
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
        self.expel(tracks)
    }

    fn solve(&self, tracks: &[Track]) -> Option<Joint> {
        Joint::solve(
            self.sightings,
            tracks,
            self.priors,
            middle_of(self.sightings),
        )
    }

    /// For each new sighting its track.
    fn pairs(&self, tracks: &[Track], new: &[usize]) -> Option<Vec<Option<usize>>> {
        let joint = self.solve(tracks)?;
        let mut pairs = self.first_pairs(tracks, new, &joint);
        for _ in 0..ROUNDS {
            let mut joined = tracks.to_vec();
            for (&i, pair) in new.iter().zip(&pairs) {
                if let Some(a) = pair {
                    joined[*a].push(i);
                }
            }
            let joint = self.solve(&joined)?;
            let next = mutual_best(new.len(), tracks.len(), self.gate, |n, a| {
                joint.distance(&self.sightings[new[n]], a, pairs[n] == Some(a))
            });
            if next == pairs {
                break;
            }
            pairs = next;
        }
        Some(pairs)
    }

    /// The pairs under the one shift of the new frame that brings most sightings to known apples.
    ///
    /// Shifts that are tried are none, and those that bring one sighting onto one apple, as far as the prior allows.
    fn first_pairs(&self, tracks: &[Track], new: &[usize], joint: &Joint) -> Vec<Option<usize>> {
        let middle = middle_of(self.sightings);
        let Some(&first) = new.first() else {
            return Vec::new();
        };
        let prior = &self.priors[self.sightings[first].frame];
        let shift_prior: Matrix3<f64> = prior.fixed_view::<3, 3>(3, 3).into_owned();
        let mut turn_prior = Matrix6::zeros();
        turn_prior
            .fixed_view_mut::<3, 3>(0, 0)
            .copy_from(&prior.fixed_view::<3, 3>(0, 0));
        let mut differences = Vec::with_capacity(new.len() * tracks.len());
        for &i in new {
            let s = &self.sightings[i];
            let j = jacobian(&s.center, &middle);
            let turned = j * turn_prior * j.transpose();
            for place in &joint.places {
                differences.push((
                    s.center - place.center,
                    s.covariance + place.covariance + turned,
                ));
            }
        }
        let mut shifts = vec![(Vector3::zeros(), Matrix3::zeros())];
        for (difference, covariance) in &differences {
            if squared_distance(difference, &(covariance + shift_prior)) <= self.gate {
                shifts.push((*difference, *covariance));
            }
        }
        let mut best = (f64::NEG_INFINITY, vec![None; new.len()]);
        for (shift, spread) in shifts {
            let at = |n: usize, a: usize| {
                let (difference, covariance) = &differences[n * tracks.len() + a];
                squared_distance(&(difference - shift), &(covariance + spread))
            };
            let pairs = mutual_best(new.len(), tracks.len(), self.gate, at);
            let gain: f64 = pairs
                .iter()
                .enumerate()
                .filter_map(|(n, pair)| pair.map(|a| self.gate - at(n, a)))
                .sum();
            let score = gain - squared_distance(&shift, &(shift_prior + spread));
            if score > best.0 {
                best = (score, pairs);
            }
        }
        best.1
    }

    /// Takes out of each track what lies beyond the gate, the worst first.
    fn expel(&self, mut tracks: Vec<Track>) -> Option<(Vec<Track>, Joint)> {
        loop {
            let joint = self.solve(&tracks)?;
            let mut worst: Option<(f64, usize, usize)> = None;
            for (a, track) in tracks.iter().enumerate().filter(|(_, t)| t.len() > 1) {
                for (n, &i) in track.iter().enumerate() {
                    let distance = joint.distance(&self.sightings[i], a, true);
                    if distance > self.gate && worst.is_none_or(|w| distance > w.0) {
                        worst = Some((distance, a, n));
                    }
                }
            }
            let Some((_, a, n)) = worst else {
                return Some((tracks, joint));
            };
            let expelled = tracks[a].remove(n);
            tracks.push(vec![expelled]);
        }
    }
}

/// For each row the column that is nearest to it, and to which it is the nearest in turn, within the gate.
pub(crate) fn mutual_best(
    rows: usize,
    columns: usize,
    gate: f64,
    distance: impl Fn(usize, usize) -> f64,
) -> Vec<Option<usize>> {
    let mut of_row: Vec<(f64, Option<usize>)> = vec![(f64::INFINITY, None); rows];
    let mut of_column = vec![(f64::INFINITY, None); columns];
    for (r, row) in of_row.iter_mut().enumerate() {
        for (c, column) in of_column.iter_mut().enumerate() {
            let d = distance(r, c);
            if !(d <= gate) {
                continue;
            }
            if d < row.0 {
                *row = (d, Some(c));
            }
            if d < column.0 {
                *column = (d, Some(r));
            }
        }
    }
    let mutual = |(r, (_, c)): (usize, &(f64, Option<usize>))| {
        c.filter(|&c: &usize| of_column[c].1 == Some(r))
    };
    of_row.iter().enumerate().map(mutual).collect()
}
