//! From a line of the image to an axis in space.

use super::evidence::{Band, Evidence, IN_FRONT_RADII};
use super::line::ImageLine;
use super::view::WoodSearch;
use crate::robust::axis::{Observation, Parabola, powers};
use nalgebra::Point3;
use pomona_cloud::DepthImage;
use pomona_geometry::Line;
use std::f64::consts::FRAC_PI_4;

/// A line of the image in space. Metres.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lifted {
    pub(crate) axis: Line,
    /// Its point nearest to the apple.
    pub(crate) foot: Point3<f64>,
    /// Radius of the branch.
    pub(crate) radius: f64,
    /// Standard deviation of the foot along the ray.
    pub(crate) depth_sd: f64,
    /// Readings that its depth comes from.
    pub(crate) readings: usize,
    /// Root mean square of the readings about the fitted depth.
    pub(crate) rms: f64,
}

/// Fewest readings that a depth is taken from.
const LEAST_READINGS: usize = 8;

/// Probability of wood from which the reading of a pixel counts.
const LEAST_PROBABILITY: f64 = 0.3;

/// Length to either side of the visible piece's middle from which readings are taken, radii of the apple.
const READINGS_RADII: f64 = 1.0;

/// Distance in depth from the apple's centre from which wood belongs to something else, such as the next row, radii
/// of the apple.
const FAR_RADII: f64 = 4.0;

/// Share that is taken of the depth of wood behind the apple's centre in smeared depth: readings on thin
/// wood are mixed with those of what is behind it.
pub(crate) const DEPTH_SHARE: f64 = 0.3;

/// Standard deviation of the depth of wood of which nothing is known but that it is near the apple, radii of the
/// apple.
const UNKNOWN_SD_RADII: f64 = 0.8;

/// Where the robust weight ends for each step of the fit of the depths, standard deviations.
const CUTOFFS: [f64; 3] = [20.0, 8.0, 3.0];

/// Standard deviation of a reading on wood beside its noise, metres: bark, and edges that are smeared.
const SURFACE_SD_M: f64 = 0.003;

/// Half the length over which the direction in space is taken, and the farthest that the foot moves along the axis
/// because of its slant, radii of the apple.
const HALF_CHORD_RADII: f64 = 0.5;
const FOOT_MOVES_RADII: f64 = 0.7;

impl Lifted {
    /// The axis of `line` about the foot that `evidence` tells; `None` where depth says that it is nothing of the
    /// apple's surroundings.
    pub(crate) fn new(
        search: &WoodSearch<'_>,
        band: &Band<'_>,
        line: &ImageLine,
        evidence: &Evidence,
        trust: f64,
    ) -> Option<Self> {
        let apple = &search.apple;
        let (r, z0) = (apple.radius, apple.center.z);
        let pixel = search.pixel();
        let observed = observations(search, band, line, evidence);
        let readings = observed.len();
        let scale = search.sigma.hypot(SURFACE_SD_M);
        let bend = search.config.branch_bend_sd_per_m;
        let fit = (readings >= LEAST_READINGS)
            .then(|| Parabola::fit(&observed, bend, scale, &CUTOFFS))
            .flatten();
        let (depths, depth_sd, rms) = fit.map_or((None, UNKNOWN_SD_RADII * r, 0.0), |fit| {
            let s = (evidence.foot - evidence.middle) * pixel;
            (Some(fit.coefficients), fit.sd_at(s), fit.rms)
        });
        let depth_at = |s: f64| {
            let behind = depths.map_or(0.0, |c| c.dot(&powers((s - evidence.middle) * pixel)));
            behind.clamp(-FAR_RADII * r, 2.0 * FAR_RADII * r)
        };
        if depth_at(evidence.foot).abs() >= FAR_RADII * r {
            return None;
        }
        let share = DEPTH_SHARE + (1.0 - DEPTH_SHARE) * trust;
        let depth_at = |s: f64| share * depth_at(s);
        let behind = depth_at(evidence.foot);
        let radius = (line.half_width * pixel).clamp(
            search.config.branch_radius_min_m,
            search.config.branch_radius_max_m,
        );
        // What is seen before the apple lies on it or nearer.
        let inner = 1.0 - evidence.distance * evidence.distance;
        let front = if evidence.distance < IN_FRONT_RADII {
            -r * inner.max(0.0).sqrt() - 2.0 * radius
        } else {
            f64::INFINITY
        };
        let shift = (front - behind).min(0.0);
        let half = HALF_CHORD_RADII * band.radius;
        let at = |s: f64| {
            let z = z0 + depth_at(s) + shift + FRAC_PI_4 * radius;
            let p = line.at(s, 0.0);
            search.point_at((p.0 + band.shift.0, p.1 + band.shift.1), z)
        };
        let (a, b) = (at(evidence.foot - half)?, at(evidence.foot + half)?);
        let middle = at(evidence.foot)?;
        let axis = Line::new(middle, b - a)?;
        let along = (apple.center - middle).dot(&axis.direction);
        let most = FOOT_MOVES_RADII * r;
        // An axis that ends short of the perpendicular has its nearest point at its end.
        let ends = (evidence.foot - line.along_to(band.center)).abs() > 0.5;
        let along = if ends { 0.0 } else { along.clamp(-most, most) };
        Some(Self {
            axis,
            foot: middle + axis.direction.into_inner() * along,
            radius,
            depth_sd,
            readings,
            rms,
        })
    }
}

/// The reading of a pixel, where there is one.
pub(crate) fn reading(depth: &DepthImage, u: f64, v: f64) -> Option<u16> {
    let inside = (0.0..depth.width as f64).contains(&u) && (0.0..depth.height as f64).contains(&v);
    let reading = inside.then(|| depth.readings[v as usize * depth.width + u as usize]);
    reading.filter(|z| *z > 0)
}

/// Depths of the readings on the visible piece, against the apple's centre, by the length along the line.
fn observations(
    search: &WoodSearch<'_>,
    band: &Band<'_>,
    line: &ImageLine,
    evidence: &Evidence,
) -> Vec<Observation> {
    let depth = search.depth;
    let (pixel, scale) = (search.pixel(), search.projection.camera.depth_scale);
    let reach = (READINGS_RADII * band.radius).round() as i32;
    let half = (line.half_width.round() as i32).max(1);
    let mut found = Vec::new();
    for k in -reach..=reach {
        for aside in -half..=half {
            let p = line.at(evidence.middle + f64::from(k), f64::from(aside));
            let weight = band.probability(p);
            if weight < LEAST_PROBABILITY {
                continue;
            }
            let (u, v) = (p.0 + band.shift.0, p.1 + band.shift.1);
            let Some(reading) = reading(depth, u.round(), v.round()) else {
                continue;
            };
            found.push(Observation {
                s: f64::from(k) * pixel,
                value: f64::from(reading) * scale - search.apple.center.z,
                weight,
            });
        }
    }
    found
}
