//! Straight lines of the image through crossings with wood, found by the RANSAC engine.

use super::crossings::Crossings;
use super::view::REACH_RADII;
use pomona_ransac::{
    Candidates, Constraint, Estimator, FixedCount, LeastSquares, Local, PerDatum, Quadratic,
    Ransac, RansacError, Report, Sequential,
};
use rand_chacha::ChaCha8Rng;
use std::ops::Range;

/// A line of the image with a width. Pixels.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ImageLine {
    /// A point of its middle line.
    pub(crate) point: (f64, f64),
    /// Unit vector along it.
    pub(crate) along: (f64, f64),
    /// Half of its width.
    pub(crate) half_width: f64,
}

impl ImageLine {
    /// The line through `point` along a vector of any length; `None` where that is too short to tell, or not finite.
    pub(crate) fn new(point: (f64, f64), along: (f64, f64), half_width: f64) -> Option<Self> {
        let length = along.0.hypot(along.1);
        let finite = length.is_finite() && point.0.is_finite() && point.1.is_finite();
        (finite && length > 1e-6 && half_width > 0.0).then(|| Self {
            point,
            along: (along.0 / length, along.1 / length),
            half_width,
        })
    }

    /// Length along it of the point nearest to `p`, from its own point on.
    pub(crate) fn along_to(&self, p: (f64, f64)) -> f64 {
        (p.0 - self.point.0) * self.along.0 + (p.1 - self.point.1) * self.along.1
    }

    /// Signed distance of `p`.
    pub(crate) fn aside(&self, p: (f64, f64)) -> f64 {
        (p.1 - self.point.1) * self.along.0 - (p.0 - self.point.0) * self.along.1
    }

    /// The place `s` along it, and `aside` of it.
    pub(crate) fn at(&self, s: f64, aside: f64) -> (f64, f64) {
        (
            self.point.0 + s * self.along.0 - aside * self.along.1,
            self.point.1 + s * self.along.1 + aside * self.along.0,
        )
    }
}

/// Lines drawn through two crossings for each line that is found.
const DRAWS: u64 = 150;

/// Lines that are found at most.
const MOST_LINES: usize = 16;

/// Fewest crossings that make a line.
const LEAST_CROSSINGS: usize = 5;

/// Distance of two crossings in a sample: pixels at least, and radii of the apple at most.
const LEAST_BASE_PX: f64 = 4.0;
const MOST_BASE_RADII: f64 = 1.0;

/// Sine of the least angle between a line and the row or column of pixels that crosses it.
const LEAST_SINE: f64 = 0.5;

/// Distance of a crossing's middle from a line that it supports: pixels, …
const OFF_PX: f64 = 1.0;

/// … and as a share of its width.
const OFF_SHARE: f64 = 0.15;

/// Largest ratio of the widths of a line and of a crossing that supports it, beside a pixel.
const WIDTH_RATIO: f64 = 1.8;

/// Length to either side of its foot on which a line is supported, radii of the apple: branches bend.
const SUPPORT_RADII: f64 = 1.8;

/// Lines through crossings that pass the apple within its reach, one after the other among the crossings that are left.
pub(crate) fn image_lines(
    crossings: &Crossings,
    center: (f64, f64),
    radius: f64,
    rng: &mut ChaCha8Rng,
) -> Vec<ImageLine> {
    let extraction = Sequential::default()
        .max_structures(MOST_LINES)
        .min_inliers(LEAST_CROSSINGS)
        .run(crossings.len(), |left| {
            best_line(&crossings.select(left), center, radius, rng)
        });
    let structures = extraction.structures.into_iter();
    structures.map(|report| report.model).collect()
}

/// The line of the most probability.
fn best_line(
    crossings: &Crossings,
    center: (f64, f64),
    radius: f64,
    rng: &mut ChaCha8Rng,
) -> Result<Report<ImageLine>, RansacError> {
    let estimator = LineOfCrossings {
        crossings,
        center,
        support: SUPPORT_RADII * radius,
    };
    let thresholds = crossings.width.iter().map(|w| OFF_PX + OFF_SHARE * w);
    let weights = crossings.probability.iter().map(|p| p.clamp(0.0, 1.0));
    let scorer = PerDatum::new(Quadratic, thresholds.collect())
        .and_then(|scorer| scorer.weights(weights.collect()));
    // Widths and probabilities are what the scorer takes.
    let scorer = scorer.map_err(|_| RansacError::NothingDrawn)?;
    let most = MOST_BASE_RADII * radius;
    let near = |datum: usize, out: &mut Vec<usize>| {
        let (u, v) = (crossings.u[datum], crossings.v[datum]);
        let within = |k: &usize| {
            let base = (crossings.u[*k] - u).hypot(crossings.v[*k] - v);
            (LEAST_BASE_PX..=most).contains(&base)
        };
        out.extend((0..crossings.len()).filter(within));
    };
    Ransac::new(scorer)
        .sampler(Local::new(near))
        .constraint(WithinReach(REACH_RADII * radius))
        .local_optimization(LeastSquares::default())
        .stopping(FixedCount::new(DRAWS).max_draws(4 * DRAWS))
        .run(&estimator, rng)
}

/// Passes the apple within this distance, pixels.
struct WithinReach(f64);

impl Constraint<LineOfCrossings<'_>> for WithinReach {
    fn name(&self) -> &'static str {
        "distance from the apple"
    }

    fn allows_model(&self, estimator: &LineOfCrossings<'_>, line: &ImageLine) -> bool {
        line.aside(estimator.center).abs() <= self.0
    }
}

