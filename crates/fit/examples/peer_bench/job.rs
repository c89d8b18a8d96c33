//! One fitting job: a line of text in, a line of text out.

use nalgebra::Point3;
use pomona_fit::{
    DistanceWindow, LineEstimator, Points, RadiusWindow, SphereEstimator, SphereRefit,
};
use pomona_ransac::{
    Confidence, FixedCount, InlierCount, Progress, Ransac, RefitOnce, StopReason, Stopping,
};
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use std::error::Error;
use std::fmt::Write as _;
use std::time::Instant;

/// Fits what the line asks for, and says how long it took, how many models were scored, and the model.
pub(crate) fn answer(line: &str) -> Result<String, Box<dyn Error>> {
    let words: Vec<&str> = line.split_whitespace().collect();
    let [primitive, file, numbers @ ..] = words.as_slice() else {
        return Err(format!("not a job: '{line}'").into());
    };
    let numbers: Result<Vec<f64>, _> = numbers.iter().map(|word| word.parse()).collect();
    let cloud = Cloud::read(file)?;
    let fitted = match (*primitive, numbers?.as_slice()) {
        ("sphere", &[hypotheses, confidence, threshold, min, max, seed]) => {
            let stopping = Stop::new(hypotheses, confidence);
            cloud.sphere(stopping, threshold, [min, max], seed as u64)?
        }
        ("line", &[hypotheses, confidence, threshold, min, max, seed, x, y, z]) => {
            let stopping = Stop::new(hypotheses, confidence);
            let window = DistanceWindow::new(Point3::new(x, y, z), min, max)?;
            cloud.line(stopping, threshold, window, seed as u64)?
        }
        _ => return Err(format!("not a job: '{line}'").into()),
    };
    let mut text = format!("{:.6} {}", fitted.milliseconds, fitted.hypotheses);
    for coefficient in fitted.model {
        write!(text, " {coefficient:.9}")?;
    }
    Ok(text)
}

/// What came of it; no coefficients where no model was found.
struct Fitted {
    milliseconds: f64,
    hypotheses: u64,
    model: Vec<f64>,
}

/// A fixed number of models, or fewer where confidence is reached before.
enum Stop {
    Count(FixedCount),
    Adaptive(FixedCount, Confidence),
}

impl Stop {
    fn new(hypotheses: f64, confidence: f64) -> Self {
        let count = FixedCount::new(hypotheses as u64);
        if confidence > 0.0 {
            Self::Adaptive(count, Confidence::new(confidence, u64::MAX))
        } else {
            Self::Count(count)
        }
    }
}

impl Stopping for Stop {
    fn reason(&self, progress: &Progress) -> Option<StopReason> {
        match self {
            Self::Count(count) => count.reason(progress),
            Self::Adaptive(count, confidence) => confidence
                .reason(progress)
                .or_else(|| count.reason(progress)),
        }
    }
}

/// Points as arrays of coordinates.
struct Cloud {
    x: Vec<f32>,
    y: Vec<f32>,
    z: Vec<f32>,
}

impl Cloud {
    fn read(path: &str) -> Result<Self, Box<dyn Error>> {
        let bytes = std::fs::read(path).map_err(|error| format!("{path}: {error}"))?;
        let numbers = bytes
            .chunks_exact(4)
            .map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]]));
        let numbers: Vec<f32> = numbers.collect();
        let axis = |axis: usize| numbers.iter().skip(axis).step_by(3).copied().collect();
        let [x, y, z] = [0, 1, 2].map(axis);
        Ok(Self { x, y, z })
    }

    fn sphere(
        &self,
        stop: Stop,
        threshold: f64,
        [min, max]: [f64; 2],
        seed: u64,
    ) -> Result<Fitted, Box<dyn Error>> {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let start = Instant::now();
        let estimator = SphereEstimator::new(
            Points::new(&self.x, &self.y, &self.z)?,
            SphereRefit::Geometric,
        );
        let report = Ransac::new(InlierCount::within(threshold))
            .constraint(RadiusWindow::new(min, max)?)
            .local_optimization(RefitOnce)
            .stopping(stop)
            .run(&estimator, &mut rng);
        let milliseconds = start.elapsed().as_secs_f64() * 1e3;
        Ok(match report {
            Ok(report) => {
                let [x, y, z] = report.model.center.into();
                let (hypotheses, radius) = (report.counts.hypotheses, report.model.radius);
                Fitted {
                    milliseconds,
                    hypotheses,
                    model: vec![x, y, z, radius],
                }
            }
            Err(_) => Fitted {
                milliseconds,
                hypotheses: 0,
                model: vec![],
            },
        })
    }

    fn line(
        &self,
        stop: Stop,
        threshold: f64,
        window: DistanceWindow,
        seed: u64,
    ) -> Result<Fitted, Box<dyn Error>> {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let start = Instant::now();
        let estimator = LineEstimator::new(Points::new(&self.x, &self.y, &self.z)?);
        let report = Ransac::new(InlierCount::within(threshold))
            .constraint(window)
            .local_optimization(RefitOnce)
            .stopping(stop)
            .run(&estimator, &mut rng);
        let milliseconds = start.elapsed().as_secs_f64() * 1e3;
        Ok(match report {
            Ok(report) => {
                let [x, y, z] = report.model.point.into();
                let [u, v, w] = report.model.direction.into_inner().into();
                let hypotheses = report.counts.hypotheses;
                Fitted {
                    milliseconds,
                    hypotheses,
                    model: vec![x, y, z, u, v, w],
                }
            }
            Err(_) => Fitted {
                milliseconds,
                hypotheses: 0,
                model: vec![],
            },
        })
    }
}
