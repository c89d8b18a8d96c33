use crate::canvas::{Canvas, Point};
use crate::{ViewError, palette};
use pomona_cloud::ColorImage;

/// A square part of an image, enlarged, to be drawn on.
///
/// Places are in pixels of the image, (0, 0) its upper left corner and (0.5, 0.5) the middle of the first pixel; widths of
/// lines are in pixels of the picture. What lies outside the image is dark. What is not finite or far outside is not
/// drawn.
///
/// ```
/// use pomona_cloud::ColorImage;
/// use pomona_view::Enlargement;
///
/// let image = ColorImage::filled(64, 48, [90, 120, 80]);
/// let mut picture = Enlargement::new(&image, [20.0, 30.0], 10.0, 80)?;
/// picture.line(&[[12.0, 30.0], [20.0, 30.0]], [255, 0, 0], 2.0);
/// let picture = picture.into_image();
/// assert_eq!((picture.width, picture.height), (80, 80));
/// assert_eq!(picture.pixels[40 * 80 + 20], [255, 0, 0]);
/// # Ok::<(), pomona_view::ViewError>(())
/// ```
pub struct Enlargement {
    canvas: Canvas,
    /// The place at the picture's upper left corner.
    corner: [f64; 2],
    /// Pixels of the picture for one of the image.
    scale: f64,
}

impl Enlargement {
    /// The part within `half_side` pixels of `middle`, along both axes, as a picture of `side` × `side` pixels.
    ///
    /// # Errors
    ///
    /// [`ViewError`] for an invalid image, and for a picture without pixels.
    pub fn new(
        image: &ColorImage,
        middle: [f64; 2],
        half_side: f64,
        side: usize,
    ) -> Result<Self, ViewError> {
        let (width, height) = (image.width, image.height);
        if width.checked_mul(height) != Some(image.pixels.len()) {
            return Err(ViewError::PixelCount {
                width,
                height,
                pixels: image.pixels.len(),
            });
        }
        let corner = middle.map(|m| m - half_side);
        let scale = side as f64 / (2.0 * half_side);
        if side == 0 || !(scale.is_finite() && scale > 0.0) {
            return Err(ViewError::Size {
                width: side,
                height: side,
            });
        }
        let mut picture = ColorImage::filled(side, side, palette::BACKGROUND);
        for (k, pixel) in picture.pixels.iter_mut().enumerate() {
            let at = |index: usize, corner: f64| corner + (index as f64 + 0.5) / scale;
            let place = [at(k % side, corner[0]), at(k / side, corner[1])];
            if let Some(color) = interpolated(image, place) {
                *pixel = color;
            }
        }
        Ok(Self {
            canvas: Canvas::new(&picture)?,
            corner,
            scale,
        })
    }

    /// Draws a line through `points`.
    pub fn line(&mut self, points: &[[f64; 2]], color: [u8; 3], width: f32) {
        let points: Vec<Point> = points.iter().map(|&place| self.point(place)).collect();
        self.canvas.polyline(&points, false, color, 1.0, width);
    }

    /// Draws a circle of this radius in pixels of the image.
    pub fn circle(&mut self, middle: [f64; 2], radius: f64, color: [u8; 3], width: f32) {
        let (middle, radius) = (self.point(middle), (radius * self.scale) as f32);
        self.canvas.circle(middle, radius, color, 1.0, width);
    }

    /// Draws a dot of this radius in pixels of the picture.
    pub fn dot(&mut self, middle: [f64; 2], radius: f32, color: [u8; 3]) {
        let middle = self.point(middle);
        self.canvas.disc(middle, radius, color, 1.0);
    }

    /// The picture.
    pub fn into_image(self) -> ColorImage {
        self.canvas.into_image()
    }

    fn point(&self, place: [f64; 2]) -> Point {
        let [x, y] = [0, 1].map(|axis| (place[axis] - self.corner[axis]) * self.scale);
        Point::from_xy(x as f32, y as f32)
    }
}

/// The colour at a place between pixels' middles, bilinear; `None` outside the image.
fn interpolated(image: &ColorImage, [x, y]: [f64; 2]) -> Option<[u8; 3]> {
    let (width, height) = (image.width as f64, image.height as f64);
    if !(x >= 0.0 && y >= 0.0 && x < width && y < height) {
        return None;
    }
    let split = |place: f64, size: usize| {
        let place = (place - 0.5).clamp(0.0, (size - 1) as f64);
        let first = place as usize;
        (first, (first + 1).min(size - 1), place - first as f64)
    };
    let (left, right, s) = split(x, image.width);
    let (top, bottom, t) = split(y, image.height);
    let at = |u: usize, v: usize| image.pixels[v * image.width + u];
    Some([0, 1, 2].map(|channel| {
        let value = |u, v| f64::from(at(u, v)[channel]);
        let upper = value(left, top) * (1.0 - s) + value(right, top) * s;
        let lower = value(left, bottom) * (1.0 - s) + value(right, bottom) * s;
        (upper * (1.0 - t) + lower * t).round() as u8
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_shows_the_image_around_its_middle() {
        let mut image = ColorImage::filled(20, 10, [0, 100, 0]);
        image.pixels[5 * 20 + 7] = [200, 0, 0];
        let picture = Enlargement::new(&image, [7.5, 5.5], 2.0, 40).unwrap();
        let picture = picture.into_image();
        // The even number of pixels has none in the very middle.
        assert!(picture.pixels[20 * 40 + 20][0] > 180);
        assert_eq!(picture.pixels[20 * 40 + 2], [0, 100, 0]);
    }

    #[test]
    fn beyond_the_image_it_is_dark_and_what_is_no_number_is_left_out() {
        let image = ColorImage::filled(20, 10, [0, 100, 0]);
        let mut picture = Enlargement::new(&image, [0.0, 0.0], 4.0, 32).unwrap();
        picture.line(&[[f64::NAN, 0.0], [3.0, 3.0]], [255; 3], 2.0);
        picture.dot([1e30, 0.0], 3.0, [255; 3]);
        picture.circle([2.0, 2.0], f64::INFINITY, [255; 3], 1.0);
        let picture = picture.into_image();
        assert_eq!(picture.pixels[8 * 32 + 8], palette::BACKGROUND);
        assert_eq!(picture.pixels[24 * 32 + 24], [0, 100, 0]);
    }

    #[test]
    fn what_is_no_picture_is_refused() {
        let image = ColorImage::filled(20, 10, [0; 3]);
        for (half_side, side) in [(0.0, 32), (f64::NAN, 32), (-1.0, 32), (4.0, 0)] {
            assert!(Enlargement::new(&image, [5.0, 5.0], half_side, side).is_err());
        }
    }
}
