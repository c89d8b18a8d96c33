//! Circles in the plane: the estimator that `docs/own-estimator.md` builds step by step, and all
//! that it adds afterwards.
//!
//! `cargo run --release -p pomona-ransac --example circle_2d`

use pomona_ransac::{
    Candidates, Confidence, Constraint, Estimator, LeastSquares, Linearization, Msac, Ransac,
};
use rand::RngExt;
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use std::error::Error;
use std::ops::Range;

struct Points(Vec<[f64; 2]>);

#[derive(Clone, Debug)]
struct Circle {
    center: [f64; 2],
    radius: f64,
}

impl Points {
    /// The circle nearest to the points chosen; `None` where they (nearly) lie on a line.
    fn circle(&self, chosen: &[usize]) -> Option<Circle> {
        let n = chosen.len() as f64;
        let mean = [0, 1].map(|k| chosen.iter().map(|&i| self.0[i][k]).sum::<f64>() / n);
        let (mut uu, mut uv, mut vv, mut us, mut vs) = (0.0, 0.0, 0.0, 0.0, 0.0);
        for &i in chosen {
            let (u, v) = (self.0[i][0] - mean[0], self.0[i][1] - mean[1]);
            let s = u * u + v * v;
            (uu, uv, vv) = (uu + u * u, uv + u * v, vv + v * v);
            (us, vs) = (us + u * s, vs + v * s);
        }
        let determinant = uu * vv - uv * uv;
        if !(determinant > 1e-9 * (uu + vv).powi(2)) {
            return None;
        }
        let a = (us * vv - vs * uv) / (2.0 * determinant);
        let b = (vs * uu - us * uv) / (2.0 * determinant);
        Some(Circle {
            center: [mean[0] + a, mean[1] + b],
            radius: (a * a + b * b + (uu + vv) / n).sqrt(),
        })
    }

    fn distance(&self, point: usize, center: [f64; 2]) -> f64 {
        let [x, y] = self.0[point];
        (x - center[0]).hypot(y - center[1])
    }
}

impl Estimator for Points {
    type Model = Circle;
    const SAMPLE_SIZE: usize = 3;

    fn len(&self) -> usize {
        self.0.len()
    }

    fn fit(&self, sample: &[usize], candidates: &mut Candidates<Circle>) {
        self.circle(sample).map(|circle| candidates.push(circle));
    }

    fn refit(&self, inliers: &[usize], _current: &Circle) -> Option<Circle> {
        self.circle(inliers)
    }

    fn residuals(&self, circle: &Circle, block: Range<usize>, out: &mut [f64]) {
        for (r, i) in out.iter_mut().zip(block) {
            *r = (self.distance(i, circle.center) - circle.radius).abs();
        }
    }
}

/// The same estimator with the work that the engine repeats most often done faster.
struct Fast(Points);

/// The squares between which a point's squared distance lies where it is an inlier.
fn ring(circle: &Circle, threshold: f64) -> std::ops::RangeInclusive<f64> {
    let inner = (circle.radius - threshold).max(0.0);
    inner.powi(2)..=(circle.radius + threshold).powi(2)
}

impl Fast {
    fn squared(&self, point: usize, circle: &Circle) -> f64 {
        let ([x, y], [a, b]) = (self.0.0[point], circle.center);
        (x - a) * (x - a) + (y - b) * (y - b)
    }
}

impl Estimator for Fast {
    type Model = Circle;
    const SAMPLE_SIZE: usize = 3;

    fn len(&self) -> usize {
        self.0.len()
    }

    fn fit(&self, sample: &[usize], candidates: &mut Candidates<Circle>) {
        self.0.fit(sample, candidates);
    }

    fn refit(&self, inliers: &[usize], current: &Circle) -> Option<Circle> {
        self.0.refit(inliers, current)
    }

    fn residuals(&self, circle: &Circle, block: Range<usize>, out: &mut [f64]) {
        self.0.residuals(circle, block, out);
    }

    fn count_within(&self, circle: &Circle, block: Range<usize>, threshold: f64) -> usize {
        let ring = ring(circle, threshold);
        block
            .filter(|&i| ring.contains(&self.squared(i, circle)))
            .count()
    }

    fn select_within(
        &self,
        circle: &Circle,
        block: Range<usize>,
        threshold: f64,
        out: &mut Vec<usize>,
    ) {
        let ring = ring(circle, threshold);
        out.extend(block.filter(|&i| ring.contains(&self.squared(i, circle))));
    }

