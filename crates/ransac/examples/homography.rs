//! A homography between two pictures, out of matches of which half are wrong: a model, a minimal
//! solver and a refit that the engine knows nothing of.
//!
//! `cargo run --release -p pomona-ransac --example homography`

use pomona_ransac::{
    Candidates, Confidence, Estimator, LeastSquares, Msac, Ransac, Shuffle, Statistical,
};
use rand::RngExt;
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use std::error::Error;
use std::ops::Range;

type Point = [f64; 2];
type Matrix = [[f64; 3]; 3];

/// Where a point goes; not finite where it goes to the horizon.
fn apply(h: &Matrix, [x, y]: Point) -> Point {
    let [u, v, w] = [0, 1, 2].map(|row| h[row][0] * x + h[row][1] * y + h[row][2]);
    [u / w, v / w]
}

fn multiply(a: &Matrix, b: &Matrix) -> Matrix {
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum()))
}

/// The inverse up to scale, which is all that counts here: the transposed cofactors.
fn adjugate(m: &Matrix) -> Matrix {
    let minor = |i: usize, j: usize| {
        let [a, b, c, d] = [(i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3];
        m[a][c] * m[b][d] - m[a][d] * m[b][c]
    };
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| minor(j, i)))
}

fn determinant(m: &Matrix) -> f64 {
    let cofactors = adjugate(m);
    (0..3).map(|k| m[0][k] * cofactors[k][0]).sum()
}

/// Both directions, so that scoring need not invert.
#[derive(Clone, Debug)]
struct Homography {
    second_from_first: Matrix,
    first_from_second: Matrix,
}

impl Homography {
    /// `None` where the matrix is not finite or (nearly) flattens the plane.
    fn new(matrix: Matrix) -> Option<Self> {
        let norm = matrix.iter().flatten().map(|a| a * a).sum::<f64>().sqrt();
        let matrix = matrix.map(|row| row.map(|a| a / norm));
        let regular = determinant(&matrix).abs() > 1e-12;
        regular.then(|| Self {
            second_from_first: matrix,
            first_from_second: adjugate(&matrix),
        })
    }
}

/// Solves eight equations in eight unknowns: Gauss' elimination with pivots from the column.
fn solve(mut a: [[f64; 9]; 8]) -> Option<[f64; 8]> {
    for k in 0..8 {
        let pivot = (k..8).max_by(|&i, &j| a[i][k].abs().total_cmp(&a[j][k].abs()))?;
        a.swap(k, pivot);
        let row = a[k];
        if !(row[k].abs() > 1e-12) {
            return None;
        }
        for below in &mut a[k + 1..] {
            let factor = below[k] / row[k];
            for (entry, above) in below.iter_mut().zip(row) {
                *entry -= factor * above;
            }
        }
    }
    let mut x = [0.0; 8];
    for k in (0..8).rev() {
        let known: f64 = (k + 1..8).map(|j| a[k][j] * x[j]).sum();
        x[k] = (a[k][8] - known) / a[k][k];
    }
    Some(x)
}

/// Moves points to their centroid and scales them to a mean distance of √2, without which the
/// equations are badly scaled (Hartley 1997, doi 10.1109/34.601246).
fn normalizer(points: impl Iterator<Item = Point> + Clone) -> Matrix {
    let n = points.clone().count() as f64;
    let mean = |axis: usize| points.clone().map(|p| p[axis]).sum::<f64>() / n;
    let (mx, my) = (mean(0), mean(1));
    let distances = points.map(|[x, y]| (x - mx).hypot(y - my));
    let s = 2.0_f64.sqrt() * n / distances.sum::<f64>();
    [[s, 0.0, -s * mx], [0.0, s, -s * my], [0.0, 0.0, 1.0]]
}

/// Pairs of points that some matcher took for the same place.
struct Matches {
    first: Vec<Point>,
    second: Vec<Point>,
}

impl Matches {
    /// The direct linear transform. Each match gives two linear equations for the matrix, whose last entry is
    /// set to 1 (in centred coordinates it is far from 0); more than four are solved by their normal equations.
    fn linear(&self, chosen: &[usize]) -> Option<Homography> {
        let to_first = normalizer(chosen.iter().map(|&i| self.first[i]));
        let to_second = normalizer(chosen.iter().map(|&i| self.second[i]));
        let mut equations = [[0.0; 9]; 8];
        for (k, &i) in chosen.iter().enumerate() {
            let [x, y] = apply(&to_first, self.first[i]);
            let [u, v] = apply(&to_second, self.second[i]);
            let two = [
                [x, y, 1.0, 0.0, 0.0, 0.0, -u * x, -u * y, u],
                [0.0, 0.0, 0.0, x, y, 1.0, -v * x, -v * y, v],
            ];
            if chosen.len() == 4 {
                equations[2 * k..2 * k + 2].copy_from_slice(&two);
                continue;
            }
            for row in two {
                for (sums, a) in equations.iter_mut().zip(row) {
                    for (sum, b) in sums.iter_mut().zip(row) {
                        *sum += a * b;
                    }
                }
            }
        }
        let h = solve(equations)?;
        let matrix = [[h[0], h[1], h[2]], [h[3], h[4], h[5]], [h[6], h[7], 1.0]];
        let to_pixels = multiply(&adjugate(&to_second), &matrix);
        Homography::new(multiply(&to_pixels, &to_first))
    }

