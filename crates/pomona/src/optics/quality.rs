//! What a depth image tells about its own errors: noise, errors that neighbours share, smeared edges.

use super::law::{self, GENERIC};
use pomona_cloud::DepthImage;

/// Errors of a depth image, estimated from the image itself.
///
/// Readings a few pixels apart on one surface differ from a straight line by their noise. Where a camera measures every
/// pixel by itself, that difference hardly grows with the distance between the pixels; where depth was measured on a
/// coarser grid and brought to that of the colour image, as time-of-flight cameras do, it grows severalfold, and
/// between two things lies a ramp of readings of neither. Such depth is wrong by millimetres over a whole fruit, and
/// bends away at rims.
///
/// Of nothing (a blank image, or one without two readings side by side) nothing is assumed: the estimates are `None`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct DepthQuality {
    /// Share of the pixels that have a reading.
    pub readings_share: f64,
    /// Standard deviation of a reading beside its neighbours, as a factor of 0.5 mm + 1.4 mm/m² z².
    pub noise: Option<f64>,
    /// Standard deviation of the error that neighbouring readings share, metres.
    pub shared_error_m: Option<f64>,
    /// Of the places where depth changes by more than 3 cm within two pixels, the share at which the reading between
    /// lies between.
    pub smeared_share: Option<f64>,
}

/// Rows that are looked at, at most: enough for a few per cent of every estimate.
const MOST_ROWS: usize = 96;

/// Distances between the readings that are compared, pixels: neighbours, and across what a coarser grid shares.
const NEAR_PX: usize = 1;
const MIDDLE_PX: usize = 2;
const FAR_PX: usize = 4;

/// Difference of two readings that may be on one surface, metres.
const SAME_SURFACE_M: f64 = 0.02;

/// Difference within two pixels that is an edge, metres.
const EDGE_M: f64 = 0.03;

/// Part of an edge's height in which a reading belongs to neither side.
const BETWEEN: (f64, f64) = (0.15, 0.85);

/// Fewest places that an estimate is taken from.
const LEAST_PLACES: usize = 100;

/// Share of the smallest differences that noise is read from; the others may be edges and bends.
const QUIET_SHARE: f64 = 0.7;

/// Mean of the magnitude of a standard normal variable below its quantile of [`QUIET_SHARE`]:
/// 2 (φ(0) − φ(1.0364)) / 0.7.
const QUIET_MEAN: f64 = 0.4736;

/// Shares of smeared edges up to which edges are taken to be sharp, and from which depth is taken to be smeared.
/// Rendered scenes of all sensors have up to 0.37, the two time-of-flight frames 0.84.
const SHARP: f64 = 0.45;
const SMEARED: f64 = 0.75;

impl DepthQuality {
    /// That of `depth`, whose readings are multiples of `depth_scale` metres. At most 96 rows are looked
    /// at.
    pub fn of(depth: &DepthImage, depth_scale: f64) -> Self {
        let read = depth.readings.iter().filter(|r| **r != 0).count();
        let readings_share = read as f64 / depth.readings.len().max(1) as f64;
        let near = noise_across(depth, depth_scale, NEAR_PX);
        let middle = noise_across(depth, depth_scale, MIDDLE_PX);
        let far = noise_across(depth, depth_scale, FAR_PX);
        let shared =
            |(_, near): (f64, f64), (_, far): (f64, f64)| (far * far - near * near).max(0.0).sqrt();
        Self {
            readings_share,
            noise: near.zip(middle).map(|(a, b)| a.0.max(b.0)),
            shared_error_m: near.zip(far).map(|(a, b)| shared(a, b)),
            smeared_share: smeared_share(depth, depth_scale),
        }
    }

    /// How far the rim of things and their curvature are not to be believed, from 0 (sharp) to 1 (smeared).
    pub fn smear(&self) -> f64 {
        let share = self.smeared_share.unwrap_or(0.0);
        ((share - SHARP) / (SMEARED - SHARP)).clamp(0.0, 1.0)
    }
}

/// The rows that are looked at.
fn rows(depth: &DepthImage) -> impl Iterator<Item = &[u16]> {
    let step = depth.height.div_ceil(MOST_ROWS).max(1);
    depth.readings.chunks(depth.width.max(1)).step_by(step)
}

/// Standard deviation of a reading from the straight line through those `distance` pixels to its left and right: as a
/// factor of the generic law, and in metres.
fn noise_across(depth: &DepthImage, scale: f64, distance: usize) -> Option<(f64, f64)> {
    let same = (SAME_SURFACE_M / scale) as i32;
    let mut factors: Vec<f32> = Vec::new();
    let mut metres: Vec<f32> = Vec::new();
    for row in rows(depth) {
        for window in row.windows(2 * distance + 1) {
            let [a, b, c] = [window[0], window[distance], window[2 * distance]].map(i32::from);
            if a == 0 || b == 0 || c == 0 || (a - b).abs() > same || (c - b).abs() > same {
                continue;
            }
            // The variance of a − 2b + c is six times that of a reading.
            let off = f64::from((a + c - 2 * b).abs()) * scale / 6f64.sqrt();
            metres.push(off as f32);
            factors.push((off / law::sigma(GENERIC, f64::from(b) * scale)) as f32);
        }
    }
    Some((quiet_sd(&mut factors)?, quiet_sd(&mut metres)?))
}

