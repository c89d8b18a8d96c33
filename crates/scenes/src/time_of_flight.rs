//! What a time-of-flight camera reads outdoors: each of its own pixels mixes all surfaces that it sees.

use crate::random::{Normal, Purpose, stream, value_noise};
use crate::ray::Ray;
use crate::raycast::{NOTHING, Raycast};
use crate::sensor::{Sensor, TimeOfFlight};
use crate::world::{Bark, Shape, World};
use pomona_cloud::{Camera, DepthImage};
use rand::RngExt;
use rayon::prelude::*;

/// Standard deviations of the blur after which nothing is added.
const BLUR_REACH: f64 = 2.2;

/// Share of the active infrared that leaves, wood, stems and apples send back. Leaves and fruit are bright in the near
/// infrared and bark is darker; the values are ours.
const LEAF_ALBEDO: f64 = 0.55;
const WOOD_ALBEDO: f64 = 0.38;
const FRUIT_ALBEDO: f64 = 0.60;
const WALL_ALBEDO: f64 = 0.50;

/// Depths beside each other that differ by more are not joined when they are drawn into the colour image, metres.
const LARGEST_STEP_M: f64 = 0.12;

/// The depth image that a time-of-flight camera takes of what the rays met, registered to the colour image.
pub(crate) fn sense_by_flight(
    world: &World,
    camera: &Camera,
    cast: &Raycast,
    (sensor, flight): (&Sensor, &TimeOfFlight),
    seed: u64,
) -> DepthImage {
    let (width, height) = (cast.width, cast.height);
    let returns = returns(world, camera, cast, flight, seed);
    let grid = Grid::of(&returns, (width, height), (sensor, flight), seed);
    let mut readings = vec![0u16; width * height];
    readings
        .par_chunks_mut(width)
        .enumerate()
        .for_each(|(y, row)| {
            for (x, reading) in row.iter_mut().enumerate() {
                if let Some(z) = grid.at(x, y) {
                    *reading = quantised(z, sensor);
                }
            }
        });
    DepthImage {
        width,
        height,
        readings,
    }
}

fn quantised(z: f64, sensor: &Sensor) -> u16 {
    let (near, far) = sensor.range_m;
    if !(near..=far).contains(&z) {
        return 0;
    }
    let steps = (z / sensor.step_m).round();
    u16::try_from((steps * (sensor.step_m / sensor.depth_scale)).round() as u64).unwrap_or(0)
}

/// What comes back from the surface of each pixel: its amplitude and its apparent depth.
fn returns(
    world: &World,
    camera: &Camera,
    cast: &Raycast,
    flight: &TimeOfFlight,
    seed: u64,
) -> Vec<(f32, f32)> {
    let key = stream(seed, Purpose::Warp, 0).random();
    let mut returns = vec![(0.0, 0.0); cast.depth.len()];
    returns
        .par_chunks_mut(cast.width)
        .enumerate()
        .for_each(|(y, row)| {
            for (x, back) in row.iter_mut().enumerate() {
                let pixel = y * cast.width + x;
                if cast.part[pixel] == NOTHING {
                    continue;
                }
                let part = &world.parts[cast.part[pixel] as usize];
                let z = f64::from(cast.depth[pixel]);
                let ray = Ray::of_pixel(camera, x as f64, y as f64);
                let normal = part.surface(&ray.at(z)).normal;
                let facing = normal.dot(&ray.direction).abs() / ray.direction.norm();
                let (albedo, front) = match &part.shape {
                    Shape::Apple(apple) => (FRUIT_ALBEDO, Some(apple.center.z - apple.radius)),
                    Shape::Limb(_, Bark::Wood) => (WOOD_ALBEDO, None),
                    Shape::Limb(_, Bark::Green) | Shape::Leaf(_) => (LEAF_ALBEDO, None),
                    Shape::Plane(_) => (WALL_ALBEDO, None),
                };
                let scale = flight.warp_px;
                let warp = value_noise(key, x as f64 / scale, y as f64 / scale, z * 4.0) - 0.5;
                let flat = front.map_or(0.0, |front| flight.flattening * (z - front));
                let apparent = z - flat + 2.0 * flight.warp_m * warp;
                *back = ((albedo * facing / (z * z)) as f32, apparent as f32);
            }
        });
    returns
}

/// The camera's own pixels: depth in metres, 0 where there is no reading.
struct Grid {
    columns: usize,
    rows: usize,
    /// Pixels of the image from one to the next.
    spacing: f64,
    depth: Vec<f32>,
}

