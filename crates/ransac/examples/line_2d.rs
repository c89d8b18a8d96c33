//! A line through points of the plane, half of which have nothing to do with it.
//!
//! `cargo run --release -p pomona-ransac --example line_2d`

use pomona_ransac::{
    Candidates, Confidence, Estimator, LeastSquares, Msac, Ransac, Report, Shuffle, Statistical,
};
use rand::RngExt;
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use std::error::Error;
use std::ops::Range;

/// Points of the plane.
struct Points {
    x: Vec<f64>,
    y: Vec<f64>,
}

/// The points (x, y) with x cos(angle) + y sin(angle) = offset: no direction is special, upright
/// lines included.
#[derive(Clone, Debug)]
struct Line {
    angle: f64,
    offset: f64,
}

impl Line {
    fn through(x: f64, y: f64, angle: f64) -> Self {
        let offset = x * angle.cos() + y * angle.sin();
        Self { angle, offset }
    }
}

impl Estimator for Points {
    type Model = Line;
    const SAMPLE_SIZE: usize = 2;

    fn len(&self) -> usize {
        self.x.len()
    }

    fn fit(&self, sample: &[usize], candidates: &mut Candidates<Line>) {
        let [i, j] = [sample[0], sample[1]];
        let (dx, dy) = (self.x[j] - self.x[i], self.y[j] - self.y[i]);
        // Two points in the same place have many lines through them: give none.
        if dx.hypot(dy) > 0.0 {
            candidates.push(Line::through(self.x[i], self.y[i], dx.atan2(-dy)));
        }
    }

    /// Total least squares: the line through the centroid along the direction of largest scatter.
    fn refit(&self, inliers: &[usize], _: &Line) -> Option<Line> {
        let n = inliers.len() as f64;
        let mean = |v: &[f64]| inliers.iter().map(|&i| v[i]).sum::<f64>() / n;
        let (mx, my) = (mean(&self.x), mean(&self.y));
        let (mut sxx, mut sxy, mut syy) = (0.0, 0.0, 0.0);
        for &i in inliers {
            let (dx, dy) = (self.x[i] - mx, self.y[i] - my);
            sxx += dx * dx;
            sxy += dx * dy;
            syy += dy * dy;
        }
        let along = 0.5 * (2.0 * sxy).atan2(sxx - syy);
        let normal = along + std::f64::consts::FRAC_PI_2;
        (sxx + syy > 0.0).then(|| Line::through(mx, my, normal))
    }

    fn residuals(&self, line: &Line, block: Range<usize>, out: &mut [f64]) {
        let (s, c) = line.angle.sin_cos();
        for (r, i) in out.iter_mut().zip(block) {
            *r = (self.x[i] * c + self.y[i] * s - line.offset).abs();
        }
    }
}

/// 1000 points within 0.02 of the line y = 0.5 x + 1, and 1000 anywhere in the same window.
fn scattered(rng: &mut ChaCha8Rng) -> Points {
    let mut points = Points {
        x: Vec::new(),
        y: Vec::new(),
    };
    for i in 0..2000 {
        let x = rng.random_range(-4.0..4.0);
        points.x.push(x);
        points.y.push(if i < 1000 {
            0.5 * x + 1.0 + rng.random_range(-0.02..0.02)
        } else {
            rng.random_range(-2.0..4.0)
        });
    }
    points
}

/// The points as dots, those within the threshold as hashes.
fn plot(points: &Points, report: &Report<Line>) -> String {
    const ROWS: usize = 22;
    const COLUMNS: usize = 72;
    let mut cells = vec![b' '; ROWS * COLUMNS];
    let cell = |i: usize| {
        let row = (4.0 - points.y[i]) / 6.0 * ROWS as f64;
        let column = (points.x[i] + 4.0) / 8.0 * COLUMNS as f64;
        let in_range = (0.0..ROWS as f64).contains(&row) && (0.0..COLUMNS as f64).contains(&column);
        in_range.then_some(row as usize * COLUMNS + column as usize)
    };
    for i in 0..points.len() {
        if let Some(at) = cell(i) {
            cells[at] = b'.';
        }
    }
    for at in report.inliers.iter().filter_map(|&i| cell(i)) {
        cells[at] = b'#';
    }
    let rows: Vec<_> = cells.chunks(COLUMNS).map(String::from_utf8_lossy).collect();
    rows.join("\n")
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let points = scattered(&mut rng);

    // The inliers come first here, and `Statistical` judges by the data that come first: it must
    // be given them in random order.
    let order = Shuffle::new(points.len(), &mut rng);
    let shuffled = Points {
        x: order.apply(&points.x),
        y: order.apply(&points.y),
    };

    let mut report = Ransac::new(Msac::within(0.05))
        .local_optimization(LeastSquares::default())
        .preemption(Statistical::with_error(0.01))
        .stopping(Confidence::new(0.999, 10_000))
        .run(&shuffled, &mut rng)?;
    order.restore(&mut report.inliers);

    let Line { angle, offset } = report.model;
    let (slope, intercept) = (-1.0 / angle.tan(), offset / angle.sin());
    println!("{}\n", plot(&points, &report));
    println!("line       y = {slope:.4} x + {intercept:.4}   (true: 0.5 x + 1)");
    println!("inliers    {} of {}", report.inliers.len(), points.len());
    println!(
        "residuals  median {:.4}, largest {:.4}",
        report.residuals.median, report.residuals.max
    );
    println!(
        "search     {} samples, ended because {:?}, confidence {:.6}",
        report.counts.draws, report.stopped, report.confidence
    );

    assert!((slope - 0.5).abs() < 0.002 && (intercept - 1.0).abs() < 0.004);
    assert!((0..1000).all(|i| report.inliers.binary_search(&i).is_ok()));
    Ok(())
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_line_is_found() {
        super::main().unwrap();
    }
}
