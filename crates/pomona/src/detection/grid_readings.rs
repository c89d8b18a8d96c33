//! The readings of a box on a grid that is as coarse as the box is large.

use crate::optics::Projection;
use nalgebra::Point3;
use pomona_cloud::{DepthImage, PixelWindow};
use pomona_geometry::Sphere;

/// Cells of the grid, about. More: finer and slower.
const CELLS: usize = 324;

/// Places of a window of the depth image, each with its ray and, where there is one, its reading.
#[derive(Clone, Debug, Default)]
pub(super) struct GridReadings {
    /// Points with a reading, metres.
    pub(super) x: Vec<f32>,
    pub(super) y: Vec<f32>,
    pub(super) z: Vec<f32>,
    /// Their pixels, v · width + u.
    pub(super) pixel: Vec<u32>,
    /// x/z and y/z of the places without a reading.
    pub(super) blind: Vec<(f32, f32)>,
    /// The points that no sphere has taken yet.
    pub(super) left_x: Vec<f32>,
    pub(super) left_y: Vec<f32>,
    pub(super) left_z: Vec<f32>,
    /// The points that the last sphere was fitted to.
    pub(super) near: Vec<usize>,
    sorted: Vec<f32>,
}

impl GridReadings {
    /// Replaces the content by that of `window`.
    pub(super) fn fill(
        &mut self,
        depth: &DepthImage,
        projection: &Projection<'_>,
        window: PixelWindow,
    ) {
        for values in [&mut self.x, &mut self.y, &mut self.z] {
            values.clear();
        }
        self.pixel.clear();
        self.blind.clear();
        let step = ((window.pixel_count() as f64 / CELLS as f64).sqrt().round() as usize).max(1);
        let scale = projection.camera.depth_scale;
        for v in (window.y0 + step / 2..window.y1).step_by(step) {
            for u in (window.x0 + step / 2..window.x1).step_by(step) {
                let Some((rx, ry)) = projection.ray(u as f64, v as f64) else {
                    continue;
                };
                let i = v * depth.width + u;
                let z = f64::from(depth.readings[i]) * scale;
                if z > 0.0 {
                    self.x.push((rx * z) as f32);
                    self.y.push((ry * z) as f32);
                    self.z.push(z as f32);
                    self.pixel.push(i as u32);
                } else {
                    self.blind.push((rx as f32, ry as f32));
                }
            }
        }
    }

    /// Number of readings.
    pub(super) fn len(&self) -> usize {
        self.z.len()
    }

    /// Reading `i` as a point, metres.
    pub(super) fn point(&self, i: usize) -> Point3<f64> {
        Point3::new(
            f64::from(self.x[i]),
            f64::from(self.y[i]),
            f64::from(self.z[i]),
        )
    }

    /// Leaves all points to be taken.
    pub(super) fn all_left(&mut self) {
        self.left_x.clone_from(&self.x);
        self.left_y.clone_from(&self.y);
        self.left_z.clone_from(&self.z);
    }

    /// Leaves those that lie within `threshold` metres of `sphere` no longer.
    pub(super) fn leave_out(&mut self, sphere: &Sphere, threshold: f64) {
        let mut kept = 0;
        for i in 0..self.left_z.len() {
            let (x, y, z) = (self.left_x[i], self.left_y[i], self.left_z[i]);
            let p = Point3::new(x, y, z).cast();
            if sphere.signed_distance(&p).abs() > threshold {
                (self.left_x[kept], self.left_y[kept], self.left_z[kept]) = (x, y, z);
                kept += 1;
            }
        }
        self.left_x.truncate(kept);
        self.left_y.truncate(kept);
        self.left_z.truncate(kept);
    }

    /// The depth below which `share` of the readings lie, metres; there must be readings.
    pub(super) fn depth_at(&mut self, share: f64) -> f64 {
        quantile(&self.z, share, &mut self.sorted)
    }

    /// The same of the points that are left.
    pub(super) fn left_depth_at(&mut self, share: f64) -> f64 {
        quantile(&self.left_z, share, &mut self.sorted)
    }

    /// What the samples within the outline of `sphere` show, a reading within `threshold` metres of it being of it.
    pub(super) fn counts(&self, sphere: &Sphere, threshold: f64) -> SphereSupport {
        let mut counts = SphereSupport::default();
        let c = sphere.center.coords;
        let off_axis = |rx: f64, ry: f64| {
            // Squared distance of the centre from the ray, in squared radii.
            let (lx, ly) = (rx * c.z - c.x, ry * c.z - c.y);
            (lx * lx + ly * ly) / (sphere.radius * sphere.radius)
        };
        for i in 0..self.len() {
            let p = self.point(i);
            let off = off_axis(p.x / p.z, p.y / p.z);
            let distance = sphere.signed_distance(&p);
            if distance.abs() <= threshold && p.z <= c.z + threshold {
                counts.on_surface += 1;
                continue;
            }
            if off >= 1.0 {
                continue;
            }
            if p.z > c.z && off < CORE * CORE {
                counts.behind += 1;
            } else if p.z < c.z {
                counts.in_front += 1;
            }
        }
        let hidden = |&&(rx, ry): &&(f32, f32)| off_axis(f64::from(rx), f64::from(ry)) < 1.0;
        counts.no_reading = self.blind.iter().filter(hidden).count();
        counts
    }
}

fn quantile(values: &[f32], share: f64, sorted: &mut Vec<f32>) -> f64 {
    sorted.clear();
    sorted.extend_from_slice(values);
    let at = (share * (sorted.len() - 1) as f64) as usize;
    let (_, depth, _) = sorted.select_nth_unstable_by(at, f32::total_cmp);
    f64::from(*depth)
}

/// A ray that passes nearer than this many radii to the centre must meet the apple, noise or not.
const CORE: f64 = 0.8;

/// What the samples within a sphere's outline show, counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct SphereSupport {
    /// The sphere's own surface.
    pub(super) on_surface: usize,
    /// Something behind it, seen through its core.
    pub(super) behind: usize,
    /// Something before it.
    pub(super) in_front: usize,
    /// Nothing.
    pub(super) no_reading: usize,
}

impl SphereSupport {
    /// Share of the readings within the outline that are of the sphere's surface.
    pub(super) fn support(&self) -> f64 {
        let all = self.on_surface + self.behind + self.in_front;
        self.on_surface as f64 / all.max(1) as f64
    }

    /// Share of the whole outline on which the surface shows.
    pub(super) fn coverage(&self) -> f64 {
        let all = self.on_surface + self.behind + self.in_front + self.no_reading;
        self.on_surface as f64 / all.max(1) as f64
    }

    /// Of what could be surface or lies behind it, the share that lies behind.
    pub(super) fn seen_through(&self) -> f64 {
        self.behind as f64 / (self.on_surface + self.behind).max(1) as f64
    }
}
