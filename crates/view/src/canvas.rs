use crate::ViewError;
use pomona_cloud::ColorImage;
use tiny_skia::{FillRule, LineCap, LineJoin, Paint, Path, PathBuilder, Pixmap, Stroke, Transform};

pub(crate) use tiny_skia::Point;

/// An opaque picture to draw on.
///
/// Coordinates are in pixels with (0, 0) at the outer corner of the top-left
/// pixel, so the centre of pixel (u, v) is (u + ½, v + ½).
pub(crate) struct Canvas {
    pixmap: Pixmap,
    /// Largest coordinate handed to the rasteriser; a path beyond is not drawn.
    reach: f32,
}

impl Canvas {
    pub(crate) fn new(image: &ColorImage) -> Result<Self, ViewError> {
        let (width, height) = (image.width, image.height);
        if width.checked_mul(height) != Some(image.pixels.len()) {
            return Err(ViewError::PixelCount {
                width,
                height,
                pixels: image.pixels.len(),
            });
        }
        let size = u32::try_from(width).ok().zip(u32::try_from(height).ok());
        let pixmap = size.and_then(|(w, h)| Pixmap::new(w, h));
        let mut pixmap = pixmap.ok_or(ViewError::Size { width, height })?;
        for (to, [r, g, b]) in pixmap.data_mut().chunks_exact_mut(4).zip(&image.pixels) {
            to.copy_from_slice(&[*r, *g, *b, u8::MAX]);
        }
        let reach = 4.0 * width.max(height) as f32 + 1000.0;
        Ok(Self { pixmap, reach })
    }

    pub(crate) fn into_image(self) -> ColorImage {
        let pixels = self
            .pixmap
            .data()
            .chunks_exact(4)
            .map(|p| [p[0], p[1], p[2]])
            .collect();
        ColorImage {
            width: self.width(),
            height: self.height(),
            pixels,
        }
    }

    pub(crate) fn width(&self) -> usize {
        self.pixmap.width() as usize
    }

    pub(crate) fn height(&self) -> usize {
        self.pixmap.height() as usize
    }

    /// Mixes `color` into one pixel with `alpha` in 0..=1; beyond the image, nothing.
    pub(crate) fn blend(&mut self, x: i32, y: i32, color: [u8; 3], alpha: f32) {
        let (Ok(x), Ok(y)) = (usize::try_from(x), usize::try_from(y)) else {
            return;
        };
        if x >= self.width() || y >= self.height() {
            return;
        }
        let at = 4 * (y * self.width() + x);
        for (channel, value) in self.pixmap.data_mut()[at..at + 3].iter_mut().zip(color) {
            let mixed = f32::from(*channel) + alpha * (f32::from(value) - f32::from(*channel));
            *channel = mixed.round() as u8;
        }
    }

    pub(crate) fn line(&mut self, a: Point, b: Point, color: [u8; 3], alpha: f32, width: f32) {
        self.polyline(&[a, b], false, color, alpha, width);
    }

    pub(crate) fn polyline(
        &mut self,
        points: &[Point],
        closed: bool,
        color: [u8; 3],
        alpha: f32,
        width: f32,
    ) {
        if let Some(path) = self.path(points, closed) {
            self.stroke(&path, color, alpha, width);
        }
    }

    pub(crate) fn polygon(&mut self, points: &[Point], color: [u8; 3], alpha: f32) {
        if let Some(path) = self.path(points, true) {
            self.fill(&path, color, alpha);
        }
    }

    pub(crate) fn disc(&mut self, center: Point, radius: f32, color: [u8; 3], alpha: f32) {
        if let Some(path) = self.circle_path(center, radius) {
            self.fill(&path, color, alpha);
        }
    }

    pub(crate) fn circle(
        &mut self,
        center: Point,
        radius: f32,
        color: [u8; 3],
        alpha: f32,
        width: f32,
    ) {
        if let Some(path) = self.circle_path(center, radius) {
            self.stroke(&path, color, alpha, width);
        }
    }