    fn truncated_gain(&self, circle: &Circle, block: Range<usize>, threshold: f64) -> f64 {
        if threshold == 0.0 {
            return self.count_within(circle, block, threshold) as f64;
        }
        let ring = ring(circle, threshold);
        let inliers = block
            .map(|i| self.squared(i, circle))
            .filter(|squared| ring.contains(squared));
        let gain = |squared: f64| 1.0 - ((squared.sqrt() - circle.radius) / threshold).powi(2);
        // The ring's edge rounds in its own way: no gain may be negative for it.
        inliers.map(|squared| gain(squared).max(0.0)).sum()
    }

    const PARAMETERS: usize = 3;

    fn linearize(&self, circle: &Circle, datum: usize, rows: &mut Linearization) {
        let [x, y] = self.0.0[datum];
        let (dx, dy) = (x - circle.center[0], y - circle.center[1]);
        let distance = dx.hypot(dy);
        // By the centre's x and y, and by the radius.
        let slopes = [-dx / distance, -dy / distance, -1.0];
        rows.push(distance - circle.radius, &slopes);
    }
}

/// Refuses circles that are smaller or larger than what is looked for.
struct RadiusBetween(f64, f64);

impl Constraint<Points> for RadiusBetween {
    fn name(&self) -> &'static str {
        "radius"
    }

    /// Two points further apart than the largest diameter are on no such circle.
    fn allows_sample(&self, points: &Points, sample: &[usize]) -> bool {
        let far = |i: usize, j: usize| points.distance(i, points.0[j]) > 2.0 * self.1;
        !(far(sample[0], sample[1]) || far(sample[1], sample[2]) || far(sample[2], sample[0]))
    }

    fn allows_model(&self, _: &Points, circle: &Circle) -> bool {
        (self.0..=self.1).contains(&circle.radius)
    }
}

/// Circles of a radius that is known: two points leave two of them, one on each side.
struct OfRadius {
    points: Points,
    radius: f64,
}

impl Estimator for OfRadius {
    type Model = Circle;
    const SAMPLE_SIZE: usize = 2;
    const MAX_MODELS: usize = 2;

    fn len(&self) -> usize {
        self.points.len()
    }

    fn fit(&self, sample: &[usize], candidates: &mut Candidates<Circle>) {
        let ([ax, ay], [bx, by]) = (self.points.0[sample[0]], self.points.0[sample[1]]);
        let half = self.points.distance(sample[0], [bx, by]) / 2.0;
        let height = (self.radius.powi(2) - half.powi(2)).sqrt();
        // The root of a negative number, points too far apart, is NaN; so is 0/0, points in one place.
        let turn = height / (2.0 * half);
        for side in [turn, -turn].into_iter().filter(|side| side.is_finite()) {
            candidates.push(Circle {
                center: [
                    f64::midpoint(ax, bx) - side * (by - ay),
                    f64::midpoint(ay, by) + side * (bx - ax),
                ],
                radius: self.radius,
            });
        }
    }

    /// Each point, moved by the radius towards the current centre, is a guess at the centre;
    /// their mean is a better one, and so on.
    fn refit(&self, inliers: &[usize], current: &Circle) -> Option<Circle> {
        let mut center = current.center;
        for _ in 0..10 {
            let guess = |i: usize| {
                let [x, y] = self.points.0[i];
                let step = self.radius / self.points.distance(i, center);
                [x + step * (center[0] - x), y + step * (center[1] - y)]
            };
            let sum = inliers.iter().map(|&i| guess(i));
            let [x, y] = sum.fold([0.0; 2], |[x, y], [a, b]| [x + a, y + b]);
            center = [x / inliers.len() as f64, y / inliers.len() as f64];
        }
        let finite = center.iter().all(|c| c.is_finite());
        finite.then_some(Circle { center, ..*current })
    }

    fn residuals(&self, circle: &Circle, block: Range<usize>, out: &mut [f64]) {
        self.points.residuals(circle, block, out);
    }
}

/// 200 points within 0.02 of the circle about (3, −1) of radius 2, 100 on a larger circle, and 200 anywhere.
fn scattered() -> Points {
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let mut points = Vec::new();
    for i in 0..500 {
        let angle: f64 = rng.random_range(0.0..std::f64::consts::TAU);
        let off = rng.random_range(-0.02..0.02);
        let (s, c) = angle.sin_cos();
        points.push(match i {
            0..200 => [3.0 + (2.0 + off) * c, -1.0 + (2.0 + off) * s],
            200..300 => [(5.0 + off) * c, (5.0 + off) * s],
            _ => [rng.random_range(-6.0..6.0), rng.random_range(-6.0..6.0)],
        });
    }
    Points(points)
}

