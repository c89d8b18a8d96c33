//! Time of planning an apple, of ordering a frame, and of building a frame's scene.
//!
//! Lines `accuracy NAME TEXT` on standard output say how many of the apples were free, lines `apple NAME TEXT` the time
//! of planning one apple: the least of many rounds for each, which another program's work does not lengthen; and
//! their mean, median and largest. With the argument `--test` they are all that is measured.

use criterion::{Criterion, criterion_group, criterion_main};
use nalgebra::{Point3, Vector3};
use pomona_approach::{ApproachConfig, ObstacleMap, Planner, StartPose, Target, pick_order};
use pomona_geometry::{Capsule, Segment, Sphere};
use pomona_statistics::median;
use pomona_transforms::Direction;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::hint::black_box;
use std::time::{Duration, Instant};

/// Apples of the frame.
const APPLES: usize = 12;

/// A frame of apples on branches, with the points of leaves, wood and a ground behind.
struct Orchard {
    apples: Vec<Sphere>,
    branches: Vec<Capsule>,
    cloud: Vec<Point3<f64>>,
    targets: Vec<Target>,
}

fn unit(rng: &mut ChaCha8Rng) -> Vector3<f64> {
    Vector3::from_fn(|_, _| rng.random_range(-1.0..1.0)).normalize()
}

impl Orchard {
    fn new(leaves: usize) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(7);
        let (mut apples, mut branches) = (Vec::new(), Vec::new());
        let (mut cloud, mut targets) = (Vec::new(), Vec::new());
        for number in 0..APPLES {
            let center = Point3::new(
                rng.random_range(0.6..0.9),
                rng.random_range(-0.45..0.45),
                rng.random_range(0.1..0.8),
            );
            let radius = rng.random_range(0.028..0.042);
            apples.extend(Sphere::new(center, radius));
            for _ in 0..3000 {
                cloud.push(center + unit(&mut rng) * radius);
            }
            let up = (Vector3::z() + unit(&mut rng) * 0.6).normalize();
            let along = up.cross(&unit(&mut rng)).normalize();
            let foot = center + up * (radius + 0.008);
            let axis = Segment::new(foot - along * 0.1, foot + along * 0.1);
            branches.extend(axis.and_then(|axis| Capsule::new(axis, 0.004)));
            for _ in 0..500 {
                cloud.push(foot + along * rng.random_range(-0.1..0.1) + unit(&mut rng) * 0.004);
            }
            let Some(direction) = Direction::new(up) else {
                continue;
            };
            let mut target = Target::new(number, direction);
            target.branch = Some(along);
            target.direction_uncertainty_rad = 0.2;
            targets.push(target);
        }
        for _ in 0..leaves {
            let center = Point3::new(
                rng.random_range(0.6..1.3),
                rng.random_range(-0.6..0.6),
                rng.random_range(0.0..1.0),
            );
            let (u, v) = (unit(&mut rng) * 0.03, unit(&mut rng) * 0.03);
            for _ in 0..600 {
                let (a, b) = (rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0));
                cloud.push(center + u * a + v * b);
            }
        }
        Self {
            apples,
            branches,
            cloud,
            targets,
        }
    }

    fn scene(&self, planner: &Planner) -> ObstacleMap {
        let (apples, branches) = (self.apples.clone(), self.branches.clone());
        ObstacleMap::new(apples, branches, &self.cloud, &planner.config().clearance)
    }
}

/// Rounds of which the least time of each apple is taken.
const ROUNDS: usize = 200;

/// The least times of planning each target, in ascending order.
fn least_times(
    planner: &Planner,
    scene: &ObstacleMap,
    targets: &[Target],
    start: &StartPose,
) -> Vec<f64> {
    let mut least = vec![Duration::MAX; targets.len()];
    for _ in 0..ROUNDS {
        for (target, least) in targets.iter().zip(&mut least) {
            let begin = Instant::now();
            let _ = black_box(planner.plan(scene, target, start));
            *least = begin.elapsed().min(*least);
        }
    }
    least.iter().map(|t| t.as_secs_f64() * 1e3).collect()
}

/// The least time of building a scene, in milliseconds.
fn least_scene_time(orchard: &Orchard, planner: &Planner) -> f64 {
    let time = |_| {
        let begin = Instant::now();
        let scene = black_box(orchard.scene(planner));
        let took = begin.elapsed();
        drop(scene);
        took
    };
    let least = (0..ROUNDS / 4).map(time).min();
    least.map_or(0.0, |t| t.as_secs_f64() * 1e3)
}

fn approach(criterion: &mut Criterion) {
    let Ok(planner) = Planner::new(ApproachConfig::default()) else {
        return;
    };
    let start = StartPose::looking_along_x(Point3::new(0.25, 0.0, 0.4));
    for (name, leaves) in [("bare", 0), ("sparse", 30), ("leafy", 250)] {
        let orchard = Orchard::new(leaves);
        let scene = orchard.scene(&planner);
        let plan = |target| planner.plan(&scene, target, &start);
        let plans: Vec<_> = orchard.targets.iter().map(plan).collect();
        let free = plans.iter().filter(|p| p.is_ok()).count();
        println!(
            "accuracy {name} {free} of {APPLES} free; {} points in {} balls",
            orchard.cloud.len(),
            scene.rest().len()
        );
        let mut times = least_times(&planner, &scene, &orchard.targets, &start);
        let largest = times.iter().copied().fold(0.0, f64::max);
        println!(
            "apple {name} mean {:.3} ms, median {:.3}, largest {:.3}; scene {:.2} ms",
            times.iter().sum::<f64>() / times.len() as f64,
            median(&mut times).unwrap_or(f64::NAN),
            largest,
            least_scene_time(&orchard, &planner),
        );
        // Divide by twelve for the time of an apple.
        criterion.bench_function(&format!("plan/{name}/12 apples"), |b| {
            b.iter(|| {
                for target in &orchard.targets {
                    let _ = black_box(planner.plan(&scene, target, &start));
                }
            });
        });
        criterion.bench_function(&format!("order/{name}/12 apples"), |b| {
            b.iter(|| black_box(pick_order(&planner, &scene, &orchard.targets, &start)));
        });
        criterion.bench_function(&format!("scene/{name}"), |b| {
            b.iter(|| black_box(orchard.scene(&planner)));
        });
    }
}

criterion_group!(benches, approach);
criterion_main!(benches);
