use crate::{Camera, CloudError, DepthImage, PixelWindow};
use nalgebra::Point3;
use pomona_files::Malformed;
use std::path::{Path, PathBuf};

/// The points of a window of a depth image: only pixels with a reading, row by row.
///
/// The four arrays have the same length. Coordinates are in metres in the camera's optical
/// frame; `pixel[i]` is the index `v * width + u` in the whole image. [`DepthPoints::fill`]
/// reuses the arrays, so that one value serves all apples of a frame without allocating.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DepthPoints {
    /// x coordinates.
    pub x: Vec<f32>,
    /// y coordinates.
    pub y: Vec<f32>,
    /// z coordinates.
    pub z: Vec<f32>,
    /// Index of the pixel of each point.
    pub pixel: Vec<u32>,
    /// x/z of the window's columns, for a lens without distortion.
    column_rays: Vec<f64>,
}

impl DepthPoints {
    /// No points.
    pub fn new() -> Self {
        Self::default()
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.x.len()
    }

    /// Whether there are no points.
    pub fn is_empty(&self) -> bool {
        self.x.is_empty()
    }

    /// Point `i`.
    ///
    /// # Panics
    ///
    /// Where there is no such point.
    pub fn point(&self, i: usize) -> Point3<f64> {
        Point3::new(
            f64::from(self.x[i]),
            f64::from(self.y[i]),
            f64::from(self.z[i]),
        )
    }

    /// Keeps the points for which `keep` holds, in their order.
    pub fn retain(&mut self, mut keep: impl FnMut(Point3<f64>) -> bool) {
        let mut kept = 0;
        for i in 0..self.len() {
            if keep(self.point(i)) {
                self.x[kept] = self.x[i];
                self.y[kept] = self.y[i];
                self.z[kept] = self.z[i];
                self.pixel[kept] = self.pixel[i];
                kept += 1;
            }
        }
        self.x.truncate(kept);
        self.y.truncate(kept);
        self.z.truncate(kept);
        self.pixel.truncate(kept);
    }

    /// Removes all points and keeps the memory.
    pub fn clear(&mut self) {
        self.x.clear();
        self.y.clear();
        self.z.clear();
        self.pixel.clear();
    }

