use crate::error::PickError;
use crate::optics::{DepthQuality, Projection};
use pomona_cloud::{DepthPoints, Frame, GrayImage, PixelWindow};
use std::sync::OnceLock;

/// A frame whose parts agree: checked once, its depth image deprojected at most once, for all stages.
#[derive(Debug)]
pub struct CheckedFrame<'a> {
    frame: &'a Frame,
    projection: Projection<'a>,
    points: OnceLock<DepthPoints>,
    quality: OnceLock<DepthQuality>,
    wood: Option<&'a GrayImage>,
}

impl<'a> CheckedFrame<'a> {
    /// Checks that images, camera and boxes fit together.
    ///
    /// # Errors
    ///
    /// [`PickError::Frame`] where they contradict each other.
    pub fn new(frame: &'a Frame) -> Result<Self, PickError> {
        let refused = |source| PickError::Frame {
            frame: frame.id.clone(),
            source: Box::new(source),
        };
        frame.validate().map_err(refused)?;
        // What deprojects no pixel meets every condition for deprojecting all of them.
        let nothing = PixelWindow::full(0, 0);
        DepthPoints::new()
            .fill(&frame.depth, &frame.camera, nothing)
            .map_err(refused)?;
        let projection = Projection::new(&frame.camera).map_err(|source| {
            refused(pomona_cloud::CloudError::Camera {
                path: frame.id.clone().into(),
                source,
            })
        })?;
        Ok(Self {
            frame,
            projection,
            points: OnceLock::new(),
            quality: OnceLock::new(),
            wood: None,
        })
    }

    /// The frame with the probability of wood (× 255) of each pixel of its colour image, as a segmenter finds it.
    ///
    /// # Errors
    ///
    /// [`PickError::WoodSize`] where the mask has not the size of the frame's images.
    pub fn with_wood(self, wood: &'a GrayImage) -> Result<Self, PickError> {
        let (expected, found) = (self.size(), (wood.width, wood.height));
        if found != expected || wood.values.len() != wood.width * wood.height {
            return Err(PickError::WoodSize {
                frame: self.frame.id.clone(),
                found,
                expected,
            });
        }
        Ok(Self {
            wood: Some(wood),
            ..self
        })
    }

    /// The probability of wood (× 255) of each pixel, where it is known.
    pub fn wood(&self) -> Option<&'a GrayImage> {
        self.wood
    }

    /// The frame.
    pub fn frame(&self) -> &'a Frame {
        self.frame
    }

    /// What the depth image tells about its own errors; estimated when first asked for.
    pub fn depth_quality(&self) -> &DepthQuality {
        self.quality
            .get_or_init(|| DepthQuality::of(&self.frame.depth, self.frame.camera.depth_scale))
    }

    /// The points of the whole depth image, in the order of their pixels; deprojected when first asked for.
    pub fn points(&self) -> &DepthPoints {
        self.points.get_or_init(|| {
            let depth = &self.frame.depth;
            let mut points = DepthPoints::new();
            // `new` has made sure that it does not fail; a failure would leave no points.
            let _ = points.fill(
                depth,
                &self.frame.camera,
                PixelWindow::full(depth.width, depth.height),
            );
            points
        })
    }

    /// Replaces the content of `out` by the points of `window`, as far as it lies in the image.
    pub(crate) fn copy_points(&self, window: PixelWindow, out: &mut DepthPoints) {
        let (width, height) = self.size();
        let window = window.intersection(PixelWindow::full(width, height));
        let all = self.points();
        out.clear();
        for v in window.y0..window.y1 {
            let at = |u: usize| {
                let pixel = v * width + u;
                all.pixel.partition_point(|&p| (p as usize) < pixel)
            };
            let row = at(window.x0)..at(window.x1);
            out.x.extend_from_slice(&all.x[row.clone()]);
            out.y.extend_from_slice(&all.y[row.clone()]);
            out.z.extend_from_slice(&all.z[row.clone()]);
            out.pixel.extend_from_slice(&all.pixel[row]);
        }
    }

    /// Width and height of the images, pixels.
    pub(crate) fn size(&self) -> (usize, usize) {
        (self.frame.depth.width, self.frame.depth.height)
    }

    /// The camera with its lens.
    pub(crate) fn projection(&self) -> &Projection<'a> {
        &self.projection
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pomona_scenes::Suite;

    #[test]
    fn windows_are_what_deprojecting_them_gives() {
        let frame = Suite::Lab15.cases().next().unwrap().scene().frame;
        let checked = CheckedFrame::new(&frame).unwrap();
        let mut copied = DepthPoints::new();
        for (x0, y0, x1, y1) in [
            (300, 200, 420, 333),
            (0, 0, 5, 5),
            (600, 400, 9999, 9999),
            (7, 7, 7, 9),
        ] {
            let window = PixelWindow { x0, y0, x1, y1 };
            checked.copy_points(window, &mut copied);
            let filled = frame.window(window).unwrap();
            assert_eq!(
                (&copied.x, &copied.y, &copied.z, &copied.pixel),
                (&filled.x, &filled.y, &filled.z, &filled.pixel)
            );
        }
    }

    #[test]
    fn a_mask_of_another_size_is_refused() {
        let frame = Suite::Lab15.cases().next().unwrap().scene().frame;
        let (width, height) = (frame.depth.width, frame.depth.height);
        let mask = |width: usize| GrayImage {
            width,
            height,
            values: vec![0; width * height],
        };
        let check = |mask: &GrayImage| CheckedFrame::new(&frame)?.with_wood(mask).map(|_| ());
        assert!(check(&mask(width)).is_ok());
        let error = check(&mask(width + 1)).unwrap_err().to_string();
        assert!(
            error.contains(&frame.id) && error.contains(&(width + 1).to_string()),
            "{error}"
        );
    }

    #[test]
    fn images_of_two_sizes_are_refused_by_the_frames_name() {
        let mut frame = Suite::Lab15.cases().next().unwrap().scene().frame;
        frame.depth.width -= 1;
        let error = CheckedFrame::new(&frame).unwrap_err().to_string();
        assert!(error.contains(&frame.id), "{error}");
    }
}
