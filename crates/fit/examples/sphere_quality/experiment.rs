use nalgebra::{Point3, Vector3};
use pomona_fit::{
    Points, RadiusPrior, RadiusWindow, SphereEstimator, SphereRefit, ThreePointsAndRadius,
    sphere_weighted,
};
use pomona_geometry::Sphere;
use pomona_ransac::{
    FixedCount, LeastSquares, Marginal, MarginalScore, Msac, Ransac, RansacError, Report,
    Reweighted,
};
use pomona_statistics::nearest_quantile;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Noise of the points across the surface, metres.
const SIGMA: f64 = 0.0015;
/// How well the radius is known where there is a prior, metres.
const PRIOR_SIGMA: f64 = 0.002;
const RADIUS: f64 = 0.04;
/// Half the edge of the cube that outliers fill, metres.
const AROUND: f64 = 3.0 * RADIUS;
const POINTS: usize = 1000;
const INLIERS: usize = 300;
/// A centre farther off is a failure, metres.
const FAILURE: f64 = 0.003;

/// What is searched with.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Score {
    Msac,
    Marginal,
}

/// A configuration of the search.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Configuration {
    /// Points all over the sphere, or on the camera's side alone.
    pub(crate) whole: bool,
    /// Three points and a radius prior, or four points.
    pub(crate) prior: bool,
    pub(crate) score: Score,
    /// In σ of the points.
    pub(crate) threshold: f64,
    pub(crate) hypotheses: u64,
}

/// What came out of many clouds.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Figures {
    /// Share of the clouds whose centre is more than 3 mm off.
    pub(crate) failures: f64,
    /// Median and 95th percentile of the distance between the centres, metres.
    pub(crate) errors: [f64; 2],
    /// The same of a refit to the true inliers.
    pub(crate) ideal: [f64; 2],
}

/// A standard normal number (Box and Muller 1958).
fn gauss(rng: &mut ChaCha8Rng) -> f64 {
    let a: f64 = rng.random_range(f64::EPSILON..1.0);
    let b: f64 = rng.random_range(0.0..1.0);
    (-2.0 * a.ln()).sqrt() * (std::f64::consts::TAU * b).cos()
}

/// A sphere, or the camera's side of it, with noise, and then outliers all over a cube about it.
fn cloud(truth: &Sphere, whole: bool, rng: &mut ChaCha8Rng) -> Vec<Point3<f64>> {
    let eye = -truth.center.coords.normalize();
    let mut points = Vec::with_capacity(POINTS);
    while points.len() < INLIERS {
        let normal = Vector3::from_fn(|_, _| gauss(rng)).normalize();
        if whole || normal.dot(&eye) > 0.2 {
            points.push(truth.center + normal * (truth.radius + SIGMA * gauss(rng)));
        }
    }
    while points.len() < POINTS {
        let off = Vector3::from_fn(|_, _| rng.random_range(-AROUND..AROUND));
        points.push(truth.center + off);
    }
    points
}

fn search(
    points: Points<'_, f32>,
    prior: Option<RadiusPrior>,
    configuration: Configuration,
    rng: &mut ChaCha8Rng,
) -> Result<Report<Sphere>, RansacError> {
    let threshold = configuration.threshold * SIGMA;
    let window = RadiusWindow::new(0.02, 0.06).expect("a window");
    let stopping = FixedCount::new(configuration.hypotheses);
    let free = SphereEstimator::new(points, SphereRefit::Geometric);
    macro_rules! run {
        ($estimator:expr) => {
            match configuration.score {
                Score::Msac => Ransac::new(Msac::within(threshold))
                    .constraint(window)
                    .local_optimization(LeastSquares::rounds(50))
                    .stopping(stopping)
                    .run($estimator, rng),
                Score::Marginal => Ransac::new(MarginalScore::within(threshold))
                    .constraint(window)
                    .local_optimization(Reweighted::by(Marginal::weight).rounds(50))
                    .stopping(stopping)
                    .run($estimator, rng),
            }
        };
    }
    match prior {
        Some(prior) => {
            let sample = ThreePointsAndRadius::new(prior);
            let sample = if configuration.whole {
                sample
            } else {
                sample.seen_from(Point3::origin())
            };
            let with_prior = free.prior(prior, SIGMA).expect("a noise");
            run!(&with_prior.sampling(sample))
        }
        None => run!(&free),
    }
}

/// Searches `clouds` clouds, each with a seed of its own.
pub(crate) fn measure(configuration: Configuration, clouds: u64) -> Figures {
    let (mut errors, mut ideal) = (Vec::new(), Vec::new());
    for seed in 0..clouds {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let truth = Sphere::new(Point3::new(0.1, -0.05, 0.8), RADIUS).expect("a sphere");
        let points = cloud(&truth, configuration.whole, &mut rng);
        let mean = RADIUS + PRIOR_SIGMA * gauss(&mut rng).clamp(-3.0, 3.0);
        let prior = RadiusPrior::new(mean, PRIOR_SIGMA).expect("a prior");
        let prior = configuration.prior.then_some(prior);
        let weighted = points[..INLIERS].iter().map(|&p| (p, SIGMA.powi(-2)));
        let best = sphere_weighted(weighted, &truth, prior).expect("a fit");
        ideal.push((best.center - truth.center).norm());
        let [x, y, z] = [0, 1, 2].map(|k| {
            let coordinates = points.iter().map(|p| p[k] as f32);
            coordinates.collect::<Vec<f32>>()
        });
        let view = Points::new(&x, &y, &z).expect("one length");
        let found = search(view, prior, configuration, &mut rng);
        errors.push(found.map_or(f64::INFINITY, |report| {
            (report.model.center - truth.center).norm()
        }));
    }
    let failures = errors.iter().filter(|&&e| e > FAILURE).count() as f64 / clouds as f64;
    Figures {
        failures,
        errors: quantiles(errors),
        ideal: quantiles(ideal),
    }
}

fn quantiles(mut values: Vec<f64>) -> [f64; 2] {
    [0.5, 0.95].map(|q| nearest_quantile(&mut values, q).unwrap_or(f64::NAN))
}
