//! Seeded random numbers: independent streams, normal draws, a lattice hash.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::f64::consts::TAU;

/// What a stream is drawn for; streams of different purposes are independent.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Purpose {
    /// Positions and sizes of objects.
    Layout = 1,
    /// Depth noise along the ray, by row.
    Axial,
    /// Depth noise that neighbouring pixels share, by lattice row.
    Lattice,
    /// Mixed pixels and rims at depth edges, by row.
    Edge,
    /// Displacement of a reading across the ray, by row.
    Lateral,
    /// The key of the readings lost at random.
    Dropout,
    /// The key of the readings lost on thin wood.
    Thin,
    /// The key of the holes that sunlight leaves.
    Holes,
    /// What changes between two frames of a repeated scene.
    Sway,
    /// The signs of a camera's systematic errors.
    Systematic,
    /// Positions and sizes of objects where branches rival the target's own.
    Rivals,
    /// Positions and sizes of objects in a dense tree.
    Dense,
    /// The key of smooth errors of a time-of-flight camera.
    Warp,
    /// How the boxes of a person differ from what shows.
    Boxes,
    /// The key of far rows, and the noise of the colour image.
    Scenery,
}

/// The stream of `purpose` number `index` under `seed`.
///
/// One `ChaCha8` key per seed, one of its streams per purpose and index: rows of
/// an image can be drawn in any order, by any number of threads.
pub(crate) fn stream(seed: u64, purpose: Purpose, index: u64) -> ChaCha8Rng {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    rng.set_stream((purpose as u64) << 48 | (index & 0xffff_ffff_ffff));
    rng
}

/// Standard normal draws by Box and Muller's method (1958, doi 10.1214/aoms/1177706645).
#[derive(Clone, Debug, Default)]
pub(crate) struct Normal {
    spare: Option<f64>,
}

impl Normal {
    /// The next draw; every second one is the other half of a pair.
    pub(crate) fn draw(&mut self, rng: &mut ChaCha8Rng) -> f64 {
        if let Some(spare) = self.spare.take() {
            return spare;
        }
        // 1 − u lies in (0, 1], where the logarithm is finite.
        let u: f64 = 1.0 - rng.random::<f64>();
        let length = (-2.0 * u.ln()).sqrt();
        let (sine, cosine) = (TAU * rng.random::<f64>()).sin_cos();
        self.spare = Some(length * sine);
        length * cosine
    }
}

/// A number in `0..1` that depends on `key` and a lattice point alone (splitmix64's finaliser).
pub(crate) fn lattice(key: u64, x: i64, y: i64, z: i64) -> f64 {
    let mut h = key
        .wrapping_add((x as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15))
        .wrapping_add((y as u64).wrapping_mul(0xc2b2_ae3d_27d4_eb4f))
        .wrapping_add((z as u64).wrapping_mul(0x1656_67b1_9e37_79f9));
    h = (h ^ (h >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    h = (h ^ (h >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    h ^= h >> 31;
    (h >> 11) as f64 / (1u64 << 53) as f64
}

/// Smooth noise in `0..1` with features about one unit in size: lattice values, cubic blend.
pub(crate) fn value_noise(key: u64, x: f64, y: f64, z: f64) -> f64 {
    let cell = [x, y, z].map(f64::floor);
    let [i, j, k] = cell.map(|c| c as i64);
    let blend = |t: f64| t * t * (3.0 - 2.0 * t);
    let (a, b, c) = (blend(x - cell[0]), blend(y - cell[1]), blend(z - cell[2]));
    let mix = |p: f64, q: f64, t: f64| p + (q - p) * t;
    let edge = |dy: i64, dz: i64| {
        mix(
            lattice(key, i, j + dy, k + dz),
            lattice(key, i + 1, j + dy, k + dz),
            a,
        )
    };
    mix(
        mix(edge(0, 0), edge(1, 0), b),
        mix(edge(0, 1), edge(1, 1), b),
        c,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normal_has_mean_zero_and_variance_one() {
        let mut rng = stream(3, Purpose::Axial, 0);
        let mut normal = Normal::default();
        let n = 40_000;
        let draws: Vec<f64> = (0..n).map(|_| normal.draw(&mut rng)).collect();
        let mean = draws.iter().sum::<f64>() / f64::from(n);
        let variance = draws.iter().map(|d| d * d).sum::<f64>() / f64::from(n);
        // Four standard errors: 4/√n = 0.02 for the mean, 4·√(2/n) = 0.028 for the variance.
        assert!(mean.abs() < 0.02, "mean {mean}");
        assert!((variance - 1.0).abs() < 0.028, "variance {variance}");
    }

    #[test]
    fn streams_differ_by_seed_purpose_and_index() {
        let first = |seed, purpose, index| stream(seed, purpose, index).random::<u64>();
        let base = first(1, Purpose::Axial, 7);
        assert_eq!(base, first(1, Purpose::Axial, 7));
        assert_ne!(base, first(2, Purpose::Axial, 7));
        assert_ne!(base, first(1, Purpose::Edge, 7));
        assert_ne!(base, first(1, Purpose::Axial, 8));
    }

    #[test]
    fn value_noise_meets_the_lattice() {
        assert_eq!(value_noise(9, 4.0, -2.0, 1.0), lattice(9, 4, -2, 1));
    }
}
