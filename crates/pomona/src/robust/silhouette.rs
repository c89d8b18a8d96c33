//! Where the apple ends before the background: rays that graze its spheroid.

use super::ray::nearest_on_ray;
use super::spheroid::Spheroid;
use crate::optics::{DepthPatch, Projection};
use nalgebra::{Unit, Vector3};

/// Directions in which the outline is looked for.
const DIRECTIONS: usize = 96;

/// Missing readings over which the surface may go on, pixels.
const BRIDGE_PX: usize = 8;

/// Pixels after the last one of the surface that must not be surface.
const CLEARANCE_PX: usize = 4;

/// Mixed readings at an edge make its last good pixel lie further in than half a pixel.
const EDGE_PX: f64 = 0.7;

/// Difference in depth from the surface that still is surface: standard deviations of a reading, …
const SURFACE_SIGMAS: f64 = 3.0;

/// … and a share of the radius, for what the shape is off.
const SURFACE_SHARE: f64 = 0.06;

/// Where the silhouette is sought along a direction from the centre of the image of the apple, radii …
const SEARCH_RADII: (f64, f64) = (0.6, 1.3);

/// … and pixels beyond the far end.
const SEARCH_MARGIN_PX: f64 = 4.0;

/// Finds rays that graze the spheroid: from its middle outwards, the end of the last pixel that shows its surface,
/// where what follows is farther away or no reading at all. Where something nearer follows, the silhouette is occluded
/// and there is no ray.
pub(crate) fn silhouette_rays(
    patch: &DepthPatch,
    projection: &Projection<'_>,
    spheroid: &Spheroid,
    sigma: f64,
    out: &mut Vec<Unit<Vector3<f64>>>,
) {
    out.clear();
    let (c, r) = (spheroid.center, spheroid.radius);
    let Some((u, v)) = projection.project(&c) else {
        return;
    };
    let r_px = r / projection.pixel_m((c.z * c.z - r * r).max(0.01).sqrt());
    let tolerance = SURFACE_SIGMAS * sigma + SURFACE_SHARE * r;
    let steps: Vec<f64> = ((SEARCH_RADII.0 * r_px) as usize
        ..=(SEARCH_RADII.1 * r_px + SEARCH_MARGIN_PX) as usize)
        .map(|step| step as f64)
        .collect();
    let depths: Vec<f64> = steps
        .iter()
        .map(|rho| c.z - r * (1.0 - (rho / r_px).min(1.0).powi(2)).sqrt())
        .collect();
    for k in 0..DIRECTIONS {
        let turn = k as f64 * std::f64::consts::TAU / DIRECTIONS as f64;
        let (sin, cos) = turn.sin_cos();
        let off = |i: usize| {
            let z = f64::from(patch.depth(u + steps[i] * cos, v + steps[i] * sin)?);
            Some(if z == 0.0 { None } else { Some(z - depths[i]) })
        };
        if let Some(i) = last_surface_pixel(steps.len(), tolerance, off) {
            let rho = steps[i] + EDGE_PX;
            if let Some((x, y)) = projection.ray(u + rho * cos, v + rho * sin) {
                out.push(Unit::new_normalize(Vector3::new(x, y, 1.0)));
            }
        }
    }
}

/// The last step that shows the surface, where background follows. `off` gives how far a reading lies behind the
/// surface, `None` inside for no reading, and `None` outside of the image.
fn last_surface_pixel(
    steps: usize,
    tolerance: f64,
    off: impl Fn(usize) -> Option<Option<f64>>,
) -> Option<usize> {
    let (mut last, mut after) = (None, 0);
    for i in 0..steps {
        let Some(off) = off(i) else { break };
        match off {
            Some(off) if off.abs() < tolerance => {
                last = Some(i);
                after = 0;
            }
            Some(off) if off < 0.0 => return None,
            _ => {
                after += 1;
                if last.is_some() && after > BRIDGE_PX {
                    break;
                }
            }
        }
    }
    last.filter(|_| after >= CLEARANCE_PX)
}

/// Of all directions, the share whose ray grazes the spheroid within `tolerance`, less the share whose ray enters
/// it deeper.
pub(crate) fn agreement(rays: &[Unit<Vector3<f64>>], spheroid: &Spheroid, tolerance: f64) -> f64 {
    let balance: f64 = rays
        .iter()
        .map(|ray| {
            let off = spheroid.signed_distance(&nearest_on_ray(ray, &spheroid.center));
            if off.abs() < tolerance {
                1.0
            } else if off < 0.0 {
                -1.0
            } else {
                0.0
            }
        })
        .sum();
    balance / DIRECTIONS as f64
}

/// Of all directions, the share whose ray grazes the spheroid within `tolerance`.
pub(crate) fn agreeing_share(
    rays: &[Unit<Vector3<f64>>],
    spheroid: &Spheroid,
    tolerance: f64,
) -> f64 {
    let off = |ray| spheroid.signed_distance(&nearest_on_ray(ray, &spheroid.center));
    let agreeing = rays.iter().filter(|ray| off(ray).abs() < tolerance);
    agreeing.count() as f64 / DIRECTIONS as f64
}
