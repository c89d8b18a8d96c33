//! One fitting job: a line of text in, a line of text out.

use nalgebra::Point3;
use pomona_fit::{
    DistanceWindow, LineEstimator, Points, RadiusWindow, SphereEstimator, SphereRefit,
};
use pomona_geometry::{Line, Sphere};
use pomona_ransac::{
    Confidence, Exhaustive, FixedCount, InlierCount, LeastSquares, Lossless, Preemption, Progress,
    Ransac, RefitOnce, Shuffle, Statistical, StopReason, Stopping, Then, Workspace,
};
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use std::error::Error;
use std::fmt::Write as _;
use std::time::Instant;

/// When a model is given up.
#[derive(Clone, Copy)]
pub(crate) enum Pruning {
    /// By the statistical bound on shuffled points: one search in a hundred may lose its best model.
    Statistical,
    /// By the bound that loses nothing.
    Lossless,
    /// Never: every model is scored on every point.
    Never,
}

impl Pruning {
    pub(crate) fn named(name: &str) -> Option<Self> {
        match name {
            "statistical" => Some(Self::Statistical),
            "lossless" => Some(Self::Lossless),
            "never" => Some(Self::Never),
            _ => None,
        }
    }
}

/// Answers one job after the other, in memory that is used again.
pub(crate) struct Server {
    pruning: Pruning,
    shuffled: Shuffled,
    spheres: Workspace<Sphere>,
    lines: Workspace<Line>,
}

impl Server {
    pub(crate) fn new(pruning: Pruning) -> Self {
        Self {
            pruning,
            shuffled: Shuffled::default(),
            spheres: Workspace::new(),
            lines: Workspace::new(),
        }
    }

    /// Fits what the line asks for, and says how long it took, how many models were scored, and the model.
    pub(crate) fn answer(&mut self, line: &str) -> Result<String, Box<dyn Error>> {
        let words: Vec<&str> = line.split_whitespace().collect();
        let [primitive, file, numbers @ ..] = words.as_slice() else {
            return Err(format!("not a job: '{line}'").into());
        };
        let numbers: Result<Vec<f64>, _> = numbers.iter().map(|word| word.parse()).collect();
        let cloud = Cloud::read(file)?;
        let fitted = match (*primitive, numbers?.as_slice()) {
            ("sphere", &[hypotheses, confidence, threshold, min, max, seed]) => {
                let search = Search::new(threshold, hypotheses, confidence, seed);
                self.sphere(&cloud, &search, RadiusWindow::new(min, max)?)?
            }
            ("line", &[hypotheses, confidence, threshold, min, max, seed, x, y, z]) => {
                let search = Search::new(threshold, hypotheses, confidence, seed);
                let window = DistanceWindow::new(Point3::new(x, y, z), min, max)?;
                self.line(&cloud, &search, window)?
            }
            _ => return Err(format!("not a job: '{line}'").into()),
        };
        let mut text = format!("{:.6} {}", fitted.milliseconds, fitted.hypotheses);
        for coefficient in fitted.model {
            write!(text, " {coefficient:.9}")?;
        }
        Ok(text)
    }

    fn sphere(
        &mut self,
        cloud: &Cloud,
        search: &Search,
        window: RadiusWindow,
    ) -> Result<Fitted, Box<dyn Error>> {
        match self.pruning {
            Pruning::Statistical => self.sphere_by(statistical(), cloud, search, window),
            Pruning::Lossless => self.sphere_by(Lossless::default(), cloud, search, window),
            Pruning::Never => self.sphere_by(Exhaustive, cloud, search, window),
        }
    }

    fn sphere_by<B: Preemption>(
        &mut self,
        preemption: B,
        cloud: &Cloud,
        search: &Search,
        window: RadiusWindow,
    ) -> Result<Fitted, Box<dyn Error>> {
        let mut rng = ChaCha8Rng::seed_from_u64(search.seed);
        let start = Instant::now();
        let points = arranged::<B>(&mut self.shuffled, cloud, &mut rng)?;
        let report = Ransac::new(InlierCount::within(search.threshold))
            .constraint(window)
            .local_optimization(RefitOnce)
            .covariance(false)
            .preemption(preemption)
            .stopping(search.stopping)
            .run_with(
                &mut self.spheres,
                &SphereEstimator::new(points, SphereRefit::Geometric),
                &mut rng,
            );
        let milliseconds = start.elapsed().as_secs_f64() * 1e3;
        let fitted = report.map(|report| {
            let Sphere { center, radius, .. } = report.model;
            let model = vec![center.x, center.y, center.z, radius];
            (report.counts.hypotheses, model)
        });
        Ok(Fitted::new(milliseconds, fitted.ok()))
    }

