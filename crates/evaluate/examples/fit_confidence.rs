//! Fits the confidence of the method `robust` to scenes: `cargo xtask fit-confidence`.
//!
//! A logistic model of 'the direction is at most 20 degrees off' by what the answers' evidence holds, fitted by
//! iteratively reweighted least squares (`McCullagh` and Nelder 1989, section 4.4) with a weak Gaussian prior. Prints the
//! coefficients beside those in use, and how both do in a cross-validation over the scenes.

use nalgebra::{SMatrix, SVector, Vector3};
use pomona::{CONFIDENCE_FEATURES, CONFIDENCE_MODEL, CheckedFrame, Config, Picker};
use pomona_evaluate::Subject;
use rayon::prelude::*;

const N: usize = CONFIDENCE_FEATURES.len();

/// Suites, first seed, and scenes of the fit: none of those that the suites are evaluated on.
const SCENES: [(&str, usize); 4] = [
    ("orchard@200", 200),
    ("harsh@200", 200),
    ("harsh-kinect@200", 200),
    ("repeat474-dense", 75),
];

/// An answer is right up to this angle, radians (20°).
const RIGHT_RAD: f64 = 0.349;

/// Standard deviation of the prior of each coefficient, about 0.
const PRIOR_SD: f64 = 3.0;

/// Steps of the fit; it converges in far fewer.
const STEPS: usize = 30;

/// Parts of the cross-validation.
const FOLDS: usize = 5;

/// Bins of the calibration error.
const BINS: usize = 10;

struct Observation {
    scene: usize,
    features: SVector<f64, N>,
    right: bool,
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let observations = observe()?;
    let right = observations.iter().filter(|o| o.right).count();
    println!(
        "{} answers with a candidate, {right} of them right\n",
        observations.len()
    );
    let fitted = fit(&observations.iter().collect::<Vec<_>>()).ok_or("the fit has no solution")?;
    let current = SVector::from(CONFIDENCE_MODEL);
    println!("| feature | fitted | in use |\n|---|---|---|");
    for ((name, fitted), current) in CONFIDENCE_FEATURES.iter().zip(&fitted).zip(&current) {
        println!("| {name} | {fitted:.3} | {current:.3} |");
    }
    let mut held_out = Vec::with_capacity(observations.len());
    for fold in 0..FOLDS {
        let (out, kept): (Vec<_>, Vec<_>) =
            observations.iter().partition(|o| o.scene % FOLDS == fold);
        let model = fit(&kept).ok_or("a part of the fit has no solution")?;
        held_out.extend(
            out.iter()
                .map(|o| (probability(&model, &o.features), o.right)),
        );
    }
    let in_use: Vec<_> = observations
        .iter()
        .map(|o| (probability(&current, &o.features), o.right))
        .collect();
    println!("\n| | log loss | calibration error |\n|---|---|---|");
    for (name, answers) in [("fitted, scenes left out", held_out), ("in use", in_use)] {
        println!(
            "| {name} | {:.4} | {:.4} |",
            log_loss(&answers),
            calibration_error(&answers)
        );
    }
    Ok(())
}

/// The evidence of every answer, refused or not, with whether its candidate is right.
fn observe() -> Result<Vec<Observation>, Box<dyn std::error::Error>> {
    let mut config = Config::default();
    // Below it an answer is refused: the fit needs those as well.
    config.robust.least_confidence = 0.0;
    let picker = Picker::new(config)?;
    let mut observations = Vec::new();
    let mut first = 0;
    for (name, count) in SCENES {
        let subjects = Subject::named(name, Some(count))?;
        let scenes: Vec<_> = subjects
            .par_iter()
            .enumerate()
            .map(|(i, subject)| of_scene(&picker, subject, first + i).map_err(|e| e.to_string()))
            .collect();
        first += subjects.len();
        for scene in scenes {
            observations.extend(scene?);
        }
    }
    Ok(observations)
}

fn of_scene(
    picker: &Picker,
    subject: &Subject,
    scene: usize,
) -> Result<Vec<Observation>, Box<dyn std::error::Error>> {
    let made = subject.load()?;
    let frame = CheckedFrame::new(&made.frame)?;
    let answers = picker.pick(&frame, 0, None)?;
    let observation = |answer: &pomona::AppleAnswer| {
        let features = answer.evidence.confidence_features?;
        let mut truths = made.truth.apples.iter();
        let truth = truths.find(|truth| truth.bounds.name == answer.bounds.name)?;
        let direction = truth.direction?;
        let pick = answer.pick.as_ref()?;
        let angle = pick.direction.vector().angle(&Vector3::from(direction));
        Some(Observation {
            scene,
            features: features.into(),
            right: angle <= RIGHT_RAD,
        })
    };
    Ok(answers.apples.iter().filter_map(observation).collect())
}

fn probability(model: &SVector<f64, N>, features: &SVector<f64, N>) -> f64 {
    1.0 / (1.0 + (-model.dot(features)).exp())
}

/// The coefficients with the largest posterior; `None` where the normal equations are singular.
fn fit(observations: &[&Observation]) -> Option<SVector<f64, N>> {
    let mut model = SVector::zeros();
    for _ in 0..STEPS {
        let mut normal = SMatrix::<f64, N, N>::identity() / (PRIOR_SD * PRIOR_SD);
        let mut gradient = -model / (PRIOR_SD * PRIOR_SD);
        for o in observations {
            let p = probability(&model, &o.features);
            normal += o.features * o.features.transpose() * (p * (1.0 - p));
            gradient += o.features * (f64::from(u8::from(o.right)) - p);
        }
        model += normal.cholesky()?.solve(&gradient);
    }
    Some(model)
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
