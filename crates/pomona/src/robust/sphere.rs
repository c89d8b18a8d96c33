//! Spheres that compete for the points of a box.

use super::blocks::Blocks;
use crate::config::{Radii, RobustConfig};
use crate::optics::Projection;
use nalgebra::Point3;
use pomona_cloud::PixelBox;
use pomona_fit::sphere_through;
use pomona_geometry::Sphere;
use rand_chacha::ChaCha8Rng;
use rand_core::Rng;

/// Points on which candidates are compared.
const PREVIEW: usize = 180;

/// Depths at which spheres in the box's frame are tried.
const FRONTS: usize = 12;

/// Distance between box and sphere that costs one unit of disagreement: pixels, …
const SLACK_PX: f64 = 4.0;

/// … and a share of the box's longer side.
const SLACK_SHARE: f64 = 0.05;

/// Largest disagreement by a side on which the box reaches over the sphere.
const OVERHANG_LIMIT: f64 = 9.0;

/// Disagreement of a sphere that reaches over the box by half of its side: partly hidden apples do.
const HIDDEN_WEIGHT: f64 = 0.15;

/// Limit of the square in it.
const HIDDEN_LIMIT: f64 = 4.0;

/// Pixels by which boxes are wider than the apple on each side.
const BOX_MARGIN_PX: f64 = 2.0;

/// Room between the box's shorter side and the sphere, as a share of the radius, from which several places are tried.
const LEAST_ROOM: f64 = 0.1;

/// Share of the radius within which a reading behind the centre contradicts the sphere.
const CORE_SHARE: f32 = 0.85;

/// The box of an apple, as rays: the extremes of x/z and y/z.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BoxRays {
    x: (f64, f64),
    y: (f64, f64),
    /// Of one pixel.
    pixel: f64,
}

impl BoxRays {
    /// `None` where the lens has no ray at a corner, or the box no size.
    pub(crate) fn new(bounds: &PixelBox, projection: &Projection<'_>) -> Option<Self> {
        let low = projection.ray(bounds.x_min, bounds.y_min)?;
        let high = projection.ray(bounds.x_max, bounds.y_max)?;
        (low.0 < high.0 && low.1 < high.1).then(|| Self {
            x: (low.0, high.0),
            y: (low.1, high.1),
            pixel: projection.pixel_m(1.0),
        })
    }

    fn sides(&self) -> (f64, f64) {
        (self.x.1 - self.x.0, self.y.1 - self.y.0)
    }

    /// How badly a sphere's outline agrees with the box: 0 where the box frames it, growing fast with every side on which
    /// the box reaches overhang it, and slowly where it reaches overhang the box, as that of a partly hidden
    /// apple does.
    pub(crate) fn disagreement(&self, sphere: &Sphere) -> f64 {
        let z = sphere.center.z;
        if z <= sphere.radius {
            return f64::INFINITY;
        }
        let r = sphere.radius / (z * z - sphere.radius * sphere.radius).sqrt();
        let (x, y) = (sphere.center.x / z, sphere.center.y / z);
        let (w, h) = self.sides();
        let size = w.max(h);
        let slack = SLACK_PX * self.pixel + SLACK_SHARE * size;
        let side = |overhang: f64| {
            if overhang > 0.0 {
                (overhang / slack).powi(2).min(OVERHANG_LIMIT)
            } else {
                HIDDEN_WEIGHT * (overhang / (0.5 * size)).powi(2).min(HIDDEN_LIMIT)
            }
        };
        side((x - r) - self.x.0)
            + side(self.x.1 - (x + r))
            + side((y - r) - self.y.0)
            + side(self.y.1 - (y + r))
    }

