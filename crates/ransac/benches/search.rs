//! Time of whole searches for a line in the plane and a plane in space, and how far off they are.
//!
//! `cargo bench -p pomona-ransac --features rayon`; without the feature, the threads are left out.
//! A line `accuracy NAME TEXT` on standard output goes with each benchmark.

use criterion::{Criterion, criterion_group, criterion_main};
use pomona_ransac::{
    Candidates, Confidence, Estimator, Exhaustive, FixedCount, LeastSquares, LocalOptimization,
    Msac, NoRefit, Preemption, Ransac, Report, Shuffle, Statistical, Stopping, Unconstrained,
    Uniform, Workspace,
};
use rand::RngExt;
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use std::hint::black_box;
use std::ops::Range;

const NOISE: f64 = 0.01;
const THRESHOLD: f64 = 0.025;

/// Points in `D` dimensions, one list for each coordinate; the model is height over the others: a line
/// for two, a plane for three.
struct Points<const D: usize> {
    coordinates: [Vec<f64>; D],
}

/// height = Σ slope · coordinate + constant, the constant last.
type Height<const D: usize> = [f64; D];

impl<const D: usize> Points<D> {
    const TRUTH: Height<D> = [0.3; D];

    /// Half of `count` points on [`TRUTH`](Self::TRUTH), half anywhere, in random order.
    fn half_outliers(count: usize) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(5);
        let mut coordinates = [(); D].map(|()| Vec::with_capacity(count));
        for i in 0..count {
            let mut height = Self::TRUTH[D - 1];
            for (list, slope) in coordinates.iter_mut().zip(Self::TRUTH).take(D - 1) {
                let c = rng.random_range(-1.0..1.0);
                height += slope * c;
                list.push(c);
            }
            coordinates[D - 1].push(if i % 2 == 0 {
                height + rng.random_range(-NOISE..NOISE)
            } else {
                rng.random_range(-1.0..1.0)
            });
        }
        let order = Shuffle::new(count, &mut rng);
        Self {
            coordinates: coordinates.map(|c| order.apply(&c)),
        }
    }

    /// The equations of least squares of the points chosen.
    fn solve(&self, chosen: &[usize]) -> Option<Height<D>> {
        let mut a = [[0.0; D]; D];
        let mut b = [0.0; D];
        for &i in chosen {
            let mut row: [f64; D] = std::array::from_fn(|axis| self.coordinates[axis][i]);
            let height = std::mem::replace(&mut row[D - 1], 1.0);
            for (j, &r) in row.iter().enumerate() {
                b[j] += r * height;
                for (sum, &c) in a[j].iter_mut().zip(&row) {
                    *sum += r * c;
                }
            }
        }
        // The matrix is symmetric and, unless the sample is degenerate, positive definite: no pivots.
        for k in 0..D {
            if !(a[k][k] > 1e-9) {
                return None;
            }
            for i in k + 1..D {
                let factor = a[i][k] / a[k][k];
                let above = a[k];
                for (entry, above) in a[i].iter_mut().zip(above) {
                    *entry -= factor * above;
                }
                b[i] -= factor * b[k];
            }
        }
        for k in (0..D).rev() {
            let known: f64 = (k + 1..D).map(|j| a[k][j] * b[j]).sum();
            b[k] = (b[k] - known) / a[k][k];
        }
        Some(b)
    }
}

impl<const D: usize> Estimator for Points<D> {
    type Model = Height<D>;
    const SAMPLE_SIZE: usize = D;

    fn len(&self) -> usize {
        self.coordinates[0].len()
    }

    fn fit(&self, sample: &[usize], candidates: &mut Candidates<Height<D>>) {
        self.solve(sample).map(|model| candidates.push(model));
    }

    fn refit(&self, inliers: &[usize], _: &Height<D>) -> Option<Height<D>> {
        self.solve(inliers)
    }

