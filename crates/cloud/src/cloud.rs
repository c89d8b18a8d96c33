use crate::{CloudError, ColorImage, DepthPoints, Frame, PixelWindow};
use nalgebra::Point3;

/// A point cloud in separate coordinate arrays, in metres, as f32.
///
/// All arrays have the same length. An organised cloud (`width` and `height`
/// set, `width * height` points, row by row) keeps pixels without a reading as NaN points.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct PointCloud {
    /// x coordinates.
    pub x: Vec<f32>,
    /// y coordinates.
    pub y: Vec<f32>,
    /// z coordinates.
    pub z: Vec<f32>,
    /// Colours, as many as points, where the cloud has them.
    pub colors: Option<Vec<[u8; 3]>>,
    /// Width and height of an organised cloud.
    pub size: Option<(usize, usize)>,
}

impl PointCloud {
    /// An empty cloud.
    pub fn new() -> Self {
        Self::default()
    }

    /// A cloud without colours, not organised; the three arrays have the same length.
    pub fn from_coordinates(x: Vec<f32>, y: Vec<f32>, z: Vec<f32>) -> Self {
        Self {
            x,
            y,
            z,
            ..Self::default()
        }
    }

    /// Number of points, those that are NaN included.
    pub fn len(&self) -> usize {
        self.x.len()
    }

    /// Whether there are no points.
    pub fn is_empty(&self) -> bool {
        self.x.is_empty()
    }

    /// Point `i`; NaN for a pixel of an organised cloud that has no reading.
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

