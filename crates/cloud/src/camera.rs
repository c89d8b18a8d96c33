use serde::{Deserialize, Serialize};

/// A pinhole camera with optional lens distortion, in the REP-103 optical frame
/// (x right, y down, z forward).
///
/// Pixel (0, 0) is the centre of the top-left pixel, so a point
/// on the ray of pixel (u, v) is z·((u − cx)/fx, (v − cy)/fy, 1).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
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

/// Lens distortion, by model name and coefficients in OpenCV's order.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Distortion {
    /// Name of the model, for example `plumb_bob`.
    pub model: String,
    /// Its coefficients.
    pub coefficients: Vec<f64>,
}
