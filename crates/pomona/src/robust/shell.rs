//! The surroundings of an apple: a patch of depth in which apples are marked.

use super::spheroid::Spheroid;
use crate::optics::{DepthNoise, DepthPatch, Projection, window_of_sphere};
use nalgebra::Point3;
use pomona_cloud::{DepthImage, PixelWindow};
use pomona_geometry::Sphere;

/// Depth about an apple, and what each pixel shows.
#[derive(Clone, Debug, Default)]
pub(crate) struct Shell {
    pub(crate) patch: DepthPatch,
    pub(crate) seen: Vec<u8>,
}

pub(crate) const NOTHING: u8 = 0;
pub(crate) const THING: u8 = 1;
pub(crate) const APPLE: u8 = 2;

impl Shell {
    /// Fills in the surroundings of `own` up to `reach` metres from its centre.
    pub(crate) fn fill(
        &mut self,
        depth: &DepthImage,
        projection: &Projection<'_>,
        own: &Spheroid,
        reach: f64,
        noise: DepthNoise,
    ) {
        let (w, h) = (depth.width, depth.height);
        let around = Sphere {
            center: own.center,
            radius: reach,
        };
        self.patch.fill(
            depth,
            projection,
            window_of_sphere(&around, projection.camera, w, h),
        );
        let (near, far) = (own.center.z - reach, own.center.z + reach);
        self.seen.clear();
        self.seen.extend(self.patch.z.iter().map(|&z| {
            let z = f64::from(z);
            if z > near && z < far { THING } else { NOTHING }
        }));
        self.mark(projection, own, w, h, noise);
    }

    /// Indices in the whole image of the pixels that show `what`.
    pub(crate) fn pixels_of(&self, what: u8) -> Vec<u32> {
        let of = self.seen.iter().enumerate().filter(|(_, s)| **s == what);
        of.map(|(i, _)| self.patch.image_index(i)).collect()
    }

    /// Number of the readings of `window` that lie on the spheroid's surface.
    pub(crate) fn surface_count(
        &self,
        spheroid: &Spheroid,
        window: PixelWindow,
        noise: DepthNoise,
    ) -> usize {
        let patch = &self.patch;
        let sd = noise.sigma(spheroid.center.z);
        let (x0, y0) = patch.origin;
        let window = window.intersection(patch.window());
        let rows = window.y0..window.y1;
        rows.flat_map(|v| (window.x0..window.x1).map(move |u| (u - x0, v - y0)))
            .filter(|&(x, y)| {
                let i = y * patch.width + x;
                self.seen[i] == APPLE && {
                    let p = patch.point_at(x, y, patch.z[i]);
                    spheroid.signed_distance(&p).abs() < surface_band(spheroid, &p, sd)
                }
            })
            .count()
    }

    fn mark(
        &mut self,
        projection: &Projection<'_>,
        spheroid: &Spheroid,
        width: usize,
        height: usize,
        noise: DepthNoise,
    ) {
        let sd = noise.sigma(spheroid.center.z);
        let band = 0.0015 + 2.5 * sd;
        let around = Sphere {
            center: spheroid.center,
            radius: spheroid.radius + band,
        };
        let patch = &self.patch;
        let (x0, y0) = patch.origin;
        let window = window_of_sphere(&around, projection.camera, width, height)
            .intersection(patch.window());
        for v in window.y0..window.y1 {
            for u in window.x0..window.x1 {
                let i = (v - y0) * patch.width + (u - x0);
                if self.seen[i] != THING {
                    continue;
                }
                let p = patch.point_at(u - x0, v - y0, patch.z[i]);
                // DepthNoise lies along the ray: where the surface is seen at a slant it counts for less.
                let d = p - spheroid.center;
                let slant = (d.dot(&p.coords) / (d.norm() * p.coords.norm()).max(1e-9)).abs();
                let own_band = 0.0015 + 2.5 * sd * slant.max(0.25);
                if spheroid.signed_distance(&p) < own_band {
                    self.seen[i] = APPLE;
                }
            }
        }
    }
}

/// Distance from the spheroid's surface, metres, within which a reading `p` with standard deviation `sd` lies on it.
fn surface_band(spheroid: &Spheroid, p: &Point3<f64>, sd: f64) -> f64 {
    // Noise lies along the ray: where the surface is seen at a slant it counts for less.
    let d = p - spheroid.center;
    let slant = (d.dot(&p.coords) / (d.norm() * p.coords.norm()).max(1e-9)).abs();
    0.0015 + 2.5 * sd * slant.max(0.25)
}
