use crate::{
    preparation::{ChannelOrder, Padding, Preparation},
    resample::Resampling,
};
use pomona_cloud::{ColorImage, PixelWindow};

/// How a window of an image lies in a network's input, and the way back.
///
/// Both sides count in pixels from the upper left edge: the first pixel spans 0 to 1. The scaled window covers
/// whole pixels of the input, so that its scales along x and y may differ by a rounding; the mapping knows both,
/// and is exact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Letterbox {
    window: PixelWindow,
    input: [usize; 2],
    /// Columns and rows of the input that the window covers.
    covered: [usize; 2],
    /// First covered column and row.
    first: [usize; 2],
}

impl Letterbox {
    /// The window in an input of `[width, height]` pixels; `None` where either is empty.
    pub fn new(window: PixelWindow, input: [usize; 2], padding: Padding) -> Option<Self> {
        let size = [window.width(), window.height()];
        if size.contains(&0) || input.contains(&0) {
            return None;
        }
        let ratio = (input[0] as f64 / size[0] as f64).min(input[1] as f64 / size[1] as f64);
        let covered = match padding {
            Padding::Stretch => input,
            Padding::Center | Padding::TopLeft => {
                [0, 1].map(|k| ((size[k] as f64 * ratio).round() as usize).clamp(1, input[k]))
            }
        };
        let first = match padding {
            Padding::Center => [0, 1].map(|k| (input[k] - covered[k]) / 2),
            Padding::TopLeft | Padding::Stretch => [0, 0],
        };
        Some(Self {
            window,
            input,
            covered,
            first,
        })
    }

    /// The window of the image.
    pub fn window(&self) -> PixelWindow {
        self.window
    }

    /// Pixels of the input for each pixel of the image, along x and y.
    pub fn scale(&self) -> [f64; 2] {
        [
            self.covered[0] as f64 / self.window.width() as f64,
            self.covered[1] as f64 / self.window.height() as f64,
        ]
    }

    /// Where a point of the image lies in the input.
    pub fn to_input(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let scale = self.scale();
        [
            self.first[0] as f64 + (x - self.window.x0 as f64) * scale[0],
            self.first[1] as f64 + (y - self.window.y0 as f64) * scale[1],
        ]
    }

    /// Where a point of the input lies in the image.
    pub fn to_image(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let scale = self.scale();
        [
            self.window.x0 as f64 + (x - self.first[0] as f64) / scale[0],
            self.window.y0 as f64 + (y - self.first[1] as f64) / scale[1],
        ]
    }