    /// A filled rectangle with rounded corners: left, top, width, height.
    pub(crate) fn rounded_rectangle(
        &mut self,
        [x, y, w, h]: [f32; 4],
        radius: f32,
        color: [u8; 3],
        alpha: f32,
    ) {
        let r = radius.min(w / 2.0).min(h / 2.0);
        if !self.within(&[Point::from_xy(x, y), Point::from_xy(x + w, y + h)]) {
            return;
        }
        let mut path = PathBuilder::new();
        path.move_to(x + r, y);
        path.line_to(x + w - r, y);
        path.quad_to(x + w, y, x + w, y + r);
        path.line_to(x + w, y + h - r);
        path.quad_to(x + w, y + h, x + w - r, y + h);
        path.line_to(x + r, y + h);
        path.quad_to(x, y + h, x, y + h - r);
        path.line_to(x, y + r);
        path.quad_to(x, y, x + r, y);
        path.close();
        if let Some(path) = path.finish() {
            self.fill(&path, color, alpha);
        }
    }

    fn within(&self, points: &[Point]) -> bool {
        // Written so that NaN is outside.
        points
            .iter()
            .all(|p| p.x.abs() <= self.reach && p.y.abs() <= self.reach)
    }

    fn path(&self, points: &[Point], closed: bool) -> Option<Path> {
        let (first, rest) = points.split_first()?;
        if rest.is_empty() || !self.within(points) {
            return None;
        }
        let mut path = PathBuilder::new();
        path.move_to(first.x, first.y);
        for p in rest {
            path.line_to(p.x, p.y);
        }
        if closed {
            path.close();
        }
        path.finish()
    }

    fn circle_path(&self, center: Point, radius: f32) -> Option<Path> {
        let usable = self.within(&[center]) && radius > 0.0 && radius <= self.reach;
        usable
            .then(|| PathBuilder::from_circle(center.x, center.y, radius))
            .flatten()
    }

    fn stroke(&mut self, path: &Path, color: [u8; 3], alpha: f32, width: f32) {
        let stroke = Stroke {
            width,
            line_cap: LineCap::Round,
            line_join: LineJoin::Round,
            ..Stroke::default()
        };
        self.pixmap.stroke_path(
            path,
            &paint(color, alpha),
            &stroke,
            Transform::identity(),
            None,
        );
    }

    fn fill(&mut self, path: &Path, color: [u8; 3], alpha: f32) {
        let rule = FillRule::Winding;
        self.pixmap.fill_path(
            path,
            &paint(color, alpha),
            rule,
            Transform::identity(),
            None,
        );
    }
}

fn paint(color: [u8; 3], alpha: f32) -> Paint<'static> {
    let mut paint = Paint::default();
    let [r, g, b] = color;
    paint.set_color_rgba8(r, g, b, (alpha.clamp(0.0, 1.0) * 255.0).round() as u8);
    paint.anti_alias = true;
    paint
}

#[cfg(test)]
mod tests {
    use super::*;

    fn black(width: usize, height: usize) -> ColorImage {
        ColorImage {
            width,
            height,
            pixels: vec![[0; 3]; width * height],
        }
    }

    #[test]
    fn refuses_what_is_no_picture() {
        assert!(matches!(
            Canvas::new(&black(0, 4)),
            Err(ViewError::Size { .. })
        ));
        let short = ColorImage {
            pixels: vec![],
            ..black(2, 2)
        };
        assert!(matches!(
            Canvas::new(&short),
            Err(ViewError::PixelCount { pixels: 0, .. })
        ));
        let endless = ColorImage {
            width: usize::MAX,
            height: 2,
            pixels: vec![],
        };
        assert!(Canvas::new(&endless).is_err());
    }

    #[test]
    fn a_disc_covers_its_centre_and_no_more() {
        let mut canvas = Canvas::new(&black(20, 20)).unwrap();
        canvas.disc(Point::from_xy(10.5, 10.5), 4.0, [200, 10, 0], 1.0);
        let image = canvas.into_image();
        assert_eq!(image.pixels[10 * 20 + 10], [200, 10, 0]);
        assert_eq!(image.pixels[2 * 20 + 10], [0; 3]);
    }

    #[test]
    fn what_cannot_be_drawn_is_left_out() {
        let mut canvas = Canvas::new(&black(20, 20)).unwrap();
        let (far, nan) = (Point::from_xy(1e30, 0.0), Point::from_xy(f32::NAN, 0.0));
        canvas.line(Point::from_xy(0.0, 0.0), far, [255; 3], 1.0, 2.0);
        canvas.polygon(&[nan, far, nan], [255; 3], 1.0);
        canvas.disc(far, f32::NAN, [255; 3], 1.0);
        canvas.rounded_rectangle([f32::NAN, 0.0, 5.0, 5.0], 1.0, [255; 3], 1.0);
        canvas.blend(-1, 40, [255; 3], 1.0);
        assert_eq!(canvas.into_image(), black(20, 20));
    }
}
