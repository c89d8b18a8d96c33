use crate::random::{Normal, Purpose, lattice, stream};
use crate::ray::Ray;
use crate::raycast::{NOTHING, Raycast};
use crate::sensor::Sensor;
use crate::time_of_flight::sense_by_flight;
use crate::world::{Shape, World};
use pomona_cloud::{Camera, DepthImage};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

/// The depth image that `sensor` takes of what the rays met.
///
/// Every row draws from streams of its own, so that the bytes do not depend
/// on the number of threads.
pub(crate) fn sense(
    world: &World,
    camera: &Camera,
    cast: &Raycast,
    sensor: &Sensor,
    seed: u64,
) -> DepthImage {
    if let Some(flight) = &sensor.time_of_flight {
        return sense_by_flight(world, camera, cast, (sensor, flight), seed);
    }
    let (width, height) = (cast.width, cast.height);
    let sensing = Sensing {
        world,
        camera,
        cast,
        sensor,
        seed,
        rim: rim(cast, sensor),
        keys: Keys::new(seed),
    };
    let mut readings = vec![0u16; width * height];
    readings
        .par_chunks_mut(width)
        .enumerate()
        .for_each(|(y, row)| sensing.row(y, row));
    DepthImage {
        width,
        height,
        readings,
    }
}

/// Keys of the draws that are looked up by place instead of drawn in a row.
struct Keys {
    thin: u64,
    dropout: u64,
    holes: u64,
}

impl Keys {
    fn new(seed: u64) -> Self {
        let key = |purpose| stream(seed, purpose, 0).random();
        Self {
            thin: key(Purpose::Thin),
            dropout: key(Purpose::Dropout),
            holes: key(Purpose::Holes),
        }
    }
}

struct Sensing<'a> {
    world: &'a World,
    camera: &'a Camera,
    cast: &'a Raycast,
    sensor: &'a Sensor,
    seed: u64,
    /// Pixels within the rim of an edge; empty where the sensor loses none there.
    rim: Vec<bool>,
    keys: Keys,
}

