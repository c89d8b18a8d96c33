//! From pixels to rays and back.

use nalgebra::Point3;
use pomona_cloud::{Camera, CameraError, Lens};

/// A camera whose lens has been looked up.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Projection<'a> {
    pub(crate) camera: &'a Camera,
    pub(crate) lens: Lens,
}

impl<'a> Projection<'a> {
    /// Looks up the camera's lens.
    ///
    /// # Errors
    ///
    /// As [`Camera::lens`], where its distortion cannot be computed with.
    pub(crate) fn new(camera: &'a Camera) -> Result<Self, CameraError> {
        let lens = camera.lens()?;
        Ok(Self { camera, lens })
    }

    /// The pixel at which `point` is seen; `None` behind the camera.
    pub(crate) fn project(&self, point: &Point3<f64>) -> Option<(f64, f64)> {
        if !(point.z > 1e-6) {
            return None;
        }
        let (x, y) = self.lens.distort(point.x / point.z, point.y / point.z)?;
        Some((
            x * self.camera.fx + self.camera.cx,
            y * self.camera.fy + self.camera.cy,
        ))
    }

    /// x/z and y/z of what is seen at pixel (u, v).
    pub(crate) fn ray(&self, u: f64, v: f64) -> Option<(f64, f64)> {
        self.lens.undistort(
            (u - self.camera.cx) / self.camera.fx,
            (v - self.camera.cy) / self.camera.fy,
        )
    }

    /// Metres that a pixel spans at depth `z`.
    pub(crate) fn pixel_m(&self, z: f64) -> f64 {
        z / self.camera.fx
    }
}
