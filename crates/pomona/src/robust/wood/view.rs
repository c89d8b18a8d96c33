//! What the search for wood reads, and how far it reaches.

use crate::config::RobustConfig;
use crate::optics::Projection;
use nalgebra::Point3;
use pomona_cloud::{DepthImage, GrayImage, PixelBox};
use pomona_geometry::Sphere;

/// Distance from the apple's centre within which wood is looked for, radii of the apple.
pub(crate) const REACH_RADII: f64 = 3.0;

/// Beyond that the image is looked at for what goes on there, radii of the apple.
pub(crate) const MARGIN_RADII: f64 = 0.4;

/// Everything that the search for wood reads.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WoodSearch<'a> {
    pub(crate) wood: &'a GrayImage,
    pub(crate) depth: &'a DepthImage,
    pub(crate) projection: &'a Projection<'a>,
    pub(crate) apple: Sphere,
    /// The apple's box, drawn or detected in the colour image.
    pub(crate) bounds: &'a PixelBox,
    /// Standard deviation of a reading at the apple's depth, metres.
    pub(crate) sigma: f64,
    /// How smeared the frame's depth is, 0 to 1.
    pub(crate) smear: f64,
    pub(crate) config: &'a RobustConfig,
}

impl WoodSearch<'_> {
    /// Width of a pixel at the apple's depth, metres.
    pub(crate) fn pixel(&self) -> f64 {
        self.projection.pixel_m(self.apple.center.z)
    }

    /// The point at a depth in front of a pixel.
    pub(crate) fn point_at(&self, pixel: (f64, f64), z: f64) -> Option<Point3<f64>> {
        let (x, y) = self.projection.ray(pixel.0, pixel.1)?;
        Some(Point3::new(x * z, y * z, z))
    }
}