impl Sensing<'_> {
    fn row(&self, y: usize, row: &mut [u16]) {
        let sensor = self.sensor;
        let index = y as u64;
        let mut edge_rng = stream(self.seed, Purpose::Edge, index);
        let mut lateral_rng = stream(self.seed, Purpose::Lateral, index);
        let mut lateral = Normal::default();
        let mut axial = AxialNoise::new(self.seed, y, row.len(), sensor.correlation_px);
        for (x, reading) in row.iter_mut().enumerate() {
            let (sx, sy) = if sensor.lateral_px > 0.0 {
                let mut shift = || lateral.draw(&mut lateral_rng) * sensor.lateral_px;
                self.clamped(x as f64 + shift(), y as f64 + shift())
            } else {
                (x, y)
            };
            let source = sy * self.cast.width + sx;
            if self.cast.part[source] == NOTHING {
                continue;
            }
            let z = f64::from(self.cast.depth[source]);
            let Some(z) = self.at_edge(sx, sy, z, &mut edge_rng) else {
                continue;
            };
            if self.is_lost(x, y, source) {
                continue;
            }
            let ray = Ray::of_pixel(self.camera, x as f64, y as f64);
            let (right, down) = (z * ray.direction.x, z * ray.direction.y);
            let bias = sensor.bias;
            let z = z + bias.constant_m + bias.tilt.0 * right + bias.tilt.1 * down;
            let z = z + axial.draw(x, || sensor.axial.sigma(z));
            *reading = self.quantised(z);
        }
    }

    fn clamped(&self, x: f64, y: f64) -> (usize, usize) {
        let clamp = |a: f64, size: usize| a.round().clamp(0.0, size as f64 - 1.0) as usize;
        (clamp(x, self.cast.width), clamp(y, self.cast.height))
    }

    /// The depth after what edges do to it; `None` where they leave no reading.
    fn at_edge(&self, x: usize, y: usize, z: f64, rng: &mut ChaCha8Rng) -> Option<f64> {
        let edges = &self.sensor.edges;
        if self.rim.get(y * self.cast.width + x) == Some(&true)
            && rng.random::<f64>() < edges.invalid_share
        {
            return None;
        }
        if edges.mixed_share == 0.0 {
            return Some(z);
        }
        let other = farthest_neighbour(self.cast, x, y);
        let jump = other - z;
        if jump.abs() > edges.jump_m && rng.random::<f64>() < edges.mixed_share {
            return Some(z + jump * rng.random::<f64>());
        }
        Some(z)
    }

    /// Whether thin wood, chance or sunlight takes the reading.
    fn is_lost(&self, x: usize, y: usize, source: usize) -> bool {
        let part = &self.world.parts[self.cast.part[source] as usize];
        let (thin, dropout) = (self.sensor.thin, self.sensor.dropout);
        if let Shape::Limb(limb, _) = &part.shape
            && limb.thickness() < thin.thickness_m
            && patch(self.keys.thin, x, y, 4) >= thin.fill
        {
            return true;
        }
        if dropout.share > 0.0 && patch(self.keys.dropout, x, y, dropout.patch_px) < dropout.share {
            return true;
        }
        self.sensor.sunlight.cell_share > 0.0 && self.in_hole(x, y) && {
            let ray = Ray::of_pixel(self.camera, x as f64, y as f64);
            let point = ray.at(f64::from(self.cast.depth[source]));
            let normal = part.surface(&point).normal;
            let normal = if normal.dot(&ray.direction) > 0.0 {
                -normal
            } else {
                normal
            };
            normal.dot(&self.world.light.toward_sun) >= self.sensor.sunlight.least_cosine
        }
    }

    /// Whether (x, y) lies in a hole of its lattice cell or of one beside it.
    fn in_hole(&self, x: usize, y: usize) -> bool {
        let (column, row) = ((x / HOLE_CELL_PX) as i64, (y / HOLE_CELL_PX) as i64);
        let near = |c: i64| (c - 1)..=(c + 1);
        near(row)
            .flat_map(|j| near(column).map(move |i| (i, j)))
            .any(|(i, j)| {
                let draw = |k: i64| lattice(self.keys.holes, i, j, k);
                if draw(0) >= self.sensor.sunlight.cell_share {
                    return false;
                }
                let cell = HOLE_CELL_PX as f64;
                let (cx, cy) = ((i as f64 + draw(1)) * cell, (j as f64 + draw(2)) * cell);
                let radius = 3.0 + 7.0 * draw(3);
                (x as f64 - cx).powi(2) + (y as f64 - cy).powi(2) < radius * radius
            })
    }

    fn quantised(&self, z: f64) -> u16 {
        let (near, far) = self.sensor.range_m;
        if !(near..=far).contains(&z) {
            return 0;
        }
        // Rounded by adding a half: depths are positive, and this is the faster way.
        let steps = (z / self.sensor.step_m + 0.5) as u64 as f64;
        let units = (steps * (self.sensor.step_m / self.sensor.depth_scale) + 0.5) as u64;
        u16::try_from(units).unwrap_or(0)
    }
}

/// Side of the lattice cells that may hold a hole.
const HOLE_CELL_PX: usize = 24;

/// The number in 0..1 that all pixels of one square patch share.
fn patch(key: u64, x: usize, y: usize, side: usize) -> f64 {
    let side = side.max(1);
    lattice(key, (x / side) as i64, (y / side) as i64, 0)
}

/// The four neighbours of a pixel; at the image's border the pixel stands in for the missing ones.
fn neighbours(cast: &Raycast, x: usize, y: usize) -> [usize; 4] {
    let (w, h) = (cast.width, cast.height);
    let pixel = y * w + x;
    [
        pixel - usize::from(x > 0),
        pixel + usize::from(x + 1 < w),
        if y > 0 { pixel - w } else { pixel },
        if y + 1 < h { pixel + w } else { pixel },
    ]
}

