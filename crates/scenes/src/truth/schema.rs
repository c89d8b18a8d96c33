//! The shapes of what the truth takes from another crate, whose tests are not compiled with ours.

use schemars::JsonSchema;

/// A box of the colour image, in pixels: `x_min` <= x < `x_max`, and likewise y.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields, rename = "PixelBox")]
#[expect(dead_code, reason = "a shape has no values")]
pub(super) struct PixelBoxShape {
    /// Name of the box.
    name: String,
    /// Left edge.
    x_min: f64,
    /// Top edge.
    y_min: f64,
    /// Right edge.
    x_max: f64,
    /// Bottom edge.
    y_max: f64,
    /// Detection score; 1 for a box that is known.
    #[schemars(range(min = 0.0, max = 1.0))]
    score: f64,
}

/// A pinhole camera, its numbers in pixels.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields, rename = "Camera")]
#[expect(dead_code, reason = "a shape has no values")]
pub(super) struct CameraShape {
    /// Width of the images.
    #[schemars(range(min = 1))]
    width: usize,
    /// Height of the images.
    #[schemars(range(min = 1))]
    height: usize,
    /// Focal length along x.
    #[schemars(extend("exclusiveMinimum" = 0))]
    fx: f64,
    /// Focal length along y.
    #[schemars(extend("exclusiveMinimum" = 0))]
    fy: f64,
    /// Principal point, x.
    cx: f64,
    /// Principal point, y.
    cy: f64,
    /// Metres per unit of depth.
    #[schemars(extend("exclusiveMinimum" = 0))]
    depth_scale: f64,
    /// Name of the coordinate frame.
    frame_id: String,
    /// Distortion of the lens; absent for a pinhole.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    distortion: Option<DistortionShape>,
}

/// A model of lens distortion.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields, rename = "Distortion")]
#[expect(dead_code, reason = "a shape has no values")]
struct DistortionShape {
    /// Name of the model.
    model: String,
    /// Its coefficients.
    coefficients: Vec<f64>,
}
