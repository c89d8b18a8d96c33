//! Tracks that are one apple at two positions.

use crate::joint::{JointEstimate, squared_distance};
use crate::observation::mean_radius;
use crate::pairs::mutually_nearest;
use pomona::FusionConfig;

/// Another track of the same apple.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Link {
    /// The track that gives way.
    pub(crate) other: usize,
    /// Whether the apple has moved from there; else the position of the other track is a misfit.
    pub(crate) moved: bool,
}

/// For each track the one that it replaces.
///
/// Two apples cannot be in one place: tracks of different frames whose spheres overlap are one apple. It has moved
/// where both positions are well visible and the radii agree, and then the later one replaces the earlier; else the position
/// that is less visible is a misfit.
pub(crate) fn links(
    estimate: &JointEstimate<'_>,
    gate: f64,
    config: &FusionConfig,
) -> Vec<Option<Link>> {
    let tracks: Vec<TrackSummary> = (0..estimate.tracks.len())
        .map(|a| TrackSummary::new(estimate, a))
        .collect();
    // Distance of the centres over the sum of the radii.
    let separation = |a: usize, b: usize| {
        if a == b || tracks[a].shares_frame(&tracks[b]) {
            return f64::INFINITY;
        }
        let distance = (estimate.positions[a].center - estimate.positions[b].center).norm();
        distance / (tracks[a].radius_m + tracks[b].radius_m)
    };
    let pairs = mutually_nearest(tracks.len(), tracks.len(), config.moved_reach, separation);
    let link = |a: usize| {
        let b = pairs[a]?;
        let (way, covariance) = estimate.difference(a, b);
        let (one, two) = (&tracks[a], &tracks[b]);
        let moved = squared_distance(&way, &covariance) > gate
            && one.same_radius(two, gate)
            && one.visible_fraction.min(two.visible_fraction) >= config.moved_visible;
        let replaces = if moved || one.visible_fraction == two.visible_fraction {
            one.last_frame > two.last_frame
        } else {
            one.visible_fraction > two.visible_fraction
        };
        replaces.then_some(Link { other: b, moved })
    };
    (0..tracks.len()).map(link).collect()
}

/// What decides between two tracks of one apple.
struct TrackSummary {
    frames: Vec<usize>,
    last_frame: usize,
    radius_m: f64,
    radius_sd_m: f64,
    /// Largest of its observations.
    visible_fraction: f64,
}

impl TrackSummary {
    fn new(estimate: &JointEstimate<'_>, track: usize) -> Self {
        let frames: Vec<usize> = estimate.observations_of(track).map(|o| o.frame).collect();
        let (radius_m, radius_sd_m) = mean_radius(estimate.observations_of(track));
        let visible = estimate.observations_of(track).map(|o| o.visible_fraction);
        Self {
            last_frame: frames.iter().copied().max().unwrap_or(0),
            frames,
            radius_m,
            radius_sd_m,
            visible_fraction: visible.fold(0.0, f64::max),
        }
    }

    fn shares_frame(&self, other: &Self) -> bool {
        self.frames.iter().any(|f| other.frames.contains(f))
    }

    fn same_radius(&self, other: &Self, gate: f64) -> bool {
        let variance = self.radius_sd_m.powi(2) + other.radius_sd_m.powi(2);
        (self.radius_m - other.radius_m).powi(2) <= gate * variance
    }
}
