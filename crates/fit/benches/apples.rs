//! Time of fitting the sphere and the branch of synthetic apples, and how far off they are.
//!
//! A line `accuracy NAME TEXT` on standard output goes with each benchmark.

use criterion::{Criterion, criterion_group, criterion_main};
use nalgebra::Point3;
use pomona_cloud::{DepthPoints, PixelWindow};
use pomona_fit::{
    DistanceWindow, LineEstimator, Points, RadiusWindow, SphereEstimator, SphereRefit,
};
use pomona_geometry::{Line, Sphere};
use pomona_ransac::{FixedCount, InlierCount, Ransac, RefitOnce};
use pomona_scenes::{BranchTruth, Scene, Suite};
use pomona_statistics::upper_median;
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};

/// Scenes of each suite.
const SCENES: usize = 5;
const SUITES: [&str; 3] = ["lab15", "repeat474", "orchard"];

/// The points in an apple's box, those of the shell about it, and what is true.
struct Apple {
    crop: DepthPoints,
    shell: DepthPoints,
    sphere: Sphere,
    branch: BranchTruth,
}

impl Apple {
    /// The target of a scene, where it has a branch.
    fn of(scene: &Scene) -> Option<Self> {
        let truth = scene
            .truth
            .apples
            .iter()
            .find(|apple| apple.target != Some(false))?;
        let sphere = Sphere::new(Point3::from(truth.center), truth.radius)?;
        let depth = &scene.frame.depth;
        let window = |b: &pomona_cloud::PixelBox| {
            PixelWindow::clamped(
                b.x_min,
                b.y_min,
                b.x_max,
                b.y_max,
                depth.width,
                depth.height,
            )
        };
        let mut crop = DepthPoints::new();
        crop.fill(depth, &scene.frame.camera, window(&truth.bounds))
            .ok()?;
        let mut shell = DepthPoints::new();
        let full = PixelWindow::full(depth.width, depth.height);
        shell.fill(depth, &scene.frame.camera, full).ok()?;
        shell.retain(|p| (1.2..=3.0).contains(&((p - sphere.center).norm() / sphere.radius)));
        Some(Self {
            crop,
            shell,
            sphere,
            branch: truth.branch.clone()?,
        })
    }

    /// Thousand spheres, the best one refitted.
    fn fit_sphere(&self, seed: u64) -> Option<Sphere> {
        let points = Points::new(&self.crop.x, &self.crop.y, &self.crop.z).ok()?;
        let report = Ransac::new(InlierCount::within(0.008))
            .constraint(RadiusWindow::new(0.015, 0.06).ok()?)
            .local_optimization(RefitOnce)
            .stopping(FixedCount::new(1000))
            .run(
                &SphereEstimator::new(points, SphereRefit::Geometric),
                &mut ChaCha8Rng::seed_from_u64(seed),
            );
        report.ok().map(|report| report.model)
    }

    /// Three thousand lines that pass the apple at half to one and a half radii, the best one refitted.
    fn fit_branch(&self, seed: u64) -> Option<Line> {
        let points = Points::new(&self.shell.x, &self.shell.y, &self.shell.z).ok()?;
        let Sphere { center, radius, .. } = self.sphere;
        let report = Ransac::new(InlierCount::within(0.005))
            .constraint(DistanceWindow::new(center, 0.5 * radius, 1.5 * radius).ok()?)
            .local_optimization(RefitOnce)
            .stopping(FixedCount::new(3000))
            .run(
                &LineEstimator::new(points),
                &mut ChaCha8Rng::seed_from_u64(seed),
            );
        report.ok().map(|report| report.model)
    }

    fn center_error_mm(&self, seed: u64) -> Option<f64> {
        let sphere = self.fit_sphere(seed)?;
        Some((sphere.center - self.sphere.center).norm() * 1e3)
    }

    fn axis_error_deg(&self, seed: u64) -> Option<f64> {
        let found = self.fit_branch(seed)?.direction.into_inner();
        let truth = nalgebra::Vector3::from(self.branch.direction);
        Some(
            found
                .cross(&truth)
                .norm()
                .atan2(found.dot(&truth).abs())
                .to_degrees(),
        )
    }
}

/// Times `fit` over all apples in turn, each time with another seed.
fn run<M>(c: &mut Criterion, name: &str, apples: &[Apple], fit: impl Fn(&Apple, u64) -> Option<M>) {
    let mut seed = 0;
    c.bench_function(name, |b| {
        b.iter(|| {
            seed += 1;
            fit(&apples[seed as usize % apples.len()], seed)
        });
    });
}

/// Prints the median over ten seeds of each apple.
fn accuracy(name: &str, what: &str, apples: &[Apple], error: impl Fn(&Apple, u64) -> Option<f64>) {
    let tries = apples
        .iter()
        .flat_map(|apple| (0..10).map(move |seed| (apple, seed)));
    let errors: Vec<Option<f64>> = tries.map(|(apple, seed)| error(apple, seed)).collect();
    let failures = errors.iter().filter(|error| error.is_none()).count();
    let mut found: Vec<f64> = errors.into_iter().flatten().collect();
    let found = upper_median(&mut found).unwrap_or(f64::NAN);
    println!("accuracy {name} {what} {found:.2}, {failures} failures");
}

fn benches(c: &mut Criterion) {
    for name in SUITES {
        let suite = Suite::named(name).expect("a suite of ours");
        let apples: Vec<Apple> = suite
            .cases_to(SCENES)
            .filter_map(|case| Apple::of(&case.scene()))
            .collect();
        let (sphere, branch) = (format!("sphere/{name}"), format!("branch/{name}"));
        run(c, &sphere, &apples, Apple::fit_sphere);
        accuracy(
            &sphere,
            "centre off by (mm, median)",
            &apples,
            Apple::center_error_mm,
        );
        run(c, &branch, &apples, Apple::fit_branch);
        accuracy(
            &branch,
            "axis off by (deg, median)",
            &apples,
            Apple::axis_error_deg,
        );
    }
}

criterion_group! {
    name = apples;
    config = Criterion::default().sample_size(30);
    targets = benches
}
criterion_main!(apples);
