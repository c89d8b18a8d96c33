//! Where rows and columns of pixels cross something narrow that may be wood.

use pomona_cloud::{GrayImage, PixelWindow};

/// Probability of wood from which a pixel belongs to a crossing.
const LEAST_PROBABILITY: f64 = 0.12;

/// Greatest probability that a crossing has at least somewhere.
const LEAST_PEAK: f64 = 0.2;

/// Crossings of rows and columns, one array for each quantity. Pixels; pixel centres are whole numbers.
#[derive(Clone, Debug, Default)]
pub(crate) struct Crossings {
    /// Column of the middle, weighted by the probability.
    pub(crate) u: Vec<f64>,
    /// Row of the middle.
    pub(crate) v: Vec<f64>,
    /// Width along the row or column: the sum of the probabilities.
    pub(crate) width: Vec<f64>,
    /// Whether a row crosses, and not a column.
    pub(crate) of_row: Vec<bool>,
    /// Mean probability, weighted by itself.
    pub(crate) probability: Vec<f64>,
}

impl Crossings {
    /// The crossings in `window` that are at most `widest` wide across a line of any direction.
    pub(crate) fn of(wood: &GrayImage, window: PixelWindow, widest: f64) -> Self {
        let mut found = Self::default();
        // A line at 45 degrees is crossed by rows and columns at √2 times its width.
        let widest = widest * std::f64::consts::SQRT_2;
        for v in window.y0..window.y1 {
            let row = |u: usize| wood.values[v * wood.width + u];
            runs(window.x0..window.x1, row, |run| {
                found.add(run, v as f64, true, widest);
            });
        }
        for u in window.x0..window.x1 {
            let column = |v: usize| wood.values[v * wood.width + u];
            runs(window.y0..window.y1, column, |run| {
                found.add(run, u as f64, false, widest);
            });
        }
        found
    }

    /// Their number.
    pub(crate) fn len(&self) -> usize {
        self.u.len()
    }

    /// Those of these numbers.
    pub(crate) fn select(&self, numbers: &[usize]) -> Self {
        let pick = |values: &[f64]| numbers.iter().map(|&i| values[i]).collect();
        Self {
            u: pick(&self.u),
            v: pick(&self.v),
            width: pick(&self.width),
            of_row: numbers.iter().map(|&i| self.of_row[i]).collect(),
            probability: pick(&self.probability),
        }
    }

    fn add(&mut self, run: Run, line: f64, of_row: bool, widest: f64) {
        if run.peak < LEAST_PEAK || run.sum > widest {
            return;
        }
        let middle = run.moment / run.sum;
        let (u, v) = if of_row {
            (middle, line)
        } else {
            (line, middle)
        };
        self.u.push(u);
        self.v.push(v);
        self.width.push(run.sum);
        self.of_row.push(of_row);
        self.probability.push(run.squares / run.sum);
    }
}

/// Sums over pixels in a row that may be wood.
#[derive(Clone, Copy, Debug, Default)]
struct Run {
    sum: f64,
    moment: f64,
    squares: f64,
    peak: f64,
}

fn runs(range: std::ops::Range<usize>, value: impl Fn(usize) -> u8, mut emit: impl FnMut(Run)) {
    let mut run = Run::default();
    for k in range {
        let p = f64::from(value(k)) / 255.0;
        if p >= LEAST_PROBABILITY {
            run.sum += p;
            run.moment += p * k as f64;
            run.squares += p * p;
            run.peak = run.peak.max(p);
        } else if run.sum > 0.0 {
            emit(run);
            run = Run::default();
        }
    }
    if run.sum > 0.0 {
        emit(run);
    }
}