    /// Spheres whose outline fills the longer side of the box, in the middle and at both ends of the shorter one,
    /// with their front at each of the given depths.
    fn framed(&self, fronts: &[f64]) -> impl Iterator<Item = Sphere> {
        let (w, h) = self.sides();
        // Boxes are a little wider than what they hold.
        let half = 0.5 * w.max(h) - BOX_MARGIN_PX * self.pixel;
        let places = |(low, high): (f64, f64)| {
            let middle = 0.5 * (low + high);
            let room = 0.5 * w.max(h) - 0.5 * (high - low);
            if room > LEAST_ROOM * half {
                vec![middle - room, middle, middle + room]
            } else {
                vec![middle]
            }
        };
        let (xs, ys) = (places(self.x), places(self.y));
        let mut spheres = Vec::with_capacity(fronts.len() * xs.len() * ys.len());
        for &front in fronts {
            let r = half * front / (1.0 - half).max(0.5);
            let z = front + r;
            for &x in &xs {
                let at = |&y: &f64| Sphere::new(Point3::new(x * z, y * z, z), r);
                spheres.extend(ys.iter().filter_map(at));
            }
        }
        spheres.into_iter()
    }
}

/// Support of a sphere: the sum over the points of 1 − (d/t)² within the threshold t, less one for every
/// point seen through it, as a share of all points.
#[expect(
    clippy::needless_bitwise_bool,
    reason = "a branch in the inner loop keeps it from being vectorised"
)]
pub(crate) fn support(points: &Blocks, sphere: &Sphere, threshold: f64) -> f64 {
    let c = [sphere.center.x, sphere.center.y, sphere.center.z].map(|c| c as f32);
    let (r, t) = (sphere.radius as f32, threshold as f32);
    let inverse = 1.0 / (t * t);
    let core = (CORE_SHARE * r) * (CORE_SHARE * r);
    let mut sum = 0.0f32;
    for ((&x, &y), &z) in points.x.iter().zip(&points.y).zip(&points.z) {
        let (dx, dy, dz) = (x - c[0], y - c[1], z - c[2]);
        let d = (dx * dx + dy * dy + dz * dz).sqrt() - r;
        sum += (1.0 - d * d * inverse).max(0.0);
        // A reading behind the centre whose ray passes the core: no apple is there.
        let (lx, ly) = (x * c[2] - c[0] * z, y * c[2] - c[1] * z);
        let through = (dz > 0.0) & (lx * lx + ly * ly < core * z * z);
        sum -= f32::from(u8::from(through));
    }
    f64::from(sum) / points.len().max(1) as f64
}

/// Uniform number below `n` (at least 1).
fn below(rng: &mut ChaCha8Rng, n: usize) -> usize {
    ((u64::from(rng.next_u32()) * n as u64) >> 32) as usize
}

/// The best few spheres, best first: those in the frame of the box, and spheres through four random points.
pub(crate) fn candidates(
    points: &Blocks,
    bounds: &BoxRays,
    config: &RobustConfig,
    radii: Radii,
    threshold: f64,
    rng: &mut ChaCha8Rng,
) -> Vec<Sphere> {
    let preview = points.thinned(PREVIEW);
    let mut best: Vec<(f64, Sphere)> = Vec::with_capacity(config.sphere_kept + 1);
    let mut consider = |sphere: Sphere| {
        let r = sphere.radius;
        if !radii.contains(r) {
            return;
        }
        let against = config.box_weight * bounds.disagreement(&sphere);
        let worst = best.last().map_or(f64::NEG_INFINITY, |b| b.0);
        let full = best.len() >= config.sphere_kept;
        // Support is at most 1: most spheres need not be looked at.
        if full && 1.0 - against <= worst {
            return;
        }
        let score = support(&preview, &sphere, threshold) - against;
        if !full || score > worst {
            let place = best.partition_point(|b| b.0 >= score);
            best.insert(place, (score, sphere));
            best.truncate(config.sphere_kept);
        }
    };
    let mut depths = preview.z.clone();
    depths.sort_by(f32::total_cmp);
    if depths.is_empty() {
        return Vec::new();
    }
    let fronts: Vec<f64> = (0..FRONTS)
        .map(|k| f64::from(depths[k * (depths.len() - 1) / FRONTS]))
        .collect();
    bounds.framed(&fronts).for_each(&mut consider);
    for _ in 0..config.sphere_draws {
        let corners = [0u8; 4].map(|_| points.get(below(rng, points.len())));
        if let Some(sphere) = sphere_through(corners)
            && sphere.center.z > corners[0].z - sphere.radius
        {
            consider(sphere);
        }
    }
    best.into_iter().map(|(_, sphere)| sphere).collect()
}
