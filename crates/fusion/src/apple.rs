//! One apple from its observations.

use crate::answer::{
    DirectionUse, FusedApple, FusedDirection, FusedObservation, FusedStatus, Movement, PositionUse,
};
use crate::direction::{CombinedDirection, combine};
use crate::joint::{JointEstimate, jacobian};
use crate::links::{Link, links};
use crate::observation::{Observation, ObservedDirection, mean_radius};
use crate::verdict::Findings;
use nalgebra::{Matrix3, Matrix6, Point3, Vector3};
use pomona::{FusionConfig, Status};
use pomona_statistics::chi_square_critical;
use pomona_transforms::{Position, RobotFrame, UncertainPosition};

/// Movements shorter than this have no direction along which to give a standard deviation, metres.
const MIN_MOVEMENT_M: f64 = 1e-12;

/// What apples are made of.
pub(crate) struct AppleFusion<'a> {
    pub(crate) estimate: &'a JointEstimate<'a>,
    /// Covariance about the centroid of the error that all frames have in common, where the camera is at rest.
    pub(crate) common_pose_error: Option<&'a Matrix6<f64>>,
    pub(crate) gate: f64,
    pub(crate) config: &'a FusionConfig,
}

/// The directions at an apple's current position.
struct Directions {
    /// Indices of the observations that have one.
    observations: Vec<usize>,
    combined: Option<CombinedDirection>,
}

impl Directions {
    /// Whether the direction of an observation agrees with the combined one; `None` where it is not of these.
    fn agrees(&self, observation: usize) -> Option<bool> {
        let n = self.observations.iter().position(|&i| i == observation)?;
        Some(self.combined.as_ref()?.agreeing[n])
    }
}

