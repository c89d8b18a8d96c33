/// A rectangle of whole pixels inside an image: columns `x0..x1` of rows `y0..y1`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PixelWindow {
    /// First column.
    pub x0: usize,
    /// First row.
    pub y0: usize,
    /// One past the last column.
    pub x1: usize,
    /// One past the last row.
    pub y1: usize,
}

impl PixelWindow {
    /// The whole of an image.
    pub fn full(width: usize, height: usize) -> Self {
        Self {
            x0: 0,
            y0: 0,
            x1: width,
            y1: height,
        }
    }

    /// The pixels (u, v) of a `width` × `height` image with `x_min <= u < x_max` and
    /// `y_min <= v < y_max`; empty where there are none, also for NaN.
    pub fn clamped(
        x_min: f64,
        y_min: f64,
        x_max: f64,
        y_max: f64,
        width: usize,
        height: usize,
    ) -> Self {
        // A float cast saturates: negative numbers and NaN become 0.
        let first = |edge: f64, size: usize| (edge.ceil() as usize).min(size);
        let (x0, y0) = (first(x_min, width), first(y_min, height));
        let (x1, y1) = (first(x_max, width).max(x0), first(y_max, height).max(y0));
        Self { x0, y0, x1, y1 }
    }

    /// Wider by `margin` pixels on each side, as far as a `width` × `height` image reaches.
    #[must_use]
    pub fn grown(self, margin: usize, width: usize, height: usize) -> Self {
        Self {
            x0: self.x0.saturating_sub(margin),
            y0: self.y0.saturating_sub(margin),
            x1: self.x1.saturating_add(margin).min(width),
            y1: self.y1.saturating_add(margin).min(height),
        }
    }

    /// The pixels that both windows hold.
    #[must_use]
    pub fn intersection(self, other: Self) -> Self {
        let (x0, y0) = (self.x0.max(other.x0), self.y0.max(other.y0));
        Self {
            x0,
            y0,
            x1: self.x1.min(other.x1).max(x0),
            y1: self.y1.min(other.y1).max(y0),
        }
    }

    /// Number of columns.
    pub fn width(&self) -> usize {
        self.x1.saturating_sub(self.x0)
    }

    /// Number of rows.
    pub fn height(&self) -> usize {
        self.y1.saturating_sub(self.y0)
    }

    /// Number of pixels.
    pub fn pixel_count(&self) -> usize {
        self.width().saturating_mul(self.height())
    }

    /// Whether it holds no pixel.
    pub fn is_empty(&self) -> bool {
        self.pixel_count() == 0
    }

    /// Whether it holds the pixel at column `u` of row `v`.
    pub fn contains(&self, u: usize, v: usize) -> bool {
        (self.x0..self.x1).contains(&u) && (self.y0..self.y1).contains(&v)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clamping_takes_the_pixels_between_the_edges() {
        let w = PixelWindow::clamped(1.0, 2.5, 4.0, 4.5, 10, 10);
        assert_eq!(
            w,
            PixelWindow {
                x0: 1,
                y0: 3,
                x1: 4,
                y1: 5
            }
        );
        assert_eq!((w.width(), w.height(), w.pixel_count()), (3, 2, 6));
        assert!(w.contains(1, 3) && !w.contains(4, 3) && !w.contains(1, 5));
        let all = PixelWindow::clamped(-5.0, f64::NEG_INFINITY, 1e300, f64::INFINITY, 10, 7);
        assert_eq!(all, PixelWindow::full(10, 7));
        for empty in [
            PixelWindow::clamped(4.0, 0.0, 2.0, 5.0, 10, 10),
            PixelWindow::clamped(20.0, 0.0, 30.0, 5.0, 10, 10),
            PixelWindow::clamped(-9.0, 0.0, -3.0, 5.0, 10, 10),
            PixelWindow::clamped(0.0, 0.0, f64::NAN, 5.0, 10, 10),
        ] {
            assert!(empty.is_empty(), "{empty:?}");
        }
    }

    #[test]
    fn growing_stops_at_the_border() {
        let w = PixelWindow {
            x0: 2,
            y0: 3,
            x1: 4,
            y1: 5,
        };
        assert_eq!(
            w.grown(2, 10, 6),
            PixelWindow {
                x0: 0,
                y0: 1,
                x1: 6,
                y1: 6
            }
        );
        assert_eq!(w.grown(usize::MAX, 10, 6), PixelWindow::full(10, 6));
        assert_eq!(w.grown(2, 10, 6).intersection(w), w);
        assert!(
            w.intersection(PixelWindow {
                x0: 7,
                y0: 0,
                x1: 9,
                y1: 9
            })
            .is_empty()
        );
    }
}
