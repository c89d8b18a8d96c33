//! One apple from its sightings.

use crate::associate::mutual_best;
use crate::chi_square::bound_2;
use crate::direction::{Combined, angle, combine};
use crate::joint::{Joint, Track, jacobian, squared_distance};
use crate::record::{DirectionUse, FusedApple, FusedStatus, MovedRecord, PlaceUse, SightingRecord};
use crate::sighting::{DirectionSighting, Sighting};
use nalgebra::{Matrix6, Vector3};
use pomona::FusionConfig;
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

/// Another track of the same apple.
#[derive(Clone, Copy)]
struct Link {
    other: usize,
    /// Whether it has moved; else the other place is a misfit.
    moved: bool,
}

impl AppleFusion<'_> {
    /// All apples, in the order in which the frames show them first.
    pub(crate) fn all(&self) -> Vec<FusedApple> {
        let links = self.links();
        let gone: Vec<usize> = links.iter().flatten().map(|l| l.other).collect();
        let mut order: Vec<usize> = (0..self.tracks.len())
            .filter(|a| !gone.contains(a))
            .collect();
        order.sort_by_key(|&a| {
            let other = links[a].map(|l| &self.tracks[l.other]);
            let all = self.tracks[a].iter().chain(other.into_iter().flatten());
            all.min()
        });
        order
            .into_iter()
            .enumerate()
            .map(|(id, a)| self.apple(id, a, links[a]))
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

    /// Largest visible share among a track's sightings; a method that states none is trusted.
    fn visible(&self, track: &[usize]) -> f64 {
        let shares = track.iter().map(|&i| self.sightings[i].visible_share);
        shares.fold(0.0, f64::max)
    }

    /// For each track the one that is the same apple at another place.
    ///
    /// Two bodies cannot be in one place: tracks of different frames whose spheres overlap are one apple. It has moved
    /// where both places are well seen and the radii agree; else the place that is seen worse is a misfit.
    fn links(&self) -> Vec<Option<Link>> {
        let n = self.tracks.len();
        let frames = |a: usize| self.tracks[a].iter().map(move |&i| self.sightings[i].frame);
        let radii: Vec<(f64, f64)> = self.tracks.iter().map(|t| self.radius(t)).collect();
        let overlap = |a: usize, b: usize| {
            if a == b || frames(a).any(|f| frames(b).any(|g| f == g)) {
                return f64::INFINITY;
            }
            let way = self.joint.places[a].center - self.joint.places[b].center;
            way.norm() / (radii[a].0 + radii[b].0)
        };
        let pairs = mutual_best(n, n, self.config.moved_reach, overlap);
        let link = |a: usize| {
            let b = pairs[a]?;
            let seen = [a, b].map(|t| self.visible(&self.tracks[t]));
            let variance = radii[a].1.powi(2) + radii[b].1.powi(2);
            let alike = (radii[a].0 - radii[b].0).powi(2) <= self.gate * variance;
            let way = self.joint.places[a].center - self.joint.places[b].center;
            let beyond = squared_distance(&way, &self.joint.difference(a, b)) > self.gate;
            let moved = beyond && alike && seen.iter().all(|v| *v >= self.config.moved_visible);
            let last = [a, b].map(|t| self.last_frame(&self.tracks[t]));
            let leads = if moved || seen[0] == seen[1] {
                last[0] > last[1]
            } else {
                seen[0] > seen[1]
            };
            leads.then_some(Link { other: b, moved })
        };
        (0..n).map(link).collect()
    }

    fn apple(&self, id: usize, a: usize, link: Option<Link>) -> FusedApple {
        let place = &self.joint.places[a];
        let current = &self.tracks[a];
        let mut covariance = place.covariance;
        if let Some(common) = self.common {
            let j = jacobian(&place.center, &self.middle);
            covariance += j * common * j.transpose();
        }
        let mut all = current.clone();
        all.extend(link.map(|l| &self.tracks[l.other]).into_iter().flatten());
        all.sort_unstable();
        let moved = link.filter(|l| l.moved);
        let (radius, radius_sd) = self.radius(if moved.is_some() { &all } else { current });

        let with: Vec<(usize, DirectionSighting)> = current
            .iter()
            .filter_map(|&i| Some((i, self.sightings[i].direction?)))
            .collect();
        let directions: Vec<DirectionSighting> = with.iter().map(|(_, d)| *d).collect();
        let gate = bound_2(self.config.direction_rate);
        let combined = combine(&directions, gate, self.config.repeated_error);
        let (status, reason) = self.judge(
            &all,
            (current.len(), link),
            directions.len(),
            combined.as_ref(),
        );
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
            moved: moved.map(|l| self.moved(a, l.other)),
            view_from: if picked.is_some() {
                Vec::new()
            } else {
                let views = all.iter().filter_map(|&i| self.sightings[i].view_from);
                views.map(Into::into).collect()
            },
            sightings: all
                .iter()
                .map(|&i| {
                    let elsewhere = link.filter(|_| !current.contains(&i));
                    let mut sighting = self.sighting(
                        i,
                        elsewhere.map_or(a, |l| l.other),
                        a,
                        &used,
                        combined.as_ref(),
                    );
                    if let Some(link) = elsewhere {
                        sighting.place = if link.moved {
                            PlaceUse::Elsewhere
                        } else {
                            PlaceUse::Misfit
                        };
                        if !link.moved {
                            sighting.residual =
                                (self.joint.corrected(&self.sightings[i]) - place.center).norm();
                        }
                    }
                    sighting
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
            place: PlaceUse::Used,
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
        (current, link): (usize, Option<Link>),
        directions: usize,
        combined: Option<&Combined>,
    ) -> (FusedStatus, String) {
        let seen = format!("seen in {}", frames(all.len()));
        let seen = match link {
            Some(link) if link.moved => format!("{seen}, moved, {current} of them after that"),
            Some(_) => format!("{seen}, {} of them a misfit", all.len() - current),
            None => seen,
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
