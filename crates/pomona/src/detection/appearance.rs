//! The colour of a frame's own apples.

use crate::chromaticity::chromaticity;
use nalgebra::{Matrix2, Vector2};
use pomona_cloud::{ColorImage, DepthImage};

/// Fewest apples from which a colour is learnt.
const LEAST_APPLES: usize = 3;

/// Standard deviations within which a pixel has the apples' colour, squared.
const WITHIN: f64 = 9.0;

/// Standard deviation that is added to every colour: light differs from place to place.
const FLOOR: f64 = 0.02;

/// Chromaticity (shares of red and green in the sum of all three) of what is known to be apple.
#[derive(Clone, Debug, Default)]
pub(super) struct Palette {
    apples: usize,
    count: f64,
    sum: Vector2<f64>,
    squares: Matrix2<f64>,
}

impl Palette {
    /// Learns from the pixels of one apple.
    pub(super) fn learn(&mut self, color: &ColorImage, pixels: impl Iterator<Item = u32>) {
        let mut any = false;
        for c in pixels.filter_map(|pixel| chromaticity(color, pixel as usize)) {
            self.count += 1.0;
            self.sum += c;
            self.squares += c * c.transpose();
            any = true;
        }
        self.apples += usize::from(any);
    }

    /// The colour learnt; `None` from too few apples to tell.
    pub(super) fn learnt(&self) -> Option<Shade> {
        if self.apples < LEAST_APPLES {
            return None;
        }
        let mean = self.sum / self.count;
        let spread = self.squares / self.count - mean * mean.transpose();
        let precision = (spread + Matrix2::identity() * FLOOR * FLOOR).try_inverse()?;
        Some(Shade { mean, precision })
    }
}

/// A colour and how far apples stray from it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shade {
    mean: Vector2<f64>,
    precision: Matrix2<f64>,
}

impl Shade {
    /// Share of the pixels that have the apples' colour.
    pub(super) fn share(&self, color: &ColorImage, pixels: impl Iterator<Item = u32>) -> f64 {
        let (mut all, mut alike) = (0usize, 0usize);
        for c in pixels.filter_map(|pixel| chromaticity(color, pixel as usize)) {
            let d = c - self.mean;
            all += 1;
            alike += usize::from(d.dot(&(self.precision * d)) <= WITHIN);
        }
        alike as f64 / all.max(1) as f64
    }
}

/// The two images have one size, and so one numbering of pixels.
pub(super) fn same_size(color: &ColorImage, depth: &DepthImage) -> bool {
    (color.width, color.height) == (depth.width, depth.height)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn red_apples_are_not_green_leaves() {
        let mut image = ColorImage::filled(10, 2, [180, 40, 30]);
        image.pixels[10..].fill([60, 120, 40]);
        let mut palette = Palette::default();
        assert!(palette.learnt().is_none());
        for _ in 0..LEAST_APPLES {
            palette.learn(&image, 0..10);
        }
        let shade = palette.learnt().unwrap();
        assert_eq!(shade.share(&image, 0..10), 1.0);
        assert_eq!(shade.share(&image, 10..20), 0.0);
        assert_eq!(shade.share(&image, 99..120), 0.0, "outside");
    }
}