impl AppleFusion<'_> {
    /// All apples, in the order in which the frames show them first.
    pub(crate) fn apples(&self) -> Vec<FusedApple> {
        let links = links(self.estimate, self.gate, self.config);
        let replaced: Vec<usize> = links.iter().flatten().map(|l| l.other).collect();
        let mut current: Vec<usize> = (0..self.estimate.tracks.len())
            .filter(|track| !replaced.contains(track))
            .collect();
        current.sort_by_key(|&track| self.all_observations(track, links[track]).first().copied());
        current
            .into_iter()
            .enumerate()
            .map(|(id, track)| self.apple(id, track, links[track]))
            .collect()
    }

    /// The apple of a track, which is where it is now.
    fn apple(&self, id: usize, track: usize, link: Option<Link>) -> FusedApple {
        let observations = self.all_observations(track, link);
        let movement = link.filter(|link| link.moved);
        let (radius_m, radius_sd_m) = if movement.is_some() {
            mean_radius(observations.iter().map(|&i| self.observation(i)))
        } else {
            mean_radius(self.estimate.observations_of(track))
        };
        let directions = self.directions(track);
        let statuses: Vec<Status> = observations
            .iter()
            .map(|&i| self.observation(i).status)
            .collect();
        let findings = Findings {
            statuses: &statuses,
            current: self.estimate.tracks[track].len(),
            link,
            directions: directions.observations.len(),
            combined: directions.combined.as_ref(),
        };
        let (status, reason) = findings.verdict(self.config.least_confidence);
        let direction = (status == FusedStatus::Picked)
            .then(|| self.direction(track, &directions))
            .flatten();
        let next_views = if direction.is_some() {
            Vec::new()
        } else {
            let views = observations.iter().map(|&i| self.observation(i).next_view);
            views.flatten().collect()
        };
        FusedApple {
            id,
            status,
            center: self.center(track),
            radius_m,
            radius_sd_m,
            direction,
            confidence: directions.combined.as_ref().map(|c| c.confidence),
            reason,
            movement: movement.map(|link| self.movement(track, link.other)),
            next_views,
            observations: observations
                .iter()
                .map(|&i| self.fused_observation(i, track, link, &directions))
                .collect(),
        }
    }

    fn observation(&self, i: usize) -> &Observation {
        &self.estimate.observations[i]
    }

    /// The observations of an apple at its current and its other position, in the order of the frames.
    fn all_observations(&self, track: usize, link: Option<Link>) -> Vec<usize> {
        let mut all = self.estimate.tracks[track].clone();
        all.extend(
            link.map(|l| &self.estimate.tracks[l.other])
                .into_iter()
                .flatten(),
        );
        all.sort_unstable();
        all
    }

    /// The centre; errors that the poses have in common do not average out.
    fn center(&self, track: usize) -> UncertainPosition<RobotFrame> {
        let position = &self.estimate.positions[track];
        let common = self.common_pose_error.map_or_else(Matrix3::zeros, |error| {
            let j = jacobian(&position.center, &self.estimate.centroid);
            j * error * j.transpose()
        });
        UncertainPosition {
            position: robot_position(&position.center),
            covariance_m2: position.covariance + common,
        }
    }

    fn directions(&self, track: usize) -> Directions {
        let (observations, directions): (Vec<usize>, Vec<ObservedDirection>) = self.estimate.tracks
            [track]
            .iter()
            .filter_map(|&i| Some((i, self.observation(i).direction?)))
            .unzip();
        let gate = chi_square_critical(self.config.direction_rate, 2);
        Directions {
            observations,
            combined: combine(&directions, gate, self.config.repeated_error),
        }
    }

    fn direction(&self, track: usize, directions: &Directions) -> Option<FusedDirection> {
        let combined = directions.combined.as_ref()?;
        let center = self.estimate.positions[track].center;
        let foot = self
            .foot_distance(directions)
            .map(|distance_m| robot_position(&center).moved(&combined.direction, distance_m));
        Some(FusedDirection {
            direction: combined.direction,
            sd_rad: combined.sd_rad,
            foot,
        })
    }

    /// Mean of the agreeing frames' distances of the foot, weighted by the inverse variances of the centres, metres.
    fn foot_distance(&self, directions: &Directions) -> Option<f64> {
        let (mut sum, mut weight) = (0.0, 0.0);
        for &i in &directions.observations {
            let observation = self.observation(i);
            if let (Some(true), Some(distance)) =
                (directions.agrees(i), observation.foot_distance_m)
            {
                let w = observation.covariance.trace().recip();
                sum += distance * w;
                weight += w;
            }
        }
        (weight > 0.0).then(|| sum / weight)
    }

    /// The movement from the position of track `other` to that of `track`.
    fn movement(&self, track: usize, other: usize) -> Movement {
        let (by, covariance) = self.estimate.difference(track, other);
        let along = by.try_normalize(MIN_MOVEMENT_M).unwrap_or_default();
        let variance = along.dot(&(covariance * along));
        let mut frames: Vec<usize> = self
            .estimate
            .observations_of(other)
            .map(|o| o.frame)
            .collect();
        frames.sort_unstable();
        Movement {
            from: robot_position(&self.estimate.positions[other].center),
            by,
            sd_m: variance.max(0.0).sqrt(),
            frames,
        }
    }

    /// What observation `i` of the apple at `track` was used for.
    fn fused_observation(
        &self,
        i: usize,
        track: usize,
        link: Option<Link>,
        directions: &Directions,
    ) -> FusedObservation {
        let observation = self.observation(i);
        let elsewhere = link.filter(|_| !self.estimate.tracks[track].contains(&i));
        // An apple that has moved is compared with its position then, a misfit with the position that it contradicts.
        let (position_use, compared) = match elsewhere {
            None => (PositionUse::Used, track),
            Some(link) if link.moved => (PositionUse::Elsewhere, link.other),
            Some(_) => (PositionUse::Misfit, track),
        };
        let direction_use = match (observation.direction, directions.agrees(i)) {
            (None, _) => DirectionUse::None,
            (Some(_), _) if elsewhere.is_some() => DirectionUse::Stale,
            (Some(_), Some(true)) => DirectionUse::Used,
            (Some(_), _) => DirectionUse::Outlier,
        };
        let center = self.estimate.positions[compared].center;
        FusedObservation {
            frame: observation.frame,
            pick: observation.pick,
            status: observation.status,
            position_use,
            residual_m: (self.estimate.corrected(observation) - center).norm(),
            direction_use,
            direction_offset_rad: observation
                .direction
                .zip(directions.combined.as_ref())
                .map(|(own, combined)| own.direction.angle_to(&combined.direction)),
        }
    }
}

fn robot_position(center: &Vector3<f64>) -> Position<RobotFrame> {
    Position::new(Point3::from(*center))
}
