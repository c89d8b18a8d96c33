//! A logistic model fitted by iteratively reweighted least squares (`McCullagh` and Nelder 1989, section 4.4) with a weak
//! Gaussian prior.

use nalgebra::{SMatrix, SVector};

/// Standard deviation of the prior of each coefficient about 0, for features of unit variance.
const PRIOR_SD: f64 = 0.55;

/// Steps of the fit; it converges in far fewer.
const STEPS: usize = 30;

/// Parts of the cross-validation.
const FOLDS: usize = 5;

/// Bins of the calibration error.
const BINS: usize = 10;

/// What a model is asked about, and the outcome.
pub(crate) struct Observation<const N: usize> {
    pub(crate) scene: usize,
    pub(crate) suite: &'static str,
    pub(crate) features: SVector<f64, N>,
    pub(crate) right: bool,
}

/// By how much the observations that are right count, those that are wrong counting 1.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Weighting {
    /// As much.
    Equal,
    /// So much that together they make this share of all.
    Share(f64),
}

impl Weighting {
    fn of_right(self, right: usize, wrong: usize) -> f64 {
        match self {
            Self::Equal => 1.0,
            Self::Share(share) => share / (1.0 - share) * wrong as f64 / right.max(1) as f64,
        }
    }
}

/// Prints the model fitted to `observations` beside the one in use.
pub(crate) fn print<const N: usize>(
    names: &[&str; N],
    in_use: &[f64; N],
    observations: &[Observation<N>],
    weighting: Weighting,
) -> Result<(), Box<dyn std::error::Error>> {
    let right = observations.iter().filter(|o| o.right).count();
    println!(
        "{} observations, {right} of them right\n",
        observations.len()
    );
    let weight = weighting.of_right(right, observations.len() - right);
    let all: Vec<_> = observations.iter().collect();
    let fitted = fit(&all, weight).ok_or("the fit has no solution")?;
    let in_use = SVector::from(*in_use);
    println!("| feature | fitted | in use |\n|---|---|---|");
    for ((name, fitted), in_use) in names.iter().zip(&fitted).zip(&in_use) {
        println!("| {name} | {fitted:.3} | {in_use:.3} |");
    }
    let mut left_out = Vec::with_capacity(observations.len());
    for fold in 0..FOLDS {
        let (out, kept): (Vec<_>, Vec<_>) =
            observations.iter().partition(|o| o.scene % FOLDS == fold);
        let model = fit(&kept, weight).ok_or("a part of the fit has no solution")?;
        left_out.extend(out.iter().map(|o| (o.suite, judged(&model, o))));
    }
    let used = observations.iter().map(|o| (o.suite, judged(&in_use, o)));
    let used: Vec<_> = used.collect();
    let mut suites: Vec<&str> = observations.iter().map(|o| o.suite).collect();
    suites.dedup();
    println!("\n| | suite | log loss | calibration error |\n|---|---|---|---|");
    for (name, answers) in [("fitted, scenes left out", &left_out), ("in use", &used)] {
        let all: Vec<_> = answers.iter().map(|a| a.1).collect();
        print_line(name, "all", &all);
        for suite in &suites {
            let own = answers.iter().filter(|a| a.0 == *suite).map(|a| a.1);
            print_line(name, suite, &own.collect::<Vec<_>>());
        }
    }
    Ok(())
}

fn print_line(name: &str, suite: &str, answers: &[(f64, bool)]) {
    println!(
        "| {name} | {suite} | {:.4} | {:.4} |",
        log_loss(answers),
        calibration_error(answers)
    );
}

fn judged<const N: usize>(model: &SVector<f64, N>, o: &Observation<N>) -> (f64, bool) {
    (probability(model, &o.features), o.right)
}

fn probability<const N: usize>(model: &SVector<f64, N>, features: &SVector<f64, N>) -> f64 {
    1.0 / (1.0 + (-model.dot(features)).exp())
}

/// The coefficients with the largest posterior; `None` where the normal equations are singular. The first feature is 1.
/// What is right counts `weight`, what is wrong 1.
fn fit<const N: usize>(observations: &[&Observation<N>], weight: f64) -> Option<SVector<f64, N>> {
    let n = observations.len() as f64;
    let mean = observations
        .iter()
        .fold(SVector::zeros(), |sum, o| sum + o.features)
        / n;
    let squares = observations
        .iter()
        .fold(SVector::<f64, N>::zeros(), |sum, o| {
            sum + (o.features - mean).map(|d| d * d)
        });
    let sd = (squares / n).map(|variance| variance.sqrt().max(1e-9));
    let standard = |o: &Observation<N>| {
        let mut z = (o.features - mean).component_div(&sd);
        z[0] = 1.0;
        z
    };
    let rows: Vec<_> = observations
        .iter()
        .map(|o| (standard(o), f64::from(u8::from(o.right))))
        .collect();
    let mut precision = SVector::<f64, N>::repeat(1.0 / (PRIOR_SD * PRIOR_SD));
    // Nothing is supposed about how many are right.
    precision[0] = 1e-6;
    let mut model = SVector::<f64, N>::zeros();
    for _ in 0..STEPS {
        let mut normal = SMatrix::<f64, N, N>::from_diagonal(&precision);
        let mut gradient = -model.component_mul(&precision);
        for (z, right) in &rows {
            let p = probability(&model, z);
            let w = if *right > 0.5 { weight } else { 1.0 };
            normal += z * z.transpose() * (w * p * (1.0 - p));
            gradient += z * (w * (right - p));
        }
        model += normal.cholesky()?.solve(&gradient);
    }
    let mut raw = model.component_div(&sd);
    raw[0] = 0.0;
    raw[0] = model[0] - raw.dot(&mean);
    Some(raw)
}

fn log_loss(answers: &[(f64, bool)]) -> f64 {
    let loss = |&(p, right): &(f64, bool)| -(if right { p } else { 1.0 - p }).max(1e-12).ln();
    answers.iter().map(loss).sum::<f64>() / answers.len().max(1) as f64
}

/// Expected calibration error over bins of equal width (Naeini et al. 2015).
fn calibration_error(answers: &[(f64, bool)]) -> f64 {
    let mut bins = [(0.0, 0.0); BINS];
    for &(p, right) in answers {
        let (stated, observed) = &mut bins[((p * BINS as f64) as usize).min(BINS - 1)];
        *stated += p;
        *observed += f64::from(u8::from(right));
    }
    let difference: f64 = bins.iter().map(|(a, b)| f64::abs(a - b)).sum();
    difference / answers.len().max(1) as f64
}