    /// Does any triple of the four lie on one line, in either picture? Or is its sense of
    /// rotation another there, as no camera shows it?
    fn is_degenerate(&self, sample: &[usize]) -> bool {
        [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]]
            .iter()
            .any(|triple| {
                let area = |points: &[Point]| {
                    let [a, b, c] = triple.map(|k| points[sample[k]]);
                    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
                };
                let (first, second) = (area(&self.first), area(&self.second));
                first.abs() < 1.0 || second.abs() < 1.0 || first * second < 0.0
            })
    }
}

impl Estimator for Matches {
    type Model = Homography;
    const SAMPLE_SIZE: usize = 4;

    fn len(&self) -> usize {
        self.first.len()
    }

    fn fit(&self, sample: &[usize], candidates: &mut Candidates<Homography>) {
        if !self.is_degenerate(sample) {
            self.linear(sample).map(|model| candidates.push(model));
        }
    }

    fn refit(&self, inliers: &[usize], _: &Homography) -> Option<Homography> {
        self.linear(inliers)
    }

    /// The symmetric transfer error: how far off a match is in the two pictures together, in pixels.
    fn residuals(&self, model: &Homography, block: Range<usize>, out: &mut [f64]) {
        for (r, i) in out.iter_mut().zip(block) {
            let [u, v] = apply(&model.second_from_first, self.first[i]);
            let [x, y] = apply(&model.first_from_second, self.second[i]);
            let forward = (u - self.second[i][0]).hypot(v - self.second[i][1]);
            let backward = (x - self.first[i][0]).hypot(y - self.first[i][1]);
            *r = forward.hypot(backward);
        }
    }
}

const WIDTH: f64 = 640.0;
const HEIGHT: f64 = 480.0;

/// What the second camera makes of a flat scene.
const TRUTH: Matrix = [
    [0.92, -0.11, 41.0],
    [0.14, 0.97, -26.0],
    [2.1e-4, -1.3e-4, 1.0],
];

/// 300 matches that are right to about a pixel, and 300 that are wrong.
fn matches(rng: &mut ChaCha8Rng) -> Matches {
    let mut matches = Matches {
        first: Vec::new(),
        second: Vec::new(),
    };
    for i in 0..600 {
        let mut anywhere = || [rng.random_range(0.0..WIDTH), rng.random_range(0.0..HEIGHT)];
        let (first, elsewhere) = (anywhere(), anywhere());
        let [u, v] = apply(&TRUTH, first);
        let mut noise = || rng.random_range(-1.0..1.0);
        let second = [u + noise(), v + noise()];
        matches.first.push(first);
        matches
            .second
            .push(if i < 300 { second } else { elsewhere });
    }
    matches
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut rng = ChaCha8Rng::seed_from_u64(4);
    let given = matches(&mut rng);
    let order = Shuffle::new(given.len(), &mut rng);
    let shuffled = Matches {
        first: order.apply(&given.first),
        second: order.apply(&given.second),
    };

    let mut report = Ransac::new(Msac::within(4.0))
        .local_optimization(LeastSquares::default())
        .preemption(Statistical::with_error(0.01))
        .stopping(Confidence::new(0.999, 100_000))
        .min_inliers(20)
        .run(&shuffled, &mut rng)?;
    order.restore(&mut report.inliers);

    let [.., [.., scale]] = report.model.second_from_first;
    println!("homography, second picture from first:");
    for row in report.model.second_from_first {
        let [a, b, c] = row.map(|entry| entry / scale);
        println!("  {a:12.6} {b:12.6} {c:12.4}");
    }
    println!("matches kept   {} of {}", report.inliers.len(), given.len());
    println!("transfer error {:.2} px rms", report.residuals.rms);
    println!(
        "search         {} samples, {} of them degenerate, ended because {:?}",
        report.counts.draws, report.counts.degenerate, report.stopped
    );

    // How far off it is where the pictures end, which the error of the matches does not tell.
    let corners = [[0.0, 0.0], [WIDTH, 0.0], [0.0, HEIGHT], [WIDTH, HEIGHT]];
    let off = corners.map(|corner| {
        let [u, v] = apply(&report.model.second_from_first, corner);
        let [x, y] = apply(&TRUTH, corner);
        (u - x).hypot(v - y)
    });
    let worst = off.into_iter().fold(0.0, f64::max);
    println!("worst corner   {worst:.2} px from the truth");

    assert!(worst < 1.0);
    let right = report.inliers.iter().filter(|&&i| i < 300).count();
    assert!(right == 300 && report.inliers.len() - right <= 3);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_homography_is_found() {
        main().unwrap();
    }

    #[test]
    fn four_exact_matches_give_the_homography_back() {
        let first = vec![[10.0, 20.0], [600.0, 40.0], [30.0, 400.0], [580.0, 450.0]];
        let second = first.iter().map(|&p| apply(&TRUTH, p)).collect();
        let matches = Matches { first, second };
        let model = matches.linear(&[0, 1, 2, 3]).unwrap();
        for probe in [[320.0, 240.0], [0.0, 0.0]] {
            let ([u, v], [x, y]) = (apply(&model.second_from_first, probe), apply(&TRUTH, probe));
            assert!((u - x).hypot(v - y) < 1e-9);
            let [x, y] = apply(&model.first_from_second, apply(&TRUTH, probe));
            assert!((x - probe[0]).hypot(y - probe[1]) < 1e-9);
        }
    }

    #[test]
    fn three_points_on_a_line_are_degenerate() {
        let first = vec![[0.0, 0.0], [50.0, 50.0], [100.0, 100.0], [0.0, 100.0]];
        let second = first.clone();
        let mut candidates = Candidates::new(1);
        Matches { first, second }.fit(&[0, 1, 2, 3], &mut candidates);
        assert!(candidates.is_empty());
    }
}