    fn line(
        &mut self,
        cloud: &Cloud,
        search: &Search,
        window: DistanceWindow,
    ) -> Result<Fitted, Box<dyn Error>> {
        match self.pruning {
            Pruning::Statistical => self.line_by(statistical(), cloud, search, window),
            Pruning::Lossless => self.line_by(Lossless::default(), cloud, search, window),
            Pruning::Never => self.line_by(Exhaustive, cloud, search, window),
        }
    }

    fn line_by<B: Preemption>(
        &mut self,
        preemption: B,
        cloud: &Cloud,
        search: &Search,
        window: DistanceWindow,
    ) -> Result<Fitted, Box<dyn Error>> {
        let mut rng = ChaCha8Rng::seed_from_u64(search.seed);
        let start = Instant::now();
        let points = arranged::<B>(&mut self.shuffled, cloud, &mut rng)?;
        let report = Ransac::new(InlierCount::within(search.threshold))
            .constraint(window)
            .local_optimization(Then(LeastSquares::default(), RefitOnce))
            .covariance(false)
            .preemption(preemption)
            .stopping(search.stopping)
            .run_with(&mut self.lines, &LineEstimator::new(points), &mut rng);
        let milliseconds = start.elapsed().as_secs_f64() * 1e3;
        let fitted = report.map(|report| {
            let [x, y, z] = report.model.point.into();
            let [u, v, w] = report.model.direction.into_inner().into();
            (report.counts.hypotheses, vec![x, y, z, u, v, w])
        });
        Ok(Fitted::new(milliseconds, fitted.ok()))
    }
}

fn statistical() -> Statistical {
    Statistical::with_error(0.01)
}

/// The points in the order in which a rule wants them: shuffled, unless it is lossless.
fn arranged<'a, B: Preemption>(
    shuffled: &'a mut Shuffled,
    cloud: &'a Cloud,
    rng: &mut ChaCha8Rng,
) -> Result<Points<'a, f32>, Box<dyn Error>> {
    if B::LOSSLESS {
        return cloud.points();
    }
    let Shuffled { order, points } = shuffled;
    order.renew(cloud.x.len(), rng);
    order.apply_into(&cloud.x, &mut points.x);
    order.apply_into(&cloud.y, &mut points.y);
    order.apply_into(&cloud.z, &mut points.z);
    points.points()
}

/// A cloud in random order, in memory that is used again.
#[derive(Default)]
struct Shuffled {
    order: Shuffle,
    points: Cloud,
}

/// How to search, whatever for.
struct Search {
    threshold: f64,
    stopping: Stop,
    seed: u64,
}

impl Search {
    fn new(threshold: f64, hypotheses: f64, confidence: f64, seed: f64) -> Self {
        Self {
            threshold,
            stopping: Stop::new(hypotheses, confidence),
            seed: seed as u64,
        }
    }
}

/// What came of it; no coefficients where no model was found.
struct Fitted {
    milliseconds: f64,
    hypotheses: u64,
    model: Vec<f64>,
}

impl Fitted {
    fn new(milliseconds: f64, found: Option<(u64, Vec<f64>)>) -> Self {
        let (hypotheses, model) = found.unwrap_or_default();
        Self {
            milliseconds,
            hypotheses,
            model,
        }
    }
}

/// A fixed number of models, or fewer where confidence is reached before.
#[derive(Clone, Copy)]
enum Stop {
    Count(FixedCount),
    Adaptive(FixedCount, Confidence),
}

impl Stop {
    fn new(hypotheses: f64, confidence: f64) -> Self {
        let count = FixedCount::new(hypotheses as u64);
        if confidence > 0.0 {
            Self::Adaptive(count, Confidence::new(confidence, u64::MAX).accepted_only())
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

    fn draws_left(&self, progress: &Progress) -> u64 {
        match self {
            Self::Count(count) => count.draws_left(progress),
            Self::Adaptive(count, confidence) => confidence
                .draws_left(progress)
                .min(count.draws_left(progress)),
        }
    }
}

/// Points as arrays of coordinates.
#[derive(Default)]
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

    fn points(&self) -> Result<Points<'_, f32>, Box<dyn Error>> {
        Ok(Points::new(&self.x, &self.y, &self.z)?)
    }
}
