use super::brightness::{BRIGHTNESS_SHARE, brightened};
use super::frame::RealFrame;
use pomona_cloud::{DepthImage, PixelBox};
use pomona_statistics::median;
use rand_chacha::ChaCha8Rng;
use rand_core::{Rng, SeedableRng};

/// Boxes are moved and scaled by up to this share of their sides: what two people's boxes of an apple differ by.
const BOX_SHARE: f64 = 0.05;

/// A standard deviation over the median of the absolute values, for normal noise: 1 / Φ⁻¹(3/4).
const SD_PER_MEDIAN: f64 = 1.4826;

/// Brightness of a copy. One copy of three keeps the colour of the frame, so that a segmenter runs twice more for any
/// number of copies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Brightness {
    Same,
    Darker,
    Brighter,
}

impl Brightness {
    pub(super) fn of_copy(copy: usize) -> Self {
        [Self::Same, Self::Darker, Self::Brighter][copy % 3]
    }
}

/// Standard deviation of the noise of the readings, in units of the image; `None` where nowhere three readings stand side by side.
///
/// Second differences along rows: on a smooth surface they are noise, of variance 6σ² = (1 + 4 + 1)σ², and edges are few enough for
/// the median (Gasser, Sroka and Jennen-Steinmetz 1986, Biometrika 73(3), 625–633). Of depth that was
/// interpolated when it was registered to the colour image neighbours share noise, and the figure is too low.
pub(super) fn depth_noise(depth: &DepthImage) -> Option<f64> {
    let rows = depth.readings.chunks_exact(depth.width.max(1));
    let triples = rows.flat_map(|row| row.windows(3));
    let mut differences: Vec<f64> = triples
        .filter(|triple| triple.iter().all(|&reading| reading != 0))
        .map(|t| (f64::from(t[0]) - 2.0 * f64::from(t[1]) + f64::from(t[2])).abs())
        .collect();
    Some(median(&mut differences)? * SD_PER_MEDIAN / 6.0_f64.sqrt())
}

/// A copy of a frame as another moment and another hand would have made it: its boxes moved and scaled, noise of
/// standard deviation `noise` units added to its readings, its colour and wood of the copy's brightness.
pub(super) fn perturbed(frame: &RealFrame, copy: usize, seed: u64, noise: f64) -> RealFrame {
    let mut draws = Draws::new(seed, &frame.frame.id, copy);
    let mut other = frame.clone();
    let (width, height) = (frame.frame.color.width, frame.frame.color.height);
    for bounds in other.frame.boxes.iter_mut().flatten() {
        let moved = draws.moved(bounds);
        // A sliver at the edge of the image may be moved out of it; it stays where it is.
        if moved.window(width, height).is_ok() {
            *bounds = moved;
        }
    }
    for reading in other.frame.depth.readings.iter_mut().filter(|r| **r != 0) {
        let noisy = f64::from(*reading) + noise * draws.normal();
        // 0 would be no reading.
        *reading = noisy.round().clamp(1.0, f64::from(u16::MAX)) as u16;
    }
    let (factor, wood) = match Brightness::of_copy(copy) {
        Brightness::Same => return other,
        Brightness::Darker => (1.0 - BRIGHTNESS_SHARE, &frame.darker_wood),
        Brightness::Brighter => (1.0 + BRIGHTNESS_SHARE, &frame.brighter_wood),
    };
    other.frame.color = brightened(&frame.frame.color, factor);
    if wood.is_some() {
        other.wood.clone_from(wood);
    }
    other
}

/// The random numbers of one copy.
struct Draws(ChaCha8Rng);

impl Draws {
    /// Keyed by (seed, frame id, copy), so that other frames and copies do not touch its numbers.
    fn new(seed: u64, frame: &str, copy: usize) -> Self {
        let mut key = [0; 32];
        key[..8].copy_from_slice(&seed.to_le_bytes());
        key[8..16].copy_from_slice(&(copy as u64).to_le_bytes());
        for (i, byte) in frame.bytes().enumerate() {
            key[16 + i % 16] ^= byte;
        }
        Self(ChaCha8Rng::from_seed(key))
    }

