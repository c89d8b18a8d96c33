//! What stands behind a tree in an orchard: next rows, ground and an overexposed sky, as colours without geometry.

use crate::random::{Normal, Purpose, lattice, stream, value_noise};
use crate::ray::Ray;
use nalgebra::Vector3;
use pomona_cloud::ColorImage;
use rand::RngExt;
use rayon::prelude::*;

type Rgb = Vector3<f64>;

/// A far backdrop by the direction of sight. The colours and sizes are ours, by eye from photographs of orchards.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Scenery {
    key: u64,
    /// Height at which the next rows end against the sky, radians above the horizon.
    treetops: f64,
    /// How many leaves the next rows have, 0 to 1.
    density: f64,
}

impl Scenery {
    pub(crate) fn new(seed: u64) -> Self {
        let mut rng = stream(seed, Purpose::Scenery, 0);
        Self {
            key: rng.random(),
            treetops: 0.12 + 0.25 * rng.random::<f64>(),
            density: 0.45 + 0.25 * rng.random::<f64>(),
        }
    }

    /// The colour in the direction of a ray, `up` being away from the ground.
    pub(crate) fn color(&self, ray: &Ray, up: &Vector3<f64>) -> Rgb {
        let direction = ray.direction.normalize();
        let height = direction.dot(up).asin();
        let turn = direction.x.atan2(direction.z);
        let ragged = 0.10 * (value_noise(self.key, turn * 30.0, 0.0, 1.0) - 0.5);
        let sky = Rgb::new(0.93, 0.95, 1.0);
        if height > self.treetops + ragged {
            return sky;
        }
        if height < -0.10 {
            return self.ground(turn, height);
        }
        self.row(turn, height, &sky)
    }

    /// Dry grass and earth, lighter in patches.
    fn ground(&self, turn: f64, height: f64) -> Rgb {
        let patch = value_noise(self.key ^ 1, turn * 60.0, height * 120.0, 0.0);
        let grain = value_noise(self.key ^ 2, turn * 500.0, height * 700.0, 0.0);
        let earth = Rgb::new(0.62, 0.48, 0.42).lerp(&Rgb::new(0.95, 0.86, 0.80), patch);
        let grass = Rgb::new(0.20, 0.23, 0.09);
        earth.lerp(&grass, 0.7 * (grain * 1.6 - 0.8).clamp(0.0, 1.0)) * (0.75 + 0.4 * grain)
    }

    /// Leaves with gaps, apples and stems of the next rows.
    fn row(&self, turn: f64, height: f64, sky: &Rgb) -> Rgb {
        // Stems of 3 cm at 4 m, 1 m apart.
        let stem = turn / 0.25 + 0.10 * value_noise(self.key ^ 3, height * 6.0, turn * 4.0, 0.0);
        let across = (stem - stem.round()) * 0.25;
        let crown = 1.0 - 0.5 * ((height + 0.1) / (self.treetops + 0.1)).clamp(0.0, 1.0);
        // Bent and turned, so that the lattice of the noise does not show.
        let bend = value_noise(self.key ^ 8, turn * 90.0, height * 90.0, 0.0) - 0.5;
        let (a, b) = (turn + 0.7 * height + 0.02 * bend, height - 0.7 * turn);
        let clump = value_noise(self.key ^ 4, a * 35.0, b * 35.0, 0.0);
        let blade = 0.6 * value_noise(self.key ^ 5, a * 110.0, b * 70.0, 0.0)
            + 0.4 * value_noise(self.key ^ 9, b * 260.0, a * 190.0, 0.0);
        let cover = 0.55 * clump + 0.45 * blade;
        let apple = lattice_dot(self.key ^ 6, turn / 0.028, height / 0.028);
        if apple > 0.0 && clump > 0.35 {
            return Rgb::new(0.50, 0.05, 0.08).lerp(&Rgb::new(0.75, 0.25, 0.30), apple);
        }
        if cover > 1.0 - self.density * (0.5 + crown) {
            let tone = 0.6 * value_noise(self.key ^ 7, b * 100.0, a * 60.0, 3.0)
                + 0.4 * value_noise(self.key ^ 0xa, a * 280.0, b * 210.0, 3.0);
            return Rgb::new(0.06, 0.09, 0.05).lerp(&Rgb::new(0.34, 0.42, 0.26), tone * tone);
        }
        if across.abs() < 0.004 {
            return Rgb::new(0.36, 0.31, 0.29) * (1.2 - 60.0 * across.abs());
        }
        if height > 0.02 {
            *sky * (0.85 + 0.15 * blade)
        } else {
            self.ground(turn, height)
        }
    }
}

/// Positive inside a round dot that some cells of a lattice hold, larger towards its upper left.
fn lattice_dot(key: u64, x: f64, y: f64) -> f64 {
    let (i, j) = (x.floor(), y.floor());
    let draw = |k: i64| lattice(key, i as i64, j as i64, k);
    if draw(0) > 0.22 {
        return 0.0;
    }
    let (dx, dy) = (x - i - 0.3 - 0.4 * draw(1), y - j - 0.3 - 0.4 * draw(2));
    let inside = 1.0 - (dx * dx + dy * dy) / 0.09;
    if inside <= 0.0 {
        return 0.0;
    }
    (0.3 + dy - dx).clamp(0.01, 1.0)
}

/// Standard deviation of the colour noise, grey values of 255.
const COLOR_NOISE: f64 = 3.0;

/// The image as a camera gives it: slightly blurred, since a lens and the pattern of colour filters do so, and noisy.
pub(crate) fn photographed(image: &ColorImage, seed: u64) -> ColorImage {
    let (w, h) = (image.width, image.height);
    let mut pixels = vec![[0u8; 3]; w * h];
    pixels.par_chunks_mut(w).enumerate().for_each(|(y, row)| {
        let mut rng = stream(seed, Purpose::Scenery, 16 + y as u64);
        let mut normal = Normal::default();
        for (x, pixel) in row.iter_mut().enumerate() {
            let noise = normal.draw(&mut rng) * COLOR_NOISE;
            let mut sum = [0.0; 3];
            for (dy, wy) in [(0, 1.0), (1, 2.0), (2, 1.0)] {
                for (dx, wx) in [(0, 1.0), (1, 2.0), (2, 1.0)] {
                    let (u, v) = ((x + dx).clamp(1, w) - 1, (y + dy).clamp(1, h) - 1);
                    for (sum, value) in sum.iter_mut().zip(image.pixels[v * w + u]) {
                        *sum += wx * wy * f64::from(value) / 16.0;
                    }
                }
            }
            *pixel = sum.map(|value| (value + noise).round().clamp(0.0, 255.0) as u8);
        }
    });
    ColorImage {
        width: w,
        height: h,
        pixels,
    }
}
