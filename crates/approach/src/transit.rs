//! The clearance along a curved path, with nothing missed between two samples.

use crate::obstacles::{Hit, ObstacleFilter};
use crate::outline::{Outline, PlacedOutline};
use crate::shape::Shape;
use crate::swept_volume::SweptVolume;
use crate::{ClearanceConfig, Gripper, ObstacleMap, Path, Stage};

/// Intervals of a path segment, in each of which one bound on the speed holds.
const INTERVALS: usize = 12;

/// Range of the distance queries, in cutoffs: where nothing is near, the next sample is that far away, less one cutoff.
const LOOK_AHEAD: f64 = 3.0;
/// Relative error of a slack that is accepted, where that is more than the resolution.
const SHARE: f64 = 0.3;

/// An obstacle, and the time at which it is nearest.
pub(crate) type TimedHit = (Hit, f64);

/// Lower bound of the slack over the whole path, where the least sampled one is `least`.
pub(crate) fn floor(least: f64, resolution: f64) -> f64 {
    (least - resolution).min(least * (1.0 - SHARE))
}

/// The nearest obstacle during the transit.
///
/// Conservative advancement (Mirtich 1996, Section 2.3.2): where the slack is s, no point of the gripper
/// can touch the obstacle before it has moved by s. So the next sample may be that much later, by a bound on the
/// speed of the fastest point. Slacks are needed to within a resolution ε or a relative error, so a sample is taken
/// whenever the slack might fall below the [`floor`] of the least one so far (the cutoff, while all are above it). A
/// slack under ε is a collision: then all slacks between two samples are at least 0.
///
/// Where any collision ends the search, only the sign of the slack matters, and the path is searched backwards: most
/// paths that collide do so at their end, among the branches.
///
/// # Errors
///
/// The first sample with a slack under ε.
pub(crate) fn nearest(
    path: &Path,
    intervals: &[Interval],
    open: &OpenGripper,
    scene: &ObstacleMap,
    filter: &ObstacleFilter<'_>,
    config: &ClearanceConfig,
) -> Result<Option<TimedHit>, TimedHit> {
    let resolution = config.resolution_m;
    let ahead = LOOK_AHEAD * config.cutoff_m;
    let mut least: Option<TimedHit> = None;
    let least_slack = |least: &Option<TimedHit>| least.map_or(config.cutoff_m, |(h, _)| h.slack());
    let mut allowance = 0.0;
    let mut first = true;
    // A path that collides mostly does so near the fruit.
    let backwards = filter.any_collision;
    for number in 0..intervals.len() {
        let interval = if backwards {
            &intervals[intervals.len() - 1 - number]
        } else {
            &intervals[number]
        };
        let &Interval {
            mut from,
            mut to,
            speed,
        } = interval;
        if backwards {
            std::mem::swap(&mut from, &mut to);
        }
        let length = (to - from).abs();
        let mut gone = 0.0;
        loop {
            let left = (length - gone) * speed;
            if !first && left <= allowance {
                allowance -= left;
                break;
            }
            if !first {
                gone += allowance / speed;
            }
            first = false;
            let time = if to > from { from + gone } else { from - gone };
            let pose = path.pose(time);
            let bodies = open.bodies.map(|body| body.moved(&pose));
            let shape = Shape::with_outline(&bodies, PlacedOutline::new(&open.outline, &pose));
            let hit = scene.nearest(&shape, filter, config, ahead);
            let slack = hit.map_or(ahead, |h| h.slack());
            if let Some(hit) = hit
                && slack < least_slack(&least)
            {
                least = Some((hit, time));
            }
            if slack < resolution {
                return hit.map_or(Ok(least), |hit| Err((hit, time)));
            }
            allowance = if filter.any_collision {
                slack
            } else {
                slack - floor(least_slack(&least), resolution)
            };
        }
    }
    Ok(least)
}

/// A part of the transit, and a bound on the speed of the gripper's points within it.
pub(crate) struct Interval {
    from: f64,
    to: f64,
    speed: f64,
}

/// The intervals of the transit from the start to the pre-grasp.
pub(crate) fn intervals(path: &Path, open: &OpenGripper) -> Vec<Interval> {
    let mut intervals = Vec::with_capacity(2 * INTERVALS);
    for piece in path.pieces().iter().filter(|p| p.stage == Stage::Transit) {
        let step = piece.curve.duration_s / INTERVALS as f64;
        for i in 0..INTERVALS {
            let from = piece.start_s + i as f64 * step;
            let to = from + step;
            let speed = path.point_speed_bound(piece, from, to, open.radius_about_tool);
            intervals.push(Interval { from, to, speed });
        }
    }
    intervals
}

/// The open gripper.
#[derive(Clone, Debug)]
pub(crate) struct OpenGripper {
    bodies: [SweptVolume; 4],
    outline: Outline,
    radius_about_tool: f64,
}

impl OpenGripper {
    pub(crate) fn of(gripper: &Gripper) -> Self {
        let bodies = gripper.open();
        Self {
            outline: Outline::of(&bodies),
            radius_about_tool: gripper.radius_about_tool(),
            bodies,
        }
    }
}