    /// Uniform in 0..1.
    fn unit(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Uniform between −[`BOX_SHARE`] and it.
    fn share(&mut self) -> f64 {
        BOX_SHARE * (2.0 * self.unit() - 1.0)
    }

    /// Standard normal (Box and Muller 1958, doi 10.1214/aoms/1177706645).
    fn normal(&mut self) -> f64 {
        let (u, v) = (1.0 - self.unit(), self.unit());
        (-2.0 * u.ln()).sqrt() * (std::f64::consts::TAU * v).cos()
    }

    /// The box moved and scaled.
    fn moved(&mut self, bounds: &PixelBox) -> PixelBox {
        let mut side = |min: f64, max: f64| {
            let (middle, half) = (f64::midpoint(min, max), (max - min) / 2.0);
            let middle = middle + 2.0 * half * self.share();
            let half = half * (1.0 + self.share());
            (middle - half, middle + half)
        };
        let (x_min, x_max) = side(bounds.x_min, bounds.x_max);
        let (y_min, y_max) = side(bounds.y_min, bounds.y_max);
        PixelBox {
            x_min,
            y_min,
            x_max,
            y_max,
            ..bounds.clone()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pomona_cloud::{ColorImage, GrayImage};
    use pomona_labels::ImageStrokes;
    use pomona_scenes::Suite;

    fn frame() -> RealFrame {
        let frame = Suite::Lab15.cases().next().unwrap().scene().frame;
        RealFrame::new(frame, ImageStrokes::new("a", Vec::new()))
    }

    #[test]
    fn the_noise_that_is_added_is_found_again() {
        let mut frame = frame();
        // A plane at a slant, far from any rounding.
        let width = frame.frame.depth.width;
        for (k, reading) in frame.frame.depth.readings.iter_mut().enumerate() {
            *reading = (10_000 + 3 * (k % width)) as u16;
        }
        assert_eq!(depth_noise(&frame.frame.depth), Some(0.0));
        let noisy = perturbed(&frame, 0, 0, 12.0);
        let found = depth_noise(&noisy.frame.depth).unwrap();
        assert!((found - 12.0).abs() < 0.7, "{found}");
        assert_eq!(depth_noise(&DepthImage::empty(4, 4)), None);
    }

    #[test]
    fn copies_differ_repeat_and_stay_near() {
        let mut frame = frame();
        let size = (frame.frame.color.width, frame.frame.color.height);
        let mask = |value| GrayImage {
            width: size.0,
            height: size.1,
            values: vec![value; size.0 * size.1],
        };
        (frame.wood, frame.darker_wood) = (Some(mask(1)), Some(mask(2)));
        let copies: Vec<RealFrame> = (0..3).map(|i| perturbed(&frame, i, 7, 1.0)).collect();
        assert_eq!(copies[1], perturbed(&frame, 1, 7, 1.0));
        assert_ne!(copies[0].frame.boxes, copies[1].frame.boxes);
        assert_ne!(copies[0], perturbed(&frame, 0, 8, 1.0));
        // Without a mask of its own a copy keeps the frame's.
        let woods: Vec<u8> = copies
            .iter()
            .map(|c| c.wood.as_ref().unwrap().values[0])
            .collect();
        assert_eq!(woods, [1, 2, 1]);
        assert_eq!(copies[0].frame.color, frame.frame.color);
        let sum = |image: &ColorImage| {
            image
                .pixels
                .iter()
                .flatten()
                .map(|c| u64::from(*c))
                .sum::<u64>()
        };
        assert!(sum(&copies[1].frame.color) < sum(&frame.frame.color));
        assert!(sum(&copies[2].frame.color) > sum(&frame.frame.color));
        for copy in &copies {
            for (a, b) in frame.boxes().iter().zip(copy.boxes()) {
                // The middle by 5 % of the side, the edge by half as much again through the scale.
                assert!((a.x_min - b.x_min).abs() <= 0.0751 * a.width());
            }
        }
    }
}
