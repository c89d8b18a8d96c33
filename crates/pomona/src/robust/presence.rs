//! How probably a box holds an apple: a logistic model of how its readings and their colour agree with the spheroid
//! fitted to them.
//!
//! Something can be fitted to most boxes. An apple shows much of its outline's area, bends in every direction, ends where
//! the spheroid does, and has nothing behind it in sight.

use super::apple::{AppleBuffers, AppleSearch, SeenApple};
use super::silhouette;
use crate::chromaticity::chromaticity;
use crate::outcome::PRESENCE_FEATURES;
use crate::roundness::Roundness;
use pomona_cloud::ColorImage;

/// Number of features.
const N: usize = PRESENCE_FEATURES.len();

/// Coefficients of the logistic model of 'the box holds an apple', in the order of [`PRESENCE_FEATURES`].
///
/// Fitted to boxes about apples and on nothing in scenes of `orchard`, `rivals`, `harsh`, `harsh-kinect`,
/// `harsh-azure-kinect`, `harsh-d400`, `dense`, `row` and `repeat474-dense` that no suite is evaluated on. `cargo xtask
/// fit-presence` fits them again.
pub const PRESENCE_MODEL: [f64; N] = [
    10.622, 2.365, 2.921, 2.023, -2.257, -5.265, -8.685, 5.791, -0.602, 0.663, -0.498, 24.562,
    -1.649, -0.847, 1.803, -2.096, 5.042, 6.987,
];

/// Presence below which a box is refused: it holds more probably nothing than an apple.
pub(crate) const LEAST_PRESENCE: f64 = 0.5;

/// Standard deviation of a curvature, in those of the spheroid, for which it counts half.
const CURVATURE_SD: f64 = 0.3;

/// Range of curvatures, in those of the spheroid.
const CURVATURES: (f64, f64) = (-1.0, 1.2);

/// Least share of an outline that counts as visible.
const LEAST_VISIBLE: f64 = 0.01;

/// Red less green, as shares of the sum of the channels, up to which bark, soil and dry leaves reach. Only what exceeds it
/// speaks for an apple, and nothing speaks against one: apples may be green, and images grey.
const BARK_REDNESS: f64 = 0.1;

/// Redness beyond that from which on nothing is redder.
const MOST_REDNESS: f64 = 0.3;

/// A ray that passes nearer than this many radii to the centre must meet the apple, noise or not.
const CORE: f64 = 0.8;

/// Distance of a reading from the surface up to which it may be of it: metres, and standard deviations of a reading.
const SURFACE_M: f64 = 0.0015;
const SURFACE_SIGMAS: f64 = 2.5;

/// Distances from the surface up to which the mean of a block is of it, in those of a reading.
const BLOCK_BAND: f64 = 1.5;

/// Pixels within which a silhouette ray agrees with the spheroid.
const SILHOUETTE_TOLERANCE_PX: f64 = 2.5;

/// What the readings of the patch show, on a grid.
#[derive(Clone, Copy, Debug, Default)]
struct Readings {
    surface: usize,
    behind: usize,
    /// Of those behind, the ones seen through the core.
    through: usize,
    in_front: usize,
    /// Pixels of the surface that have a colour, and the sum of their red less green.
    colored: usize,
    redness: f64,
}

/// Share of `part` in `all`; 0 of nothing.
fn share(part: usize, all: usize) -> f64 {
    part as f64 / all.max(1) as f64
}

/// What the probability is computed from. `buffers` are those of the fit, `smear` that of the frame's depth.
pub(crate) fn features(
    search: &AppleSearch<'_>,
    buffers: &AppleBuffers,
    found: &SeenApple,
    color: &ColorImage,
    smear: f64,
) -> [f64; N] {
    let spheroid = &found.fit.spheroid;
    let readings = readings(search, buffers, found, color);
    let Readings {
        surface, behind, ..
    } = readings;
    let support = share(surface, surface + behind + readings.in_front);
    let through = share(readings.through, surface + readings.through);
    let redness = readings.redness / readings.colored.max(1) as f64 - BARK_REDNESS;
    let (curvature, known) = curvature(search, buffers, found);
    let tolerance = SILHOUETTE_TOLERANCE_PX * search.pixel(spheroid);
    let outline = silhouette::agreeing_share(&buffers.rays, spheroid, tolerance);
    let agreement = found.agreement.clamp(-1.0, 1.0);
    let visible = found.visible_share.clamp(LEAST_VISIBLE, 1.0).ln();
    let fruit = search.fruit;
    let radius = ((spheroid.radius - fruit.prior_mean()) / fruit.prior_sd()).clamp(-3.0, 3.0);
    [
        1.0,
        agreement,
        visible,
        curvature,
        known,
        support,
        through,
        outline,
        beyond(search, found),
        radius,
        radius * radius,
        redness.clamp(0.0, MOST_REDNESS),
        smear,
        smear * agreement,
        smear * visible,
        smear * curvature,
        smear * support,
        smear * outline,
    ]
}