    fn residuals(&self, model: &Height<D>, block: Range<usize>, out: &mut [f64]) {
        let scale = 1.0 / (1.0 + model[..D - 1].iter().map(|s| s * s).sum::<f64>()).sqrt();
        let coordinates = self.coordinates.each_ref().map(|c| &c[block.clone()]);
        for (k, r) in out.iter_mut().enumerate() {
            let mut off = model[D - 1] - coordinates[D - 1][k];
            for axis in 0..D - 1 {
                off += model[axis] * coordinates[axis][k];
            }
            *r = (off * scale).abs();
        }
    }
}

/// Times a search, each time with another seed, in memory that is used again; prints how far
/// off it is for one of them.
fn search<const D: usize, L, T, B>(
    c: &mut Criterion,
    name: &str,
    points: &Points<D>,
    parts: &Ransac<Msac<f64>, Uniform, Unconstrained, L, T, B>,
) where
    L: LocalOptimization<Points<D>>,
    T: Stopping,
    B: Preemption,
{
    let mut workspace = Workspace::new();
    let mut seed = 0;
    c.bench_function(name, |b| {
        b.iter(|| {
            seed += 1;
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            let report = parts.run_with(&mut workspace, points, &mut rng);
            black_box(report.map(|report| report.score))
        });
    });
    let outcome = parts.run(points, &mut ChaCha8Rng::seed_from_u64(0));
    println!(
        "accuracy {name} {}",
        outcome.map_or_else(|e| e.to_string(), |r| off(&r))
    );
}

fn off<const D: usize>(report: &Report<Height<D>>) -> String {
    let differences = report.model.iter().zip(Points::<D>::TRUTH);
    let worst = differences.fold(0.0, |worst: f64, (a, b)| worst.max((a - b).abs()));
    format!(
        "off by {worst:.5}, {} inliers, {} samples",
        report.inliers.len(),
        report.counts.draws
    )
}

/// Ten thousand points, refitted: what most users have.
fn whole<const D: usize>(c: &mut Criterion, kind: &str) {
    let points = Points::<D>::half_outliers(10_000);
    let parts = Ransac::new(Msac::within(THRESHOLD)).local_optimization(LeastSquares::default());
    let fixed = parts.stopping(FixedCount::new(1000));
    let confident = parts.stopping(Confidence::new(0.99, 10_000));
    let statistical = Statistical::with_error(0.01);
    search(c, &format!("{kind}/fixed-1000"), &points, &fixed);
    let name = format!("{kind}/fixed-1000/statistical");
    search(c, &name, &points, &fixed.preemption(statistical));
    let name = format!("{kind}/confidence-0.99");
    search(c, &name, &points, &confident);
    let name = format!("{kind}/confidence-0.99/statistical");
    search(c, &name, &points, &confident.preemption(statistical));
}

type Unrefitted = Ransac<Msac<f64>, Uniform, Unconstrained, NoRefit, FixedCount, Exhaustive>;

/// 256 hypotheses scored on all of a million points, so that 2.56e8 residuals are computed.
fn million() -> (Points<3>, Unrefitted) {
    let parts = Ransac::new(Msac::within(THRESHOLD))
        .stopping(FixedCount::new(256))
        .preemption(Exhaustive);
    (Points::half_outliers(1_000_000), parts)
}

/// A round of one reads the points once for each model, a longer one once for all of its models.
fn tiling(c: &mut Criterion) {
    let (points, parts) = million();
    for round in [1, 8, 32] {
        let name = format!("plane/million/round-{round}");
        search(c, &name, &points, &parts.round(round));
    }
}

#[cfg(feature = "rayon")]
fn threads(c: &mut Criterion) {
    let (points, parts) = million();
    for threads in [1, 2] {
        let name = format!("plane/million/threads-{threads}");
        search(c, &name, &points, &parts.threads(threads));
    }
}

#[cfg(not(feature = "rayon"))]
fn threads(_: &mut Criterion) {}

fn wholes(c: &mut Criterion) {
    whole::<2>(c, "line");
    whole::<3>(c, "plane");
}

criterion_group! {
    name = usual;
    config = Criterion::default().sample_size(20);
    targets = wholes
}
criterion_group! {
    name = large;
    config = Criterion::default().sample_size(10);
    targets = tiling, threads
}
criterion_main!(usual, large);