    /// The input's numbers, sampled from the image: three planes of `height` rows of `width`, channel by channel.
    ///
    /// Windows that are enlarged, or reduced by at most 2, are interpolated bilinearly between pixel centres; those
    /// that are reduced by more are averaged over the area that each new pixel covers. The window is read in place,
    /// without a copy. `None` where it reaches beyond the image, or the image holds fewer pixels than its size says.
    pub fn sample(&self, image: &ColorImage, preparation: &Preparation) -> Option<Vec<f32>> {
        let window = self.window;
        let fits = window.x1 <= image.width && window.y1 <= image.height;
        if !fits || image.pixels.len() < image.width.checked_mul(image.height)? {
            return None;
        }
        let gain = preparation.std.map(|std| preparation.scale / std);
        let offset = [0, 1, 2].map(|c| -preparation.mean[c] / preparation.std[c]);
        let source = match preparation.channels {
            ChannelOrder::Rgb => [0, 1, 2],
            ChannelOrder::Bgr => [2, 1, 0],
        };
        let plane = self.input[0].checked_mul(self.input[1])?;
        let mut values = vec![0.0; plane.checked_mul(3)?];
        for (c, plane) in values.chunks_exact_mut(plane).enumerate() {
            plane.fill(f32::from(preparation.fill) * gain[c] + offset[c]);
        }
        let columns = Resampling::new(window.width(), self.covered[0]);
        let rows = Resampling::new(window.height(), self.covered[1]);
        let mut line = vec![0.0; 3 * window.width()];
        for j in 0..self.covered[1] {
            line.fill(0.0);
            for (v, weight) in rows.taps(j) {
                let start = (window.y0 + v) * image.width + window.x0;
                let pixels = image.pixels[start..start + window.width()].as_flattened();
                for (sum, &value) in line.iter_mut().zip(pixels) {
                    *sum += weight * f32::from(value);
                }
            }
            let start = (self.first[1] + j) * self.input[0] + self.first[0];
            for c in 0..3 {
                let row = &mut values[c * plane + start..][..self.covered[0]];
                columns.mix(&line[source[c]..], 3, row);
                for value in row {
                    *value = *value * gain[c] + offset[c];
                }
            }
        }
        Some(values)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const PLAIN: Preparation = Preparation {
        channels: ChannelOrder::Rgb,
        scale: 1.0,
        mean: [0.0; 3],
        std: [1.0; 3],
        padding: Padding::Center,
        fill: 114,
    };

    fn paddings() -> impl Strategy<Value = Padding> {
        prop_oneof![
            Just(Padding::Center),
            Just(Padding::TopLeft),
            Just(Padding::Stretch)
        ]
    }

    fn window(x0: usize, y0: usize, width: usize, height: usize) -> PixelWindow {
        PixelWindow {
            x0,
            y0,
            x1: x0 + width,
            y1: y0 + height,
        }
    }

    proptest! {
        #[test]
        fn there_and_back_is_the_identity(
            place in (0_usize..3000, 0_usize..3000),
            size in (1_usize..5000, 1_usize..5000),
            input in (1_usize..1300, 1_usize..1300),
            padding in paddings(),
            at in (-0.5..1.5, -0.5..1.5),
        ) {
            let window = window(place.0, place.1, size.0, size.1);
            let letterbox = Letterbox::new(window, [input.0, input.1], padding).unwrap();
            let point = [
                place.0 as f64 + at.0 * size.0 as f64,
                place.1 as f64 + at.1 * size.1 as f64,
            ];
            let back = letterbox.to_image(letterbox.to_input(point));
            for k in 0..2 {
                prop_assert!((back[k] - point[k]).abs() < 1e-9, "{back:?} {point:?}");
            }
            // The window's corners stay in the input.
            for corner in [[window.x0, window.y0], [window.x1, window.y1]] {
                let corner = letterbox.to_input(corner.map(|c| c as f64));
                prop_assert!(corner[0] > -1e-9 && corner[0] < input.0 as f64 + 1e-9);
                prop_assert!(corner[1] > -1e-9 && corner[1] < input.1 as f64 + 1e-9);
            }
        }

        /// A bright rectangle on black: the centre of its light in the input is where the mapping says.
        #[test]
        fn pixels_land_where_the_mapping_says(
            place in (0_usize..40, 0_usize..40),
            size in (60_usize..400, 60_usize..400),
            input in (32_usize..200, 32_usize..200),
            padding in paddings(),
            blob in (0.2..0.6, 0.2..0.6, 0.1..0.3, 0.1..0.3),
        ) {
            let mut image = ColorImage::filled(place.0 + size.0 + 7, place.1 + size.1 + 5, [0; 3]);
            let part = |share: f64, size: usize| ((share * size as f64) as usize).max(1);
            let x = place.0 + part(blob.0, size.0);
            let y = place.1 + part(blob.1, size.1);
            let (w, h) = (part(blob.2, size.0), part(blob.3, size.1));
            for v in y..y + h {
                for u in x..x + w {
                    image.pixels[v * image.width + u] = [255, 100, 10];
                }
            }
            let window = window(place.0, place.1, size.0, size.1);
            let preparation = Preparation { fill: 0, padding, ..PLAIN };
            let letterbox = Letterbox::new(window, [input.0, input.1], padding).unwrap();
            let values = letterbox.sample(&image, &preparation).unwrap();
            let plane = &values[..input.0 * input.1];
            let (mut sum, mut sx, mut sy) = (0.0, 0.0, 0.0);
            for (k, &value) in plane.iter().enumerate() {
                let value = f64::from(value);
                sum += value;
                sx += value * ((k % input.0) as f64 + 0.5);
                sy += value * ((k / input.0) as f64 + 0.5);
            }
            let centre = [x as f64 + w as f64 / 2.0, y as f64 + h as f64 / 2.0];
            let expected = letterbox.to_input(centre);
            prop_assert!(sum > 0.0);
            prop_assert!((sx / sum - expected[0]).abs() < 0.5, "{} {expected:?}", sx / sum);
            prop_assert!((sy / sum - expected[1]).abs() < 0.5, "{} {expected:?}", sy / sum);
        }
    }

    #[test]
    fn a_window_of_the_input_s_size_is_copied_as_it_is() {
        let mut image = ColorImage::filled(9, 7, [0; 3]);
        for (k, pixel) in image.pixels.iter_mut().enumerate() {
            *pixel = [k as u8, 100 + k as u8, 200 - k as u8];
        }
        let letterbox = Letterbox::new(window(2, 3, 4, 3), [4, 3], Padding::Center).unwrap();
        let preparation = Preparation {
            channels: ChannelOrder::Bgr,
            ..PLAIN
        };
        let values = letterbox.sample(&image, &preparation).unwrap();
        for (k, value) in values.iter().enumerate() {
            let (c, v, u) = (k / 12, k % 12 / 4, k % 4);
            let pixel = image.get(2 + u, 3 + v).unwrap();
            assert_eq!(*value, f32::from(pixel[2 - c]));
        }
    }

    #[test]
    fn padding_and_scale_are_as_told() {
        let image = ColorImage::filled(20, 10, [255, 0, 51]);
        let full = PixelWindow::full(20, 10);
        let preparation = Preparation {
            scale: Preparation::UNIT_SCALE,
            mean: [0.5, 0.0, 0.0],
            std: [0.5, 1.0, 0.1],
            ..PLAIN
        };
        let letterbox = Letterbox::new(full, [10, 10], Padding::Center).unwrap();
        let values = letterbox.sample(&image, &preparation).unwrap();
        let near = |a: f32, b: f32| assert!((a - b).abs() < 1e-6, "{a} {b}");
        let grey = 114.0 / 255.0;
        // Two rows and a half of padding: two above, three below.
        near(values[0], (grey - 0.5) / 0.5);
        near(values[19], (grey - 0.5) / 0.5);
        near(values[20], 1.0);
        near(values[69], 1.0);
        near(values[70], (grey - 0.5) / 0.5);
        near(values[120], 0.0);
        near(values[220], 2.0);
        let letterbox = Letterbox::new(full, [10, 10], Padding::TopLeft).unwrap();
        let values = letterbox.sample(&image, &preparation).unwrap();
        near(values[0], 1.0);
        near(values[50], (grey - 0.5) / 0.5);
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        let image = ColorImage::filled(4, 4, [0; 3]);
        assert!(Letterbox::new(PixelWindow::full(0, 4), [8, 8], Padding::Center).is_none());
        assert!(Letterbox::new(PixelWindow::full(4, 4), [0, 8], Padding::Center).is_none());
        let wide = Letterbox::new(PixelWindow::full(5, 4), [8, 8], Padding::Center).unwrap();
        assert!(wide.sample(&image, &PLAIN).is_none());
        let short = ColorImage {
            pixels: vec![[0; 3]; 15],
            ..image
        };
        let letterbox = Letterbox::new(PixelWindow::full(4, 4), [8, 8], Padding::Center).unwrap();
        assert!(letterbox.sample(&short, &PLAIN).is_none());
        assert!(
            letterbox
                .sample(
                    &ColorImage {
                        width: usize::MAX,
                        ..short
                    },
                    &PLAIN
                )
                .is_none()
        );
    }
}
