//! Ten thousand scenes: a path that is reported free touches nothing that is there.

use crate::world::{World, config, planner};
use nalgebra::{Isometry3, Point3};
use pomona_approach::{Approach, Gripper, Obstacle, Planner, Stage};
use pomona_geometry::{Segment, Sphere};

const SCENES: u64 = 10_000;
/// Looks along one path.
const LOOKS: usize = 150;
/// No part of the gripper is farther from the tool's origin.
const GRIPPER_M: f64 = 0.22;

/// Distance of two segments by a search that knows no cases: the distance is convex in both
/// parameters.
fn segments(a: (Point3<f64>, Point3<f64>), b: &Segment) -> f64 {
    let at = |s: f64| b.distance(&(a.0 + (a.1 - a.0) * s));
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..24 {
        let (l, h) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
        if at(l) < at(h) {
            high = h;
        } else {
            low = l;
        }
    }
    at(low).min(at(high))
}

struct Rods(Vec<(Point3<f64>, Point3<f64>, f64)>);

impl Rods {
    fn of(gripper: &Gripper, pose: &Isometry3<f64>) -> Self {
        let rods = gripper.capsules().into_iter();
        Self(rods.map(|(a, b, r)| (pose * a, pose * b, r)).collect())
    }

    fn least(&self, distance: impl Fn((Point3<f64>, Point3<f64>)) -> f64) -> f64 {
        let rods = self.0.iter().map(|(a, b, r)| distance((*a, *b)) - r);
        rods.fold(f64::INFINITY, f64::min)
    }
}

fn from_point(rod: (Point3<f64>, Point3<f64>), point: &Point3<f64>) -> f64 {
    Segment::new(rod.0, rod.1).unwrap().distance(point)
}

/// The least of what is left beyond the margins at many looks; `None` far from everything.
fn least_slack(world: &World, planner: &Planner, approach: &Approach) -> f64 {
    let config = &planner.config().clearance;
    let gripper = &planner.config().gripper;
    let near = GRIPPER_M + 0.07;
    let grasp = Point3::from(approach.grasp.translation.vector);
    let leaves: Vec<_> = world
        .leaves
        .iter()
        .filter(|p| {
            // The band about an apple makes a point that apple's, and then an obstacle with its margin;
            // those of the target are not checked.
            let own = &world.seen_apples[approach.apple];
            own.signed_distance(p) > planner.config().clearance.own_band_m + 0.012
                && (*p - grasp).norm() < near + 1.0
        })
        .collect();
    let mut least = f64::INFINITY;
    for sample in approach.path.samples(LOOKS) {
        let rods = Rods::of(gripper, &sample.pose());
        for (number, apple) in world.apples.iter().enumerate() {
            if number == approach.apple && sample.time_s > approach.path.pre_grasp_s() {
                continue;
            }
            let distance = rods.least(|rod| from_point(rod, &apple.center)) - apple.radius;
            least = least.min(distance - config.apple_margin_m);
        }
        for branch in &world.branches {
            if branch.signed_distance(&sample.position) > GRIPPER_M + 0.07 {
                continue;
            }
            let distance = rods.least(|rod| segments(rod, &branch.segment)) - branch.radius;
            least = least.min(distance - config.branch_margin_m);
        }
        for leaf in &leaves {
            if (*leaf - sample.position).norm() < near {
                let distance = rods.least(|rod| from_point(rod, leaf));
                least = least.min(distance - config.cloud_margin_m.min(config.apple_margin_m));
            }
        }
    }
    least
}

/// How much deeper the apple presses into a neighbour on its way back than where it hangs.
fn pressed(world: &World, planner: &Planner, approach: &Approach) -> f64 {
    let margin = planner.config().clearance.apple_margin_m;
    let own = &world.apples[approach.apple];
    let shift = own.center - Point3::from(approach.grasp.translation.vector);
    let mut worst: f64 = 0.0;
    for (number, other) in world.apples.iter().enumerate() {
        if number == approach.apple {
            continue;
        }
        let gap = |s: &Sphere| (s.center - other.center).norm() - s.radius - other.radius;
        let hanging = gap(own);
        for sample in approach.path.samples(LOOKS) {
            if sample.time_s >= approach.path.grasp_s() {
                let carried = Sphere {
                    center: sample.position + shift,
                    ..*own
                };
                worst = worst.max(hanging.min(margin) - gap(&carried));
            }
        }
    }
    worst
}

#[test]
fn what_is_free_touches_nothing() {
    let planner = planner();
    let (mut targets, mut free, mut least, mut deepest) = (0, 0, f64::INFINITY, 0.0_f64);
    for seed in 0..SCENES {
        let world = World::random(seed);
        // One apple of each scene keeps the time within reason.
        let target = &world.targets[seed as usize % world.targets.len()];
        targets += 1;
        let Ok(approach) = planner.plan(&world.seen, target, &world.start) else {
            continue;
        };
        free += 1;
        assert!(approach.clearance.slack_m() >= 0.0, "scene {seed}");
        let slack = least_slack(&world, &planner, &approach);
        assert!(slack >= -world.error_m - 1e-9, "scene {seed}: {slack}");
        let press = pressed(&world, &planner, &approach);
        // Both apples may be off.
        assert!(press <= 2.0 * world.error_m + 1e-9, "scene {seed}: {press}");
        least = least.min(slack);
        deepest = deepest.max(press);
    }
    println!(
        "{free} of {targets} free; least slack to the truth {:.2} mm; pressed {:.2} mm; errors up to 2 mm",
        least * 1e3,
        deepest * 1e3
    );
    assert!(free > targets / 5, "{free} of {targets}");
}

#[test]
fn the_reported_clearance_is_that_of_the_path() {
    // Without errors and without the cloud, whose cells are coarser than its points.
    let planner = planner();
    let mut compared = 0;
    for seed in 0..1000 {
        let mut world = World::random(seed);
        world.leaves.clear();
        let (apples, branches) = (world.apples.clone(), world.branches.clone());
        world.seen = pomona_approach::ObstacleMap::new(apples, branches, &[], &config().clearance);
        let Ok(approach) = planner.plan(&world.seen, &world.targets[0], &world.start) else {
            continue;
        };
        let slack = least_slack(&world, &planner, &approach);
        let clearance = approach.clearance;
        assert!(clearance.slack_m() <= slack + 1e-9, "scene {seed}");
        let Some(obstacle) = clearance.obstacle else {
            assert!(slack >= clearance.distance_m - 1e-9);
            continue;
        };
        assert_ne!(obstacle, Obstacle::Cloud);
        if clearance.stage == Stage::Transit {
            // Between two looks of this test the gripper moves by some millimetres.
            let resolution = planner.config().clearance.resolution_m;
            let known = resolution.max(0.3 / 0.7 * clearance.slack_m());
            assert!(clearance.slack_m() >= slack - known - 0.004, "scene {seed}");
            let at = approach.path.sample(clearance.time_s);
            let rods = Rods::of(&planner.config().gripper, &at.pose());
            let distance = rods.least(|rod| from_point(rod, &clearance.point_m.into()));
            let radius = match obstacle {
                Obstacle::Apple(i) => world.apples[i].radius,
                Obstacle::Branch(i) => world.branches[i].radius,
                Obstacle::Cloud => 0.0,
            };
            let there = distance - radius;
            assert!(
                (there - known - clearance.distance_m).abs() < 1e-9,
                "scene {seed}"
            );
            compared += 1;
        }
    }
    assert!(compared > 20, "{compared}");
}
