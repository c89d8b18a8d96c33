use super::Frame;
use crate::{CloudError, DepthPoints, PixelBox, PixelWindow, PointCloud};
use std::path::PathBuf;

impl Frame {
    /// The points of a window of the depth image.
    ///
    /// A caller with many windows keeps one [`DepthPoints`] and fills it anew instead.
    ///
    /// # Errors
    ///
    /// As [`DepthPoints::fill`].
    pub fn window(&self, window: PixelWindow) -> Result<DepthPoints, CloudError> {
        let mut points = DepthPoints::new();
        points.fill(&self.depth, &self.camera, window)?;
        Ok(points)
    }

    /// The coloured points inside a box, as an unorganised cloud of pixels with a reading.
    ///
    /// # Errors
    ///
    /// [`CloudError::Box`] where the box holds no pixel; otherwise as [`DepthPoints::fill`].
    pub fn crop(&self, pixel_box: &PixelBox) -> Result<PointCloud, CloudError> {
        let window = pixel_box
            .window(self.depth.width, self.depth.height)
            .map_err(|source| CloudError::Box {
                path: PathBuf::from(&self.id),
                source,
            })?;
        Ok(PointCloud::from_points(&self.window(window)?, &self.color))
    }
}