impl Grid {
    fn of(
        returns: &[(f32, f32)],
        (width, height): (usize, usize),
        (sensor, flight): (&Sensor, &TimeOfFlight),
        seed: u64,
    ) -> Self {
        let spacing = flight.pixel_px;
        let columns = (width as f64 / spacing).ceil() as usize + 1;
        let rows = (height as f64 / spacing).ceil() as usize + 1;
        let hole_key: u64 = stream(seed, Purpose::Holes, 0).random();
        let reach = (BLUR_REACH * flight.blur_px).ceil() as i32;
        let kernel: Vec<f64> = (0..=reach)
            .map(|d| (-0.5 * (f64::from(d) / flight.blur_px).powi(2)).exp())
            .collect();
        let mut depth = vec![0.0f32; columns * rows];
        depth
            .par_chunks_mut(columns)
            .enumerate()
            .for_each(|(j, row)| {
                let mut rng = stream(seed, Purpose::Axial, j as u64);
                let mut normal = Normal::default();
                for (i, out) in row.iter_mut().enumerate() {
                    // Drawn for every pixel, with a reading or not, so that rows do not depend on what is seen.
                    let (noise, luck) = (normal.draw(&mut rng), normal.draw(&mut rng));
                    let (u, v) = (i as f64 * spacing, j as f64 * spacing);
                    let Some(mix) = mixed(returns, (width, height), (u, v), &kernel) else {
                        continue;
                    };
                    let hole = value_noise(
                        hole_key,
                        u / flight.hole_px,
                        v / flight.hole_px,
                        mix.depth * 8.0,
                    );
                    let lost = mix.amplitude
                        < flight.least_amplitude * (1.0 + 0.25 * luck).max(0.1)
                        || mix.sd > flight.mixed_sd_m * (1.0 + 0.25 * luck)
                        || hole < flight.hole_level;
                    if !lost {
                        let weak = (flight.least_amplitude / mix.amplitude).clamp(0.2, 1.0);
                        let sigma = sensor.axial.sigma(mix.depth) * (1.0 + 3.0 * weak);
                        *out = (mix.depth + sensor.bias.constant_m + sigma * noise) as f32;
                    }
                }
            });
        Self {
            columns,
            rows,
            spacing,
            depth,
        }
    }

    /// The depth at a pixel of the image: between four of the camera's own pixels, where all of them have one and
    /// belong together.
    fn at(&self, x: usize, y: usize) -> Option<f64> {
        let (u, v) = (x as f64 / self.spacing, y as f64 / self.spacing);
        let (i, j) = (u as usize, v as usize);
        let (right, down) = ((i + 1).min(self.columns - 1), (j + 1).min(self.rows - 1));
        let depths = [(i, j), (right, j), (i, down), (right, down)]
            .map(|(i, j)| f64::from(self.depth[j * self.columns + i]));
        let low = depths.iter().copied().fold(f64::INFINITY, f64::min);
        let high = depths.iter().copied().fold(0.0, f64::max);
        if low == 0.0 || high - low > LARGEST_STEP_M {
            return None;
        }
        let (a, b) = (u - i as f64, v - j as f64);
        let mix = |p: f64, q: f64, t: f64| p + (q - p) * t;
        Some(mix(
            mix(depths[0], depths[1], a),
            mix(depths[2], depths[3], a),
            b,
        ))
    }
}

/// What one of the camera's pixels receives.
struct Mix {
    amplitude: f64,
    depth: f64,
    /// Standard deviation of the depths in it.
    sd: f64,
}

fn mixed(
    returns: &[(f32, f32)],
    (width, height): (usize, usize),
    (u, v): (f64, f64),
    kernel: &[f64],
) -> Option<Mix> {
    let reach = kernel.len() as i64 - 1;
    let (x, y) = (u.round() as i64, v.round() as i64);
    let (mut all, mut sum, mut depth, mut square) = (0.0f64, 0.0, 0.0, 0.0);
    for dy in -reach..=reach {
        let row = (y + dy).clamp(0, height as i64 - 1) * width as i64;
        for dx in -reach..=reach {
            let weight = kernel[dy.unsigned_abs() as usize] * kernel[dx.unsigned_abs() as usize];
            let (amplitude, z) = returns[(row + (x + dx).clamp(0, width as i64 - 1)) as usize];
            let (part, z) = (weight * f64::from(amplitude), f64::from(z));
            all += weight;
            sum += part;
            depth += part * z;
            square += part * z * z;
        }
    }
    (sum > 0.0).then(|| {
        let mean = depth / sum;
        Mix {
            amplitude: sum / all,
            depth: mean,
            sd: (square / sum - mean * mean).max(0.0).sqrt(),
        }
    })
}