    /// Replaces the points by those of `window`, as far as it lies in the image.
    ///
    /// Each point is [`Camera::deproject`] of its pixel, rounded to f32. A pixel at which the
    /// distortion has no inverse counts as one without a reading.
    ///
    /// # Errors
    ///
    /// [`CloudError::Camera`] for a camera that cannot be computed with, and
    /// [`CloudError::File`] for an image without `width * height` readings; then no points remain.
    /// The path in them is the camera's `frame_id`.
    pub fn fill(
        &mut self,
        depth: &DepthImage,
        camera: &Camera,
        window: PixelWindow,
    ) -> Result<(), CloudError> {
        self.clear();
        let camera_error = |source| CloudError::Camera {
            path: PathBuf::from(&camera.frame_id),
            source,
        };
        let lens = camera.lens().map_err(camera_error)?;
        if depth.width.checked_mul(depth.height) != Some(depth.readings.len())
            || u32::try_from(depth.readings.len()).is_err()
        {
            let problem = format!(
                "{} readings for a size of {}x{}",
                depth.readings.len(),
                depth.width,
                depth.height
            );
            let remedy = "give width * height readings, fewer than 2^32";
            let fault = Malformed::new("depth image", problem, remedy);
            return Err(fault.at(Path::new(&camera.frame_id)).into());
        }
        let window = window.intersection(PixelWindow::full(depth.width, depth.height));
        let separable = lens == crate::Lens::Pinhole;
        self.column_rays.clear();
        if separable {
            self.column_rays
                .extend((window.x0..window.x1).map(|u| (u as f64 - camera.cx) / camera.fx));
        }
        for v in window.y0..window.y1 {
            let row_ray = (v as f64 - camera.cy) / camera.fy;
            let start = v * depth.width;
            let row = &depth.readings[start + window.x0..start + window.x1];
            for (column, &reading) in row.iter().enumerate() {
                if reading == 0 {
                    continue;
                }
                let u = window.x0 + column;
                let ray = if separable {
                    Some((self.column_rays[column], row_ray))
                } else {
                    camera.ray_through(&lens, u as f64, v as f64)
                };
                let Some((ray_x, ray_y)) = ray else { continue };
                let z = f64::from(reading) * camera.depth_scale;
                self.x.push((ray_x * z) as f32);
                self.y.push((ray_y * z) as f32);
                self.z.push(z as f32);
                self.pixel.push((start + u) as u32);
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Distortion;

    fn camera(distortion: Option<Distortion>) -> Camera {
        Camera {
            width: 8,
            height: 6,
            fx: 7.0,
            fy: 7.5,
            cx: 3.5,
            cy: 2.5,
            depth_scale: 0.001,
            frame_id: "optical".to_owned(),
            distortion,
        }
    }

    fn depth() -> DepthImage {
        let readings = (0..48)
            .map(|i| if i % 3 == 0 { 0 } else { 500 + 10 * i })
            .collect();
        DepthImage {
            width: 8,
            height: 6,
            readings,
        }
    }

    #[test]
    fn points_are_the_deprojected_pixels_with_a_reading() {
        let bent = Distortion {
            model: "plumb_bob".to_owned(),
            coefficients: vec![-0.1, 0.01, 0.001, 0.002, 0.0],
        };
        let window = PixelWindow {
            x0: 1,
            y0: 2,
            x1: 5,
            y1: 99,
        };
        for camera in [camera(None), camera(Some(bent))] {
            let depth = depth();
            let mut points = DepthPoints::new();
            points.fill(&depth, &camera, window).unwrap();
            let with_reading = (2..6).flat_map(|v| (1..5).map(move |u| (u, v)));
            let expected: Vec<_> = with_reading
                .filter(|&(u, v)| depth.get(u, v).is_some())
                .collect();
            assert_eq!(points.len(), expected.len());
            for (i, &(u, v)) in expected.iter().enumerate() {
                let z = f64::from(depth.get(u, v).unwrap()) * camera.depth_scale;
                let point = camera.deproject(u as f64, v as f64, z);
                assert_eq!(points.pixel[i] as usize, v * 8 + u);
                assert_eq!(points.point(i), point.cast::<f32>().cast::<f64>());
            }
        }
    }

    #[test]
    fn filling_again_reuses_the_memory() {
        let (depth, camera) = (depth(), camera(None));
        let mut points = DepthPoints::new();
        points
            .fill(&depth, &camera, PixelWindow::full(8, 6))
            .unwrap();
        let before = (points.len(), points.x.as_ptr(), points.pixel.as_ptr());
        points
            .fill(
                &depth,
                &camera,
                PixelWindow {
                    x0: 9,
                    y0: 0,
                    x1: 12,
                    y1: 2,
                },
            )
            .unwrap();
        assert!(points.is_empty());
        points
            .fill(&depth, &camera, PixelWindow::full(8, 6))
            .unwrap();
        assert_eq!(
            before,
            (points.len(), points.x.as_ptr(), points.pixel.as_ptr())
        );
    }

    #[test]
    fn a_bad_camera_or_image_is_an_error_and_leaves_no_points() {
        let window = PixelWindow::full(8, 6);
        let mut points = DepthPoints::new();
        points.fill(&depth(), &camera(None), window).unwrap();
        let unknown = Distortion {
            model: "fisheye".to_owned(),
            coefficients: vec![],
        };
        let error = points
            .fill(&depth(), &camera(Some(unknown)), window)
            .unwrap_err();
        assert!(error.to_string().contains("`fisheye`") && points.is_empty());
        let short = DepthImage {
            readings: vec![1; 47],
            ..depth()
        };
        assert!(points.fill(&short, &camera(None), window).is_err());
    }
}