    /// The points whose coordinates are all finite.
    pub fn finite_points(&self) -> impl Iterator<Item = Point3<f64>> + '_ {
        let coordinates = self.x.iter().zip(&self.y).zip(&self.z);
        coordinates
            .map(|((&x, &y), &z)| Point3::new(f64::from(x), f64::from(y), f64::from(z)))
            .filter(|p| p.iter().all(|c| c.is_finite()))
    }

    /// Adds a point; the cloud is no longer organised then. A point without a colour in
    /// a cloud with colours becomes black, and a colour is dropped where the points before have none.
    pub fn push(&mut self, point: Point3<f64>, color: Option<[u8; 3]>) {
        if self.is_empty() && color.is_some() {
            self.colors.get_or_insert_with(Vec::new);
        }
        if let Some(colors) = &mut self.colors {
            colors.push(color.unwrap_or_default());
        }
        self.x.push(point.x as f32);
        self.y.push(point.y as f32);
        self.z.push(point.z as f32);
        self.size = None;
    }

    /// The whole frame as an organised cloud with colours.
    ///
    /// # Errors
    ///
    /// As [`Frame::window`].
    pub fn from_frame(frame: &Frame) -> Result<Self, CloudError> {
        let (width, height) = (frame.depth.width, frame.depth.height);
        let points = frame.window(PixelWindow::full(width, height))?;
        let mut cloud = Self {
            x: vec![f32::NAN; width * height],
            y: vec![f32::NAN; width * height],
            z: vec![f32::NAN; width * height],
            colors: (frame.color.pixels.len() == width * height)
                .then(|| frame.color.pixels.clone()),
            size: Some((width, height)),
        };
        for (i, &pixel) in points.pixel.iter().enumerate() {
            let pixel = pixel as usize;
            cloud.x[pixel] = points.x[i];
            cloud.y[pixel] = points.y[i];
            cloud.z[pixel] = points.z[i];
        }
        Ok(cloud)
    }

    /// An unorganised cloud of points of a depth image, with the colours of their pixels.
    pub fn from_points(points: &DepthPoints, color: &ColorImage) -> Self {
        let colors = points
            .pixel
            .iter()
            .map(|&p| color.pixels.get(p as usize).copied());
        Self {
            x: points.x.clone(),
            y: points.y.clone(),
            z: points.z.clone(),
            colors: colors.collect(),
            size: None,
        }
    }

    /// The part of an organised cloud in a window of its pixels, organised too; `None` for a
    /// cloud that is not organised.
    pub fn crop(&self, window: PixelWindow) -> Option<Self> {
        let (width, height) = self.size?;
        let window = window.intersection(PixelWindow::full(width, height));
        let indices =
            (window.y0..window.y1).flat_map(|v| (window.x0..window.x1).map(move |u| v * width + u));
        let mut part = self.select(indices);
        let size = (window.width(), window.height());
        // Indices are missing only where this cloud has fewer points than its size says.
        part.size = (part.len() == window.pixel_count()).then_some(size);
        Some(part)
    }

    /// An unorganised cloud of the points at `indices`, in that order; indices without a point are skipped.
    #[must_use]
    pub fn select(&self, indices: impl IntoIterator<Item = usize>) -> Self {
        let mut part = Self {
            colors: self.colors.as_ref().map(|_| Vec::new()),
            ..Self::default()
        };
        for i in indices.into_iter().filter(|&i| i < self.len()) {
            part.x.push(self.x[i]);
            part.y.push(self.y[i]);
            part.z.push(self.z[i]);
            if let (Some(kept), Some(colors)) = (&mut part.colors, &self.colors) {
                kept.push(colors.get(i).copied().unwrap_or_default());
            }
        }
        part
    }

    /// Why the arrays do not belong together, in words; `None` where they do.
    pub(crate) fn inconsistency(&self) -> Option<String> {
        let count = self.len();
        if self.y.len() != count || self.z.len() != count {
            return Some(format!(
                "{count} x, {} y and {} z coordinates",
                self.y.len(),
                self.z.len()
            ));
        }
        if let Some(colors) = self.colors.as_ref().filter(|colors| colors.len() != count) {
            return Some(format!("{} colours for {count} points", colors.len()));
        }
        let (width, height) = self.size?;
        (width.checked_mul(height) != Some(count))
            .then(|| format!("{count} points for an organised cloud of {width}x{height}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbered(count: usize, size: Option<(usize, usize)>) -> PointCloud {
        let x: Vec<f32> = (0..count).map(|i| i as f32).collect();
        let colors = Some((0..count).map(|i| [i as u8; 3]).collect());
        PointCloud {
            y: x.clone(),
            z: x.clone(),
            x,
            colors,
            size,
        }
    }

    #[test]
    fn a_crop_keeps_rows_and_columns() {
        let cloud = numbered(12, Some((4, 3)));
        let part = cloud
            .crop(PixelWindow {
                x0: 1,
                y0: 1,
                x1: 3,
                y1: 9,
            })
            .unwrap();
        assert_eq!(part.x, [5.0, 6.0, 9.0, 10.0]);
        assert_eq!((part.size, part.inconsistency()), (Some((2, 2)), None));
        assert_eq!(part.colors.unwrap()[3], [10; 3]);
        assert_eq!(numbered(12, None).crop(PixelWindow::full(4, 3)), None);
        let empty = cloud
            .crop(PixelWindow {
                x0: 9,
                y0: 9,
                x1: 12,
                y1: 12,
            })
            .unwrap();
        assert!(empty.is_empty());
    }

    #[test]
    fn a_crop_of_a_cloud_with_missing_points_is_still_whole() {
        let cloud = PointCloud {
            size: Some((4, 99)),
            ..numbered(12, None)
        };
        let part = cloud.crop(PixelWindow::full(4, 99)).unwrap();
        assert_eq!(part.inconsistency(), None);
    }

    #[test]
    fn pushing_keeps_as_many_colours_as_points() {
        let mut cloud = PointCloud::new();
        cloud.push(Point3::new(1.0, 2.0, 3.0), None);
        cloud.push(Point3::new(1.0, f64::NAN, 3.0), Some([9; 3]));
        assert_eq!((cloud.len(), &cloud.colors), (2, &None));
        assert_eq!(
            cloud.finite_points().collect::<Vec<_>>(),
            [Point3::new(1.0, 2.0, 3.0)]
        );
        assert!(cloud.point(1).y.is_nan());
        let mut colored = PointCloud::new();
        colored.push(Point3::origin(), Some([9; 3]));
        colored.push(Point3::origin(), None);
        assert_eq!(colored.colors, Some(vec![[9; 3], [0; 3]]));
    }
}
