mod assumed;
mod distortion;
mod doubts;
mod draft;
mod error;
mod file;
mod info;
mod json;
mod lens;
mod options;
mod region;
mod yaml;

pub use distortion::Distortion;
pub use error::CameraError;
pub use lens::Lens;
pub use options::{CameraOptions, ImageKind};

use nalgebra::Point3;
use serde::{Deserialize, Serialize};

/// A pinhole camera with optional lens distortion, in the REP-103 optical frame
/// (x right, y down, z forward).
///
/// Pixel (0, 0) is the centre of the top-left pixel, so a point
/// on the ray of pixel (u, v) is z·((u − cx)/fx, (v − cy)/fy, 1).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct Camera {
    /// Image width in pixels.
    pub width: usize,
    /// Image height in pixels.
    pub height: usize,
    /// Focal length along x, pixels.
    pub fx: f64,
    /// Focal length along y, pixels.
    pub fy: f64,
    /// Principal point, x, pixels.
    pub cx: f64,
    /// Principal point, y, pixels.
    pub cy: f64,
    /// Metres per unit of the depth image.
    pub depth_scale: f64,
    /// Name of the camera's frame.
    pub frame_id: String,
    /// Lens distortion; absent for an undistorted image.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub distortion: Option<Distortion>,
}

/// Largest angle of a ray off the axis, degrees. A lens that keeps lines straight stretches the image by 1/cos² of it;
/// the widest that are made, of 10 mm on full frame, reach 65° in the corner.
const WIDEST_DEG: f64 = 75.0;

impl Camera {
    /// A camera without distortion: image size, focal lengths and principal point, each along x and y, in pixels.
    ///
    /// Its depth images count millimetres, and its frame is `camera_color_optical_frame`.
    pub fn new(size: [usize; 2], focal: [f64; 2], principal_point: [f64; 2]) -> Self {
        let ([width, height], [fx, fy], [cx, cy]) = (size, focal, principal_point);
        Self {
            width,
            height,
            fx,
            fy,
            cx,
            cy,
            depth_scale: 0.001,
            frame_id: "camera_color_optical_frame".to_owned(),
            distortion: None,
        }
    }

    /// This camera with another image size, focal lengths and principal point, as in [`Camera::new`].
    #[must_use]
    pub fn with_intrinsics(
        self,
        size: [usize; 2],
        focal: [f64; 2],
        principal_point: [f64; 2],
    ) -> Self {
        Self {
            depth_scale: self.depth_scale,
            frame_id: self.frame_id,
            distortion: self.distortion,
            ..Self::new(size, focal, principal_point)
        }
    }

    /// Checks that the camera can be computed with: sizes, focal lengths and depth
    /// scale positive, all numbers finite, a known distortion that can be inverted
    /// at the corners and the edges' middles, and no ray there so far off the axis that no such lens exists.
    ///
    /// # Errors
    ///
    /// The first [`CameraError`] found, in the order of the fields.
    pub fn validate(&self) -> Result<(), CameraError> {
        for (field, value) in [
            ("width", self.width as f64),
            ("height", self.height as f64),
            ("fx", self.fx),
            ("fy", self.fy),
            ("depth_scale", self.depth_scale),
        ] {
            if !(value.is_finite() && value > 0.0) {
                return Err(CameraError::NotPositive { field, value });
            }
        }
        for (field, value) in [("cx", self.cx), ("cy", self.cy)] {
            if !value.is_finite() {
                return Err(CameraError::NotFinite { field, value });
            }
        }
        let lens = self.lens()?;
        let (right, bottom) = ((self.width - 1) as f64, (self.height - 1) as f64);
        for u in [0.0, 0.5 * right, right] {
            for v in [0.0, 0.5 * bottom, bottom] {
                let ray = self.ray_through(&lens, u, v);
                if let (Some((x, y)), false) = (ray, matches!(lens, Lens::Equidistant { .. })) {
                    let off_axis_deg = x.hypot(y).atan().to_degrees();
                    if off_axis_deg > WIDEST_DEG {
                        return Err(CameraError::OffAxis { u, v, off_axis_deg });
                    }
                }
                if ray.is_none() {
                    let model = self
                        .distortion
                        .as_ref()
                        .map_or_else(String::new, |d| d.model.clone());
                    return Err(CameraError::NotInvertible { model, u, v });
                }
            }
        }
        Ok(())
    }

    /// The lens that `distortion` describes.
    ///
    /// # Errors
    ///
    /// [`CameraError::UnknownModel`], [`CameraError::CoefficientCount`], [`CameraError::NotFinite`].
    pub fn lens(&self) -> Result<Lens, CameraError> {
        self.distortion
            .as_ref()
            .map_or(Ok(Lens::Pinhole), Lens::try_from)
    }

    /// The point at depth `z` (metres along the optical axis) seen at pixel (u, v).
    ///
    /// Its coordinates are NaN where the distortion has no inverse at the pixel,
    /// which [`Camera::validate`] excludes.
    pub fn deproject(&self, u: f64, v: f64, z: f64) -> Point3<f64> {
        match self.ray(u, v) {
            Some((x, y)) => Point3::new(x * z, y * z, z),
            None => Point3::new(f64::NAN, f64::NAN, f64::NAN),
        }
    }

    /// x/z and y/z of the points seen at pixel (u, v); `None` where the distortion
    /// is not known or has no inverse there.
    pub fn ray(&self, u: f64, v: f64) -> Option<(f64, f64)> {
        self.ray_through(&self.lens().ok()?, u, v)
    }

    /// As [`Camera::ray`], for a caller who has looked up the lens for many pixels.
    pub(crate) fn ray_through(&self, lens: &Lens, u: f64, v: f64) -> Option<(f64, f64)> {
        lens.undistort((u - self.cx) / self.fx, (v - self.cy) / self.fy)
    }

    /// The pixel (u, v) at which a point is seen, also outside the image.
    ///
    /// `None` for a point at or behind the camera, not finite, or so far off the axis that
    /// the distortion model folds over.
    pub fn project(&self, point: &Point3<f64>) -> Option<(f64, f64)> {
        if !(point.z > 0.0 && point.iter().all(|c| c.is_finite())) {
            return None;
        }
        let (x, y) = self
            .lens()
            .ok()?
            .distort(point.x / point.z, point.y / point.z)?;
        let pixel = (x * self.fx + self.cx, y * self.fy + self.cy);
        (pixel.0.is_finite() && pixel.1.is_finite()).then_some(pixel)
    }
}

#[cfg(test)]
mod tests;
