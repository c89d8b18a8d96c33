//! One apple from its sightings.

use super::associate::mutual_best;
use super::chi_square::bound_2;
use super::direction::{Combined, angle, combine};
use super::joint::{Joint, Track, jacobian, squared_distance};
use super::record::{DirectionUse, FusedApple, FusedStatus, MovedRecord, SightingRecord};
use super::settings::FusionConfig;
use super::sighting::{DirectionSighting, Sighting};
use nalgebra::{Matrix6, Vector3};
use pomona_transforms::{Direction, RobotFrame, ToolOrientation};

/// What apples are made of.
pub(crate) struct AppleFusion<'a> {
    pub(crate) sightings: &'a [Sighting],
    pub(crate) tracks: &'a [Track],
    pub(crate) joint: &'a Joint,
    /// Covariance about the middle of what the poses of a camera at rest have in common.
    pub(crate) common: Option<&'a Matrix6<f64>>,
    pub(crate) middle: Vector3<f64>,
    pub(crate) gate: f64,
    pub(crate) config: &'a FusionConfig,
}

impl AppleFusion<'_> {
    /// All apples, in the order in which the frames show them first.
    pub(crate) fn all(&self) -> Vec<FusedApple> {
        let movements = self.movements();
        let gone: Vec<usize> = movements.iter().flatten().copied().collect();
        let mut order: Vec<usize> = (0..self.tracks.len())
            .filter(|a| !gone.contains(a))
            .collect();
        order.sort_by_key(|&a| {
            let other = movements[a].map(|b| &self.tracks[b]);
            let all = self.tracks[a].iter().chain(other.into_iter().flatten());
            all.min()
        });
        order
            .into_iter()
            .enumerate()
            .map(|(id, a)| self.apple(id, a, movements[a]))
            .collect()
    }

    fn radius(&self, track: &[usize]) -> (f64, f64) {
        let weights = track.iter().map(|&i| {
            (
                self.sightings[i].radius,
                self.sightings[i].radius_variance.recip(),
            )
        });
        let (sum, weight) = weights.fold((0.0, 0.0), |(s, w), (r, q)| (s + r * q, w + q));
        (sum / weight, weight.recip().sqrt())
    }

    fn last_frame(&self, track: &[usize]) -> usize {
        let frames = track.iter().map(|&i| self.sightings[i].frame);
        frames.max().unwrap_or(0)
    }

    /// For each track the one that is the same apple at another place, where it stood earlier.
    ///
    /// Two bodies cannot be in one place: tracks of different frames whose spheres overlap are one apple.
    fn movements(&self) -> Vec<Option<usize>> {
        let n = self.tracks.len();
        let frames = |a: usize| self.tracks[a].iter().map(move |&i| self.sightings[i].frame);
        let radii: Vec<f64> = self.tracks.iter().map(|t| self.radius(t).0).collect();
        let overlap = |a: usize, b: usize| {
            if a == b || frames(a).any(|f| frames(b).any(|g| f == g)) {
                return f64::INFINITY;
            }
            let way = self.joint.places[a].center - self.joint.places[b].center;
            let share = way.norm() / (radii[a] + radii[b]);
            let beyond = squared_distance(&way, &self.joint.difference(a, b)) > self.gate;
            if beyond { share } else { f64::INFINITY }
        };
        let pairs = mutual_best(n, n, self.config.moved_reach, overlap);
        (0..n)
            .map(|a| {
                let b = pairs[a]?;
                let later = self.last_frame(&self.tracks[a]) > self.last_frame(&self.tracks[b]);
                later.then_some(b)
            })
            .collect()
    }

    fn apple(&self, id: usize, a: usize, earlier: Option<usize>) -> FusedApple {
        let place = &self.joint.places[a];
        let current = &self.tracks[a];
        let mut covariance = place.covariance;
        if let Some(common) = self.common {
            let j = jacobian(&place.center, &self.middle);
            covariance += j * common * j.transpose();
        }
        let mut all = current.clone();
        all.extend(earlier.map(|b| &self.tracks[b]).into_iter().flatten());
        all.sort_unstable();
        let (radius, radius_sd) = self.radius(&all);

        let with: Vec<(usize, DirectionSighting)> = current
            .iter()
            .filter_map(|&i| Some((i, self.sightings[i].direction?)))
            .collect();
        let directions: Vec<DirectionSighting> = with.iter().map(|(_, d)| *d).collect();
        let gate = bound_2(self.config.direction_rate);
        let combined = combine(&directions, gate, self.config.repeated_error);
        let (status, reason) = self.judge(&all, current.len(), directions.len(), combined.as_ref());
        let used: Vec<(usize, bool)> = combined
            .iter()
            .flat_map(|c| &c.used)
            .copied()
            .collect::<Vec<_>>()
            .into_iter()
            .zip(&with)
            .map(|(used, (i, _))| (*i, used))
            .collect();
        let picked = combined.as_ref().filter(|_| status == FusedStatus::Picked);
        let unit = picked.map(|c| c.unit);
        let foot = unit
            .and_then(|unit| Some(place.center + unit.into_inner() * self.foot_distance(&used)?));
        let tool = unit.map(|u| ToolOrientation::along(&Direction::<RobotFrame>::from_unit(u)));
        FusedApple {
            id,
            status,
            center: place.center.into(),
            center_covariance: covariance.into(),
            radius,
            radius_sd,
            direction: unit.map(|u| u.into_inner().into()),
            direction_sd: picked.map(|c| c.sd),
            confidence: combined.as_ref().map(|c| c.confidence),
            reason,
            foot: foot.map(Into::into),
            quaternion_xyzw: tool.map(|t| t.quaternion_xyzw()),
            moved: earlier.map(|b| self.moved(a, b)),
            view_from: if picked.is_some() {
                Vec::new()
            } else {
                let views = all.iter().filter_map(|&i| self.sightings[i].view_from);
                views.map(Into::into).collect()
            },
            sightings: all
                .iter()
                .map(|&i| {
                    self.sighting(
                        i,
                        if current.contains(&i) {
                            a
                        } else {
                            earlier.unwrap_or(a)
                        },
                        a,
                        &used,
                        combined.as_ref(),
                    )
                })
                .collect(),
        }
    }

    /// `track` holds the sighting, `current` is where the apple is.
    fn sighting(
        &self,
        i: usize,
        track: usize,
        current: usize,
        used: &[(usize, bool)],
        combined: Option<&Combined>,
    ) -> SightingRecord {
        let s = &self.sightings[i];
        let direction = match (s.direction, used.iter().find(|(j, _)| *j == i)) {
            (None, _) => DirectionUse::None,
            (Some(_), _) if track != current => DirectionUse::Stale,
            (Some(_), Some((_, true))) => DirectionUse::Used,
            (Some(_), _) => DirectionUse::Outlier,
        };
        let off = s
            .direction
            .zip(combined)
            .map(|(d, c)| angle(&d.unit, &c.unit));
        SightingRecord {
            frame: s.frame,
            pick: s.pick,
            status: s.status,
            residual: (self.joint.corrected(s) - self.joint.places[track].center).norm(),
            direction,
            direction_off: off,
        }
    }

    /// The mean of the frames' distances of the foot, by the variances of the centres.
    fn foot_distance(&self, used: &[(usize, bool)]) -> Option<f64> {
        let (mut sum, mut weight) = (0.0, 0.0);
        for (i, _) in used.iter().filter(|(_, used)| *used) {
            let s = &self.sightings[*i];
            if let Some(distance) = s.foot_distance {
                let w = s.covariance.trace().recip();
                sum += distance * w;
                weight += w;
            }
        }
        (weight > 0.0).then(|| sum / weight)
    }

    fn moved(&self, a: usize, b: usize) -> MovedRecord {
        let from = self.joint.places[b].center;
        let by = self.joint.places[a].center - from;
        let along = by.try_normalize(1e-12).unwrap_or_default();
        let variance = along.dot(&(self.joint.difference(a, b) * along));
        let mut frames: Vec<usize> = self.tracks[b]
            .iter()
            .map(|&i| self.sightings[i].frame)
            .collect();
        frames.sort_unstable();
        MovedRecord {
            from: from.into(),
            by: by.into(),
            distance: by.norm(),
            sd: variance.max(0.0).sqrt(),
            frames,
        }
    }

    /// The status, and where it comes from in words.
    fn judge(
        &self,
        all: &[usize],
        current: usize,
        directions: usize,
        combined: Option<&Combined>,
    ) -> (FusedStatus, String) {
        let seen = format!("seen in {}", frames(all.len()));
        let seen = if current < all.len() {
            format!("{seen}, moved, {current} of them after that")
        } else {
            seen
        };
        let Some(combined) = combined else {
            let mut names: Vec<&str> = all
                .iter()
                .map(|&i| self.sightings[i].status.name())
                .collect();
            names.sort_unstable();
            names.dedup();
            let names = names.join(", ");
            return (
                FusedStatus::NoDirection,
                format!("{seen}, no direction: {names}"),
            );
        };
        let agreeing = combined.used.iter().filter(|used| **used).count();
        let mut reason = match (directions, agreeing) {
            (1, _) => format!("{seen}, a direction from 1"),
            (n, k) if n == k => format!("{seen}, {n} directions agree"),
            (n, k) => format!("{seen}, {k} of {n} directions agree"),
        };
        if combined.confidence >= self.config.least_confidence
            && !tied(agreeing, directions, combined)
        {
            return (FusedStatus::Picked, reason);
        }
        reason += ", not sure enough";
        if agreeing < directions {
            (FusedStatus::Contradiction, reason)
        } else {
            (FusedStatus::Unsure, reason)
        }
    }
}

/// Whether the directions contradict each other and none of them has even odds.
fn tied(agreeing: usize, directions: usize, combined: &Combined) -> bool {
    agreeing < directions && combined.confidence < 0.5
}

fn frames(count: usize) -> String {
    if count == 1 {
        "1 frame".to_owned()
    } else {
        format!("{count} frames")
    }
}