/// Depth of the neighbour whose depth differs most from the pixel's own; its own
/// where none has a depth.
fn farthest_neighbour(cast: &Raycast, x: usize, y: usize) -> f64 {
    let own = cast.depth[y * cast.width + x];
    let mut farthest = own;
    for pixel in neighbours(cast, x, y) {
        let depth = cast.depth[pixel];
        if cast.part[pixel] != NOTHING && (depth - own).abs() > (farthest - own).abs() {
            farthest = depth;
        }
    }
    f64::from(farthest)
}

/// Pixels within the rim of a depth edge or of the end of all surfaces.
fn rim(cast: &Raycast, sensor: &Sensor) -> Vec<bool> {
    let edges = &sensor.edges;
    if edges.invalid_share == 0.0 {
        return Vec::new();
    }
    let (w, h) = (cast.width, cast.height);
    let is_edge = |x: usize, y: usize| {
        let own = y * w + x;
        cast.part[own] != NOTHING
            && neighbours(cast, x, y).into_iter().any(|p| {
                cast.part[p] == NOTHING
                    || f64::from((cast.depth[p] - cast.depth[own]).abs()) > edges.jump_m
            })
    };
    let mut edge = vec![false; w * h];
    edge.par_chunks_mut(w).enumerate().for_each(|(y, row)| {
        for (x, e) in row.iter_mut().enumerate() {
            *e = is_edge(x, y);
        }
    });
    // The pixels of an edge are the first pixel of its rim.
    let reach = edges.rim_px.saturating_sub(1);
    let mut rim = vec![false; w * h];
    rim.par_chunks_mut(w).enumerate().for_each(|(y, row)| {
        for near in y.saturating_sub(reach)..=(y + reach).min(h - 1) {
            for x in (0..w).filter(|x| edge[near * w + x]) {
                row[x.saturating_sub(reach)..=(x + reach).min(w - 1)].fill(true);
            }
        }
    });
    rim
}

/// Normal draws along one row: independent, or interpolated on a lattice of `correlation` pixels.
struct AxialNoise {
    rng: ChaCha8Rng,
    normal: Normal,
    shared: Option<Shared>,
}

/// Lattice draws above and below a row.
struct Shared {
    above: Vec<f64>,
    below: Vec<f64>,
    /// Way from the one to the other.
    way: f64,
    spacing: usize,
}

impl AxialNoise {
    fn new(seed: u64, y: usize, width: usize, spacing: usize) -> Self {
        let shared = (spacing > 1).then(|| {
            let line = |j: usize| {
                let mut rng = stream(seed, Purpose::Lattice, j as u64);
                let mut normal = Normal::default();
                (0..width / spacing + 2)
                    .map(|_| normal.draw(&mut rng))
                    .collect::<Vec<_>>()
            };
            let way = (y % spacing) as f64 / spacing as f64;
            Shared {
                above: line(y / spacing),
                below: line(y / spacing + 1),
                way,
                spacing,
            }
        });
        Self {
            rng: stream(seed, Purpose::Axial, y as u64),
            normal: Normal::default(),
            shared,
        }
    }

    /// The error of the pixel in column `x`, scaled by `sigma`.
    fn draw(&mut self, x: usize, sigma: impl Fn() -> f64) -> f64 {
        let sigma = sigma();
        if sigma == 0.0 {
            return 0.0;
        }
        let Some(shared) = &self.shared else {
            return sigma * self.normal.draw(&mut self.rng);
        };
        let i = x / shared.spacing;
        let across = (x % shared.spacing) as f64 / shared.spacing as f64;
        let weights = [
            (1.0 - across) * (1.0 - shared.way),
            across * (1.0 - shared.way),
            (1.0 - across) * shared.way,
            across * shared.way,
        ];
        let draws = [
            shared.above[i],
            shared.above[i + 1],
            shared.below[i],
            shared.below[i + 1],
        ];
        let sum: f64 = weights.iter().zip(draws).map(|(w, d)| w * d).sum();
        // Interpolation shrinks the variance by the weights' squares; undo it.
        sigma * sum / weights.iter().map(|w| w * w).sum::<f64>().sqrt()
    }
}