/// A line with a width through the middles of crossings.
struct LineOfCrossings<'a> {
    crossings: &'a Crossings,
    /// The apple's centre.
    center: (f64, f64),
    /// Length to either side of the foot on which crossings count, pixels.
    support: f64,
}

impl LineOfCrossings<'_> {
    fn place(&self, datum: usize) -> (f64, f64) {
        (self.crossings.u[datum], self.crossings.v[datum])
    }

    /// Half width across a line of this direction; `None` where the row or column runs along it.
    fn half_width(&self, datum: usize, along: (f64, f64)) -> Option<f64> {
        let sine = if self.crossings.of_row[datum] {
            along.1.abs()
        } else {
            along.0.abs()
        };
        (sine >= LEAST_SINE).then(|| 0.5 * self.crossings.width[datum] * sine)
    }
}

fn alike(a: f64, b: f64) -> bool {
    let (least, most) = (a.min(b), a.max(b));
    most <= WIDTH_RATIO * least + 0.5
}

impl Estimator for LineOfCrossings<'_> {
    type Model = ImageLine;
    const SAMPLE_SIZE: usize = 2;

    fn len(&self) -> usize {
        self.crossings.len()
    }

    fn fit(&self, sample: &[usize], candidates: &mut Candidates<ImageLine>) {
        let [i, j] = [sample[0], sample[1]];
        let (a, b) = (self.place(i), self.place(j));
        let Some(line) = ImageLine::new(a, (b.0 - a.0, b.1 - a.1), 1.0) else {
            return;
        };
        let widths = (
            self.half_width(i, line.along),
            self.half_width(j, line.along),
        );
        if let (Some(a), Some(b)) = widths
            && alike(a, b)
        {
            candidates.push(ImageLine {
                half_width: 0.5 * (a + b),
                ..line
            });
        }
    }

    /// Total least squares, each crossing with its probability as weight.
    fn refit(&self, inliers: &[usize], current: &ImageLine) -> Option<ImageLine> {
        let weight = |i: usize| self.crossings.probability[i];
        let (mut sum, mut x, mut y, mut width) = (0.0, 0.0, 0.0, 0.0);
        for &i in inliers {
            let (w, p) = (weight(i), self.place(i));
            sum += w;
            x += w * p.0;
            y += w * p.1;
            width += w * self.half_width(i, current.along)?;
        }
        if !(sum > 0.0) {
            return None;
        }
        let mean = (x / sum, y / sum);
        let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
        for &i in inliers {
            let (w, p) = (weight(i), self.place(i));
            let (dx, dy) = (p.0 - mean.0, p.1 - mean.1);
            xx += w * dx * dx;
            xy += w * dx * dy;
            yy += w * dy * dy;
        }
        // The direction of largest scatter.
        let angle = 0.5 * (2.0 * xy).atan2(xx - yy);
        ImageLine::new(mean, (angle.cos(), angle.sin()), width / sum)
    }

    fn residuals(&self, line: &ImageLine, block: Range<usize>, out: &mut [f64]) {
        let foot = line.along_to(self.center);
        for (residual, i) in out.iter_mut().zip(block) {
            let p = self.place(i);
            let near = (line.along_to(p) - foot).abs() <= self.support;
            let as_wide = self
                .half_width(i, line.along)
                .is_some_and(|half| alike(half, line.half_width));
            *residual = if near && as_wide {
                line.aside(p).abs()
            } else {
                f64::NAN
            };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pomona_cloud::{GrayImage, PixelWindow};
    use rand_chacha::rand_core::SeedableRng;

    /// A mask with bands: point, angle, half width.
    pub(crate) fn mask(bands: &[((f64, f64), f64, f64)]) -> GrayImage {
        let (width, height) = (160, 140);
        let mut values = vec![0; width * height];
        for &(point, angle, half_width) in bands {
            let line = ImageLine::new(point, (angle.cos(), angle.sin()), half_width).unwrap();
            for v in 0..height {
                for u in 0..width {
                    if line.aside((u as f64, v as f64)).abs() <= half_width {
                        values[v * width + u] = 220;
                    }
                }
            }
        }
        GrayImage {
            width,
            height,
            values,
        }
    }

    #[test]
    fn every_band_is_a_candidate_at_its_place_and_width() {
        let bands = [
            ((60.0, 40.0), 0.1, 3.0),
            ((30.0, 80.0), 1.5, 2.0),
            ((130.0, 70.0), 0.8, 4.0),
        ];
        let mask = mask(&bands);
        let crossings = Crossings::of(&mask, PixelWindow::full(160, 140), 20.0);
        let mut rng = ChaCha8Rng::seed_from_u64(3);
        let lines = image_lines(&crossings, (80.0, 70.0), 25.0, &mut rng);
        for (point, angle, half_width) in bands {
            let found = lines.iter().any(|line| {
                let turn = line.along.0 * angle.sin() - line.along.1 * angle.cos();
                line.aside(point).abs() < 1.0
                    && turn.abs() < 0.05
                    && (line.half_width - half_width).abs() < 1.0
            });
            assert!(found, "{point:?} {angle}: {lines:?}");
        }
    }

    #[test]
    fn without_wood_there_is_no_line() {
        let crossings = Crossings::of(&mask(&[]), PixelWindow::full(160, 140), 20.0);
        let mut rng = ChaCha8Rng::seed_from_u64(3);
        assert!(image_lines(&crossings, (80.0, 70.0), 25.0, &mut rng).is_empty());
    }
}
