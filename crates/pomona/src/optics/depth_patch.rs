//! A window of the depth image in metres, with the ray of each of its pixels.

use super::projection::Projection;
use nalgebra::{Point3, Vector3};
use pomona_cloud::{DepthImage, Lens, PixelWindow};

/// A window of a depth image: depth in metres (0 where there is no reading) and rays.
#[derive(Clone, Debug, Default)]
pub(crate) struct DepthPatch {
    /// First column and row of the window in the image.
    pub(crate) origin: (usize, usize),
    /// Columns.
    pub(crate) width: usize,
    /// Rows.
    pub(crate) height: usize,
    /// Columns of the whole image.
    pub(crate) stride: usize,
    /// Depth, metres, row by row.
    pub(crate) z: Vec<f32>,
    /// x/z of each pixel, or of each column where the lens is a pinhole.
    ray_x: Vec<f32>,
    /// y/z of each pixel, or of each row.
    ray_y: Vec<f32>,
    separable: bool,
}

impl DepthPatch {
    /// Replaces the content by that of `window`.
    pub(crate) fn fill(
        &mut self,
        depth: &DepthImage,
        projection: &Projection<'_>,
        window: PixelWindow,
    ) {
        let window = window.intersection(PixelWindow::full(depth.width, depth.height));
        self.origin = (window.x0, window.y0);
        self.width = window.width();
        self.height = window.height();
        self.stride = depth.width;
        self.separable = projection.lens == Lens::Pinhole;
        self.z.clear();
        self.ray_x.clear();
        self.ray_y.clear();
        let scale = projection.camera.depth_scale as f32;
        for v in window.y0..window.y1 {
            let row = v * depth.width;
            let readings = &depth.readings[row + window.x0..row + window.x1];
            self.z
                .extend(readings.iter().map(|&r| f32::from(r) * scale));
        }
        if self.separable {
            let camera = projection.camera;
            let column = |u: usize| ((u as f64 - camera.cx) / camera.fx) as f32;
            let line = |v: usize| ((v as f64 - camera.cy) / camera.fy) as f32;
            self.ray_x.extend((window.x0..window.x1).map(column));
            self.ray_y.extend((window.y0..window.y1).map(line));
            return;
        }
        for v in window.y0..window.y1 {
            for (i, u) in (window.x0..window.x1).enumerate() {
                let ray = projection.ray(u as f64, v as f64);
                if ray.is_none() {
                    self.z[(v - window.y0) * self.width + i] = 0.0;
                }
                let (x, y) = ray.unwrap_or((0.0, 0.0));
                self.ray_x.push(x as f32);
                self.ray_y.push(y as f32);
            }
        }
    }

    /// Where it lies in the image.
    pub(crate) fn window(&self) -> PixelWindow {
        let (x0, y0) = self.origin;
        PixelWindow {
            x0,
            y0,
            x1: x0 + self.width,
            y1: y0 + self.height,
        }
    }

    /// x/z and y/z of pixel (x, y) of the window.
    #[inline]
    pub(crate) fn ray(&self, x: usize, y: usize) -> (f32, f32) {
        if self.separable {
            (self.ray_x[x], self.ray_y[y])
        } else {
            let i = y * self.width + x;
            (self.ray_x[i], self.ray_y[i])
        }
    }

    /// The point at depth `z` seen at pixel (x, y) of the window.
    #[inline]
    pub(crate) fn point_at(&self, x: usize, y: usize, z: f32) -> Point3<f64> {
        let (rx, ry) = self.ray(x, y);
        let z = f64::from(z);
        Point3::from(Vector3::new(f64::from(rx) * z, f64::from(ry) * z, z))
    }

    /// Depth at a pixel of the whole image; `None` outside the window, 0 for no reading.
    #[inline]
    pub(crate) fn depth(&self, u: f64, v: f64) -> Option<f32> {
        let x = u.round() - self.origin.0 as f64;
        let y = v.round() - self.origin.1 as f64;
        if !(x >= 0.0 && y >= 0.0) {
            return None;
        }
        let (x, y) = (x as usize, y as usize);
        (x < self.width && y < self.height).then(|| self.z[y * self.width + x])
    }

    /// Index in the whole image of the window's pixel `i`.
    pub(crate) fn image_index(&self, i: usize) -> u32 {
        let (x, y) = (
            i % self.width + self.origin.0,
            i / self.width + self.origin.1,
        );
        (y * self.stride + x) as u32
    }

    /// x/z and y/z between pixels of the window, linearly; `None` outside of it.
    pub(crate) fn ray_between(&self, x: f64, y: f64) -> Option<(f64, f64)> {
        if !(x >= 0.0 && y >= 0.0) || self.width < 2 || self.height < 2 {
            return None;
        }
        let (x0, y0) = (
            (x as usize).min(self.width - 2),
            (y as usize).min(self.height - 2),
        );
        let (fx, fy) = (x - x0 as f64, y - y0 as f64);
        let corner = |dx: usize, dy: usize| {
            let (rx, ry) = self.ray(x0 + dx, y0 + dy);
            Vector3::new(f64::from(rx), f64::from(ry), 0.0)
        };
        let top = corner(0, 0) * (1.0 - fx) + corner(1, 0) * fx;
        let bottom = corner(0, 1) * (1.0 - fx) + corner(1, 1) * fx;
        let ray = top * (1.0 - fy) + bottom * fy;
        Some((ray.x, ray.y))
    }
}
