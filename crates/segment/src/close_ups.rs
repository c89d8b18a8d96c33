use crate::{
    classes::Role,
    error::SegmentError,
    options::SegmenterOptions,
    segmenter::{Segmenter, SegmenterReport},
};
use pomona_cloud::{ColorImage, GrayImage, PixelWindow};
use rayon::prelude::*;

/// How much a close-up is enlarged.
const ZOOM: f64 = 2.0;

/// Least side of a close-up, pixels of the image: what the built-in model's input shows, so that what lies about a place
/// is seen too.
const LEAST_SIDE: usize = 208;

/// Wood about some places of an image, seen twice: at the image's own scale with all that is around, and enlarged
/// twofold about each place, where thin twigs are wide enough to be told.
///
/// The result is the mean of both. Each place is in the middle of its own close-up, away from the edges of tiles,
/// so that places near to each other do not change each other's close-up, only where they overlap.
pub struct CloseUps {
    wide: Box<dyn Segmenter>,
    close: Box<dyn Segmenter>,
}

impl CloseUps {
    /// Opens the model twice; [`SegmenterOptions::zooms`] is not read.
    ///
    /// # Errors
    ///
    /// As [`SegmenterOptions::open`].
    pub fn open(options: &SegmenterOptions) -> Result<Self, SegmentError> {
        let mut at = options.clone();
        at.zooms = vec![1.0];
        let wide = at.open()?;
        at.zooms = vec![ZOOM];
        let close = at.open()?;
        Ok(Self { wide, close })
    }

    /// Which segmenter this is, for the record.
    pub fn report(&self) -> SegmenterReport {
        self.wide.report()
    }

    /// The probability of wood × 255 of the pixels in `windows`, and 0 elsewhere; an image of the same size.
    ///
    /// # Errors
    ///
    /// As [`Segmenter::segment_windows`].
    pub fn wood(
        &self,
        image: &ColorImage,
        windows: &[PixelWindow],
    ) -> Result<GrayImage, SegmentError> {
        let (width, height) = (image.width, image.height);
        let wide = self.wide.segment_windows(image, windows)?;
        let close: Vec<(PixelWindow, Vec<f32>)> = windows
            .par_iter()
            .map(|window| {
                let around = about(window, width, height);
                let seen = self.close.segment(&cut(image, around))?;
                Ok((around, seen.role(Role::Wood)))
            })
            .collect::<Result<_, SegmentError>>()?;
        let mut sums = vec![(0.0f32, 0u16); width * height];
        for (window, (around, wood)) in windows.iter().zip(&close) {
            for v in window.y0..window.y1 {
                for u in window.x0..window.x1 {
                    let sum = &mut sums[v * width + u];
                    sum.0 += wood[(v - around.y0) * around.width() + u - around.x0];
                    sum.1 += 1;
                }
            }
        }
        let wide = wide.role(Role::Wood);
        let mean = |(wide, (sum, count)): (&f32, &(f32, u16))| match count {
            0 => 0,
            _ => (127.5 * (wide + sum / f32::from(*count))).round() as u8,
        };
        Ok(GrayImage {
            width,
            height,
            values: wide.iter().zip(&sums).map(mean).collect(),
        })
    }
}

/// The window grown to the side of a close-up about its middle, as far as the image reaches.
fn about(window: &PixelWindow, width: usize, height: usize) -> PixelWindow {
    let grown = |from: usize, to: usize, size: usize| {
        let side = (to - from).max(LEAST_SIDE).min(size);
        let from = ((from + to).saturating_sub(side) / 2).min(size - side);
        (from, from + side)
    };
    let (x0, x1) = grown(window.x0, window.x1, width);
    let (y0, y1) = grown(window.y0, window.y1, height);
    PixelWindow { x0, y0, x1, y1 }
}

fn cut(image: &ColorImage, window: PixelWindow) -> ColorImage {
    let rows = window.y0..window.y1;
    ColorImage {
        width: window.width(),
        height: window.height(),
        pixels: rows
            .flat_map(|v| {
                let row = v * image.width;
                &image.pixels[row + window.x0..row + window.x1]
            })
            .copied()
            .collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_close_up_holds_its_window_and_stays_in_the_image() {
        for (x0, x1, width) in [(0, 10, 500), (490, 500, 500), (100, 420, 500), (30, 60, 90)] {
            let window = PixelWindow {
                x0,
                y0: 5,
                x1,
                y1: 9,
            };
            let around = about(&window, width, 300);
            assert!(around.x0 <= x0 && around.x1 >= x1 && around.x1 <= width);
            assert_eq!(around.width(), (x1 - x0).max(LEAST_SIDE).min(width));
            assert_eq!((around.y0, around.y1), (0, LEAST_SIDE));
        }
    }
}
