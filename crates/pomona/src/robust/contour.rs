//! Where the apple ends before the background: rays that graze its body.

use super::body::Body;
use super::ray::nearest_on_ray;
use crate::optics::{DepthPatch, Projection};
use nalgebra::{Unit, Vector3};

/// Directions in which the outline is looked for.
const DIRECTIONS: usize = 96;

/// Missing readings over which the surface may go on, pixels.
const BRIDGE_PX: usize = 8;

/// Pixels beyond the end that must not be surface.
const BEYOND_PX: usize = 4;

/// Mixed readings at an edge make its last good pixel lie further in than half a pixel.
const EDGE_PX: f64 = 0.7;

/// Finds rays that graze the body: from its middle outwards, the end of the last pixel that shows its surface,
/// where what follows is farther away or no reading at all. Where something nearer follows, the outline is hidden
/// and there is no ray.
pub(crate) fn grazing_rays(
    patch: &DepthPatch,
    projection: &Projection<'_>,
    body: &Body,
    sigma: f64,
    out: &mut Vec<Unit<Vector3<f64>>>,
) {
    out.clear();
    let (c, r) = (body.center, body.radius);
    let Some((u, v)) = projection.project(&c) else {
        return;
    };
    let r_px = r / projection.pixel_m((c.z * c.z - r * r).max(0.01).sqrt());
    let tolerance = 3.0 * sigma + 0.06 * r;
    let steps: Vec<f64> = ((0.6 * r_px) as usize..=(1.3 * r_px + 4.0) as usize)
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
        if let Some(i) = end_of_surface(steps.len(), tolerance, off) {
            let rho = steps[i] + EDGE_PX;
            if let Some((x, y)) = projection.ray(u + rho * cos, v + rho * sin) {
                out.push(Unit::new_normalize(Vector3::new(x, y, 1.0)));
            }
        }
    }
}

/// The last step that shows the surface, where background follows. `off` gives how far a reading lies behind the
/// surface, `None` inside for no reading, and `None` outside of the image.
fn end_of_surface(
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
    last.filter(|_| after >= BEYOND_PX)
}

/// Of all directions, the share whose ray grazes the body within `tolerance`, less the share whose ray enters
/// it deeper.
pub(crate) fn agreement(rays: &[Unit<Vector3<f64>>], body: &Body, tolerance: f64) -> f64 {
    let balance: f64 = rays
        .iter()
        .map(|ray| {
            let off = body.signed_distance(&nearest_on_ray(ray, &body.center));
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