/// Probability that the box holds an apple.
pub(crate) fn probability(features: &[f64; N]) -> f64 {
    let sum: f64 = features
        .iter()
        .zip(PRESENCE_MODEL)
        .map(|(f, m)| f * m)
        .sum();
    1.0 / (1.0 + (-sum).exp())
}

/// Counts the readings of the patch on a grid as coarse as the blocks.
fn readings(
    search: &AppleSearch<'_>,
    buffers: &AppleBuffers,
    found: &SeenApple,
    color: &ColorImage,
) -> Readings {
    let (patch, spheroid) = (&buffers.patch, &found.fit.spheroid);
    let (c, r) = (spheroid.center, spheroid.radius);
    let band = band(search, found);
    let mut seen = Readings::default();
    for y in (0..patch.height).step_by(search.block_side()) {
        for x in (0..patch.width).step_by(search.block_side()) {
            let i = y * patch.width + x;
            let z = patch.z[i];
            if z == 0.0 {
                continue;
            }
            let p = patch.point_at(x, y, z);
            let distance = spheroid.signed_distance(&p);
            if distance.abs() <= band && p.z <= c.z + band {
                seen.surface += 1;
                if let Some(shares) = chromaticity(color, patch.image_index(i) as usize) {
                    seen.colored += 1;
                    seen.redness += shares.x - shares.y;
                }
                continue;
            }
            // Squared distance of the centre from the ray.
            let (lx, ly) = (p.x / p.z * c.z - c.x, p.y / p.z * c.z - c.y);
            let off_axis = lx * lx + ly * ly;
            if off_axis >= r * r {
                continue;
            }
            if distance > 0.0 && p.z < c.z {
                seen.in_front += 1;
            } else {
                seen.behind += 1;
                seen.through += usize::from(off_axis < CORE * CORE * r * r);
            }
        }
    }
    seen
}

/// Distance from the surface within which a reading is of it, metres.
fn band(search: &AppleSearch<'_>, found: &SeenApple) -> f64 {
    let sigma = search.noise.sigma(found.fit.spheroid.center.z);
    SURFACE_M + SURFACE_SIGMAS * sigma.hypot(search.trust.shape_sd_m)
}

/// The lesser principal curvature of the surface in those of the spheroid, and how well it is known, from 0 to 1. The
/// former is weighted by the latter.
fn curvature(search: &AppleSearch<'_>, buffers: &AppleBuffers, found: &SeenApple) -> (f64, f64) {
    let spheroid = &found.fit.spheroid;
    let band = BLOCK_BAND * band(search, found);
    let points = buffers.points.iter().map(|point| point.0);
    let near =
        points.filter(|p| spheroid.signed_distance(p).abs() <= band && p.z <= spheroid.center.z);
    let sigma =
        search.noise.sigma(spheroid.center.z) * search.shared(1.0 / search.block_side() as f64);
    Roundness::of(near, &spheroid.sphere(), sigma).map_or((0.0, 0.0), |round| {
        let known = 1.0 / (1.0 + (round.least_sd / CURVATURE_SD).powi(2));
        (round.least.clamp(CURVATURES.0, CURVATURES.1) * known, known)
    })
}

/// What of the box lies beyond the spheroid's outline, all sides together, in its diameters; 1 at most.
fn beyond(search: &AppleSearch<'_>, found: &SeenApple) -> f64 {
    let spheroid = &found.fit.spheroid;
    let Some((u, v)) = search.projection.project(&spheroid.center) else {
        return 1.0;
    };
    let half = spheroid.radius / search.pixel(spheroid);
    let b = search.bounds;
    let edges = [
        u - half - b.x_min,
        v - half - b.y_min,
        b.x_max - u - half,
        b.y_max - v - half,
    ];
    let beyond: f64 = edges.into_iter().map(|edge| edge.max(0.0)).sum();
    (beyond / (2.0 * half)).min(1.0)
}