/// Standard deviation from the smaller ones of some magnitudes.
fn quiet_sd(magnitudes: &mut [f32]) -> Option<f64> {
    if magnitudes.len() < LEAST_PLACES {
        return None;
    }
    let count = (QUIET_SHARE * magnitudes.len() as f64) as usize;
    let (quiet, ..) = magnitudes.select_nth_unstable_by(count, f32::total_cmp);
    // Summed as numbers of their own type in one order: the order of selection is that of the data.
    let sum: f64 = quiet.iter().map(|x| f64::from(*x)).sum();
    Some(sum / count as f64 / QUIET_MEAN)
}

fn smeared_share(depth: &DepthImage, scale: f64) -> Option<f64> {
    let edge = (EDGE_M / scale) as i32;
    let (mut edges, mut between) = (0usize, 0usize);
    for row in rows(depth) {
        for window in row.windows(3) {
            let [a, b, c] = [window[0], window[1], window[2]].map(i32::from);
            if a == 0 || b == 0 || c == 0 || (c - a).abs() <= edge {
                continue;
            }
            edges += 1;
            let part = f64::from(b - a) / f64::from(c - a);
            between += usize::from(part > BETWEEN.0 && part < BETWEEN.1);
        }
    }
    (edges >= LEAST_PLACES).then(|| between as f64 / edges as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::CheckedFrame;
    use pomona_scenes::Suite;
    use rand_chacha::ChaCha8Rng;
    use rand_core::{Rng, SeedableRng};

    fn normal(rng: &mut ChaCha8Rng) -> f64 {
        let mut uniform = || (f64::from(rng.next_u32()) + 0.5) / 2f64.powi(32);
        (0..12).map(|_| uniform()).sum::<f64>() - 6.0
    }

    /// Two planes, 1 and 1.2 m away in stripes, each reading with noise of `sigma` units shared by `grid` pixels.
    fn stripes(sigma: f64, grid: usize) -> DepthImage {
        let (width, height) = (400, 200);
        let mut rng = ChaCha8Rng::seed_from_u64(5);
        let coarse: Vec<f64> = (0..(width / grid + 2) * height)
            .map(|k| {
                let column = k % (width / grid + 2);
                let stripe = if (column / (40 / grid)).is_multiple_of(2) {
                    10000.0
                } else {
                    12000.0
                };
                stripe + sigma * normal(&mut rng)
            })
            .collect();
        let mut depth = DepthImage {
            width,
            height,
            readings: vec![0; width * height],
        };
        for v in 0..height {
            for u in 0..width {
                let (cell, part) = (u / grid, (u % grid) as f64 / grid as f64);
                let at = |k: usize| coarse[v * (width / grid + 2) + k];
                depth.readings[v * width + u] =
                    (at(cell) * (1.0 - part) + at(cell + 1) * part).round() as u16;
            }
        }
        depth
    }

    #[test]
    fn independent_noise_and_sharp_edges_are_told() {
        let quality = DepthQuality::of(&stripes(20.0, 1), 1e-4);
        // 2 mm; the law has 1.9 mm at 1 m and 2.5 mm at 1.2 m.
        assert!((quality.noise.unwrap() - 0.93).abs() < 0.1, "{quality:?}");
        assert!(quality.shared_error_m.unwrap() < 0.0005, "{quality:?}");
        assert!(
            quality.smear() == 0.0 && quality.readings_share == 1.0,
            "{quality:?}"
        );
    }

    #[test]
    fn depth_of_a_coarser_grid_is_smeared_and_shares_errors() {
        let quality = DepthQuality::of(&stripes(20.0, 4), 1e-4);
        assert!(quality.smear() > 0.5, "{quality:?}");
        assert!(quality.shared_error_m.unwrap() > 0.001, "{quality:?}");
    }

    #[test]
    fn of_a_blank_image_nothing_is_assumed() {
        let depth = DepthImage {
            width: 9,
            height: 4,
            readings: vec![0; 36],
        };
        let quality = DepthQuality::of(&depth, 1e-3);
        assert_eq!((quality.noise, quality.smeared_share), (None, None));
        assert_eq!((quality.smear(), quality.readings_share), (0.0, 0.0));
    }

    #[test]
    fn no_rendered_sensor_is_taken_for_a_smearing_one() {
        for suite in [
            "orchard",
            "harsh-kinect",
            "harsh-azure-kinect",
            "harsh-d400",
            "lab15",
        ] {
            for case in Suite::named(suite).unwrap().cases_to(2) {
                let frame = case.scene().frame;
                let quality = *CheckedFrame::new(&frame).unwrap().depth_quality();
                assert_eq!(quality.smear(), 0.0, "{suite}: {quality:?}");
            }
        }
    }
}