fn show(what: &str, circle: &Circle, inliers: usize) {
    let Circle {
        center: [x, y],
        radius,
    } = circle;
    println!("{what:22} centre ({x:.3}, {y:.3}), radius {radius:.3}, {inliers} inliers");
}

fn off(circle: &Circle) -> f64 {
    (circle.center[0] - 3.0)
        .hypot(circle.center[1] + 1.0)
        .max((circle.radius - 2.0).abs())
}

fn main() -> Result<(), Box<dyn Error>> {
    let points = scattered();
    let search = Ransac::new(Msac::within(0.04))
        .local_optimization(LeastSquares::default())
        .stopping(Confidence::new(0.999, 10_000));
    let report = search.run(&points, &mut ChaCha8Rng::seed_from_u64(7))?;
    show("three points each:", &report.model, report.inliers.len());
    assert!(off(&report.model) < 0.005);

    let wide = search.constraint(RadiusBetween(4.0, 6.0));
    let large = wide.run(&points, &mut ChaCha8Rng::seed_from_u64(7))?;
    show("radius 4 to 6:", &large.model, large.inliers.len());
    assert!((large.model.radius - 5.0).abs() < 0.01);

    let fast = Fast(points);
    let again = search.run(&fast, &mut ChaCha8Rng::seed_from_u64(7))?;
    show("faster, and how sure:", &again.model, again.inliers.len());
    assert_eq!(again.inliers, report.inliers);
    if let (Some(sigma), Some(covariance)) = (again.sigma, &again.covariance) {
        let [x, y, radius] =
            [0, 1, 2].map(|k| covariance.standard_deviation(k).unwrap_or(f64::NAN));
        println!("  noise {sigma:.4}; one sigma of x {x:.4}, y {y:.4}, radius {radius:.4}");
        assert!(off(&again.model) < 4.0 * x.max(y).max(radius));
    }

    let known = OfRadius {
        points: fast.0,
        radius: 2.0,
    };
    let report = search.run(&known, &mut ChaCha8Rng::seed_from_u64(7))?;
    show("two points each:", &report.model, report.inliers.len());
    assert!(off(&report.model) < 0.005 && report.counts.hypotheses > report.counts.accepted);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_circles_are_found() {
        main().unwrap();
    }

    #[test]
    fn a_degenerate_sample_gives_no_model() {
        let mut candidates = Candidates::new(2);
        Points(vec![[0.0, 0.0], [1.0, 2.0], [2.0, 4.0]]).fit(&[0, 1, 2], &mut candidates);
        Points(vec![[f64::NAN, 0.0], [1.0, 2.0], [2.0, 5.0]]).fit(&[0, 1, 2], &mut candidates);
        let points = Points(vec![[0.0, 0.0], [0.0, 0.0], [9.0, 0.0]]);
        let known = OfRadius {
            points,
            radius: 2.0,
        };
        known.fit(&[0, 1], &mut candidates);
        known.fit(&[0, 2], &mut candidates);
        assert!(candidates.is_empty());
    }

    #[test]
    fn a_sample_gives_the_models_through_it() {
        let points = Points(vec![[5.0, -1.0], [3.0, 1.0], [1.0, -1.0]]);
        let mut candidates = Candidates::new(2);
        points.fit(&[0, 1, 2], &mut candidates);
        assert!(off(&candidates.as_ref()[0]) < 1e-12);

        let mut candidates = Candidates::new(2);
        let known = OfRadius {
            points,
            radius: 2.0,
        };
        known.fit(&[0, 1], &mut candidates);
        assert_eq!(candidates.len(), 2);
        assert!(candidates.as_ref().iter().any(|circle| off(circle) < 1e-12));
    }

    #[test]
    fn the_fast_kernels_say_what_the_residuals_say() {
        let slow = scattered();
        let fast = Fast(scattered());
        let mut rng = ChaCha8Rng::seed_from_u64(3);
        for _ in 0..100 {
            let circle = Circle {
                center: [rng.random_range(-6.0..6.0), rng.random_range(-6.0..6.0)],
                radius: rng.random_range(0.0..6.0),
            };
            let threshold = rng.random_range(0.0..1.0);
            let count = fast.count_within(&circle, 0..500, threshold);
            assert_eq!(count, slow.count_within(&circle, 0..500, threshold));
            let gain = slow.truncated_gain(&circle, 0..500, threshold);
            assert!((fast.truncated_gain(&circle, 0..500, threshold) - gain).abs() < 1e-9);
            let (mut ours, mut theirs) = (Vec::new(), Vec::new());
            fast.select_within(&circle, 0..500, threshold, &mut ours);
            slow.select_within(&circle, 0..500, threshold, &mut theirs);
            assert_eq!(ours, theirs);
        }
    }
}
