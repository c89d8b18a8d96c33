//! Lines y = slope · x + intercept through points of a plane, with derivatives.

use pomona_ransac::{Candidates, Draws, Estimator, Linearization};
use std::ops::Range;

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Line {
    pub(crate) slope: f64,
    pub(crate) intercept: f64,
}

impl Line {
    pub(crate) fn at(&self, x: f64) -> f64 {
        self.slope * x + self.intercept
    }
}

#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Points {
    pub(crate) x: Vec<f64>,
    pub(crate) y: Vec<f64>,
}

/// A number between 0 and 1.
pub(crate) fn unit(draws: &mut Draws) -> f64 {
    (draws.bits() >> 11) as f64 / (1_u64 << 53) as f64
}

/// A standard normal number (Box and Muller 1958).
pub(crate) fn gaussian(draws: &mut Draws) -> f64 {
    let radius = (-2.0 * (1.0 - unit(draws)).ln()).sqrt();
    radius * (std::f64::consts::TAU * unit(draws)).cos()
}

impl Points {
    pub(crate) fn push(&mut self, x: f64, y: f64) {
        self.x.push(x);
        self.y.push(y);
    }

    /// Points of `line` at x between −1 and 1 with noise in y.
    pub(crate) fn add_line(&mut self, draws: &mut Draws, line: Line, count: usize, noise: f64) {
        for _ in 0..count {
            let x = 2.0 * unit(draws) - 1.0;
            self.push(x, line.at(x) + noise * gaussian(draws));
        }
    }

    /// Points spread evenly over the square from −1 to 1, times `scale` in y.
    pub(crate) fn add_outliers(&mut self, draws: &mut Draws, count: usize, scale: f64) {
        for _ in 0..count {
            let (x, y) = (2.0 * unit(draws) - 1.0, 2.0 * unit(draws) - 1.0);
            self.push(x, scale * y);
        }
    }

    /// Weighted least squares.
    pub(crate) fn fit_weighted(
        &self,
        data: &[usize],
        weight: impl Fn(usize) -> f64,
    ) -> Option<Line> {
        let sum = |f: &dyn Fn(usize) -> f64| -> f64 {
            data.iter()
                .enumerate()
                .map(|(k, &i)| weight(k) * f(i))
                .sum()
        };
        let n = sum(&|_| 1.0);
        let (mx, my) = (sum(&|i| self.x[i]) / n, sum(&|i| self.y[i]) / n);
        let sxx = sum(&|i| (self.x[i] - mx).powi(2));
        let sxy = sum(&|i| (self.x[i] - mx) * (self.y[i] - my));
        let slope = sxy / sxx;
        let intercept = my - slope * mx;
        (slope.is_finite() && intercept.is_finite()).then_some(Line { slope, intercept })
    }
}

impl Estimator for Points {
    type Model = Line;
    const SAMPLE_SIZE: usize = 2;
    const PARAMETERS: usize = 2;

    fn len(&self) -> usize {
        self.x.len()
    }

    fn fit(&self, sample: &[usize], candidates: &mut Candidates<Line>) {
        let &[i, j] = sample else { return };
        let slope = (self.y[j] - self.y[i]) / (self.x[j] - self.x[i]);
        let intercept = self.y[i] - slope * self.x[i];
        if slope.is_finite() && intercept.is_finite() {
            candidates.push(Line { slope, intercept });
        }
    }

    fn refit(&self, inliers: &[usize], _: &Line) -> Option<Line> {
        self.fit_weighted(inliers, |_| 1.0)
    }

    fn refit_weighted(&self, inliers: &[usize], weights: &[f64], _: &Line) -> Option<Line> {
        self.fit_weighted(inliers, |k| weights[k])
    }

    fn residuals(&self, line: &Line, block: Range<usize>, out: &mut [f64]) {
        for (r, i) in out.iter_mut().zip(block) {
            *r = (self.y[i] - line.at(self.x[i])).abs();
        }
    }

    fn linearize(&self, line: &Line, datum: usize, rows: &mut Linearization) {
        let x = self.x[datum];
        rows.push(line.at(x) - self.y[datum], &[x, 1.0]);
    }
}
