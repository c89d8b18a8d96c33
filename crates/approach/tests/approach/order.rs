//! The order of a frame, and its reasons.

use crate::world::{Simple, World, config, planner};
use nalgebra::{Point3, Vector3};
use pomona_approach::{Order, Planner, Reason, Refusal, Target, pick_order};
use pomona_geometry::Sphere;
use pomona_transforms::Direction;

fn upwards(apple: usize, confidence: f64) -> Target {
    let mut target = Target::new(apple, Direction::new(Vector3::z()).unwrap());
    target.branch = Some(Vector3::y());
    target.confidence = confidence;
    target
}

fn order(centers: &[[f64; 3]], targets: &[Target]) -> Order {
    let mut simple = Simple::new();
    simple.branches.clear();
    simple.apples = centers
        .iter()
        .map(|c| Sphere::new(Point3::from(*c), 0.035).unwrap())
        .collect();
    let config = config();
    let planner = Planner::new(config.clone()).unwrap();
    pick_order(&planner, &simple.scene(&config), targets, &simple.start)
}

fn ranked(order: &Order) -> Vec<(usize, Reason)> {
    order.ranks.iter().map(|r| (r.target, r.reason)).collect()
}

#[test]
fn the_surer_of_two_free_ones_goes_first() {
    let centers = [[0.7, -0.3, 0.5], [0.7, 0.3, 0.5]];
    let order = order(&centers, &[upwards(0, 0.4), upwards(1, 0.9)]);
    assert_eq!(
        ranked(&order),
        [(1, Reason::Unobstructed), (0, Reason::Unobstructed)]
    );
}

#[test]
fn what_blocks_goes_first_whatever_its_confidence() {
    // The second hangs below the first, where its gripper comes up.
    let centers = [[0.75, 0.0, 0.60], [0.75, 0.0, 0.45]];
    let order = order(&centers, &[upwards(0, 1.0), upwards(1, 0.1)]);
    assert_eq!(
        ranked(&order),
        [(1, Reason::Unobstructed), (0, Reason::AfterBlockers)]
    );
    assert_eq!(order.ranks[1].blockers, [1]);
    assert!(order.approaches[0].as_ref().unwrap().clearance.slack_m() >= 0.0);
}

#[test]
fn a_blocker_that_is_out_of_reach_blocks_for_good() {
    let centers = [[0.75, 0.0, 0.60], [0.75, 0.0, 0.45]];
    let mut below = upwards(1, 0.1);
    below.directions = vec![Direction::new(-Vector3::x()).unwrap()];
    let order = order(&centers, &[upwards(0, 1.0), below]);
    assert!(order.ranks.is_empty());
    assert!(matches!(order.approaches[0], Err(Refusal::Collision(_))));
    assert!(matches!(
        order.approaches[1],
        Err(Refusal::UnreachableFromBehind { .. })
    ));
}

#[test]
fn a_circle_is_broken_where_it_is_least_tight_and_says_so() {
    // Each lies where the other's gripper comes from.
    let centers = [[0.75, -0.06, 0.50], [0.75, 0.06, 0.50]];
    let mut targets = [upwards(0, 0.5), upwards(1, 0.5)];
    targets[0].directions = vec![Direction::new(-Vector3::y()).unwrap()];
    targets[1].directions = vec![Direction::new(Vector3::y()).unwrap()];
    for target in &mut targets {
        target.branch = Some(Vector3::z());
    }
    let order = order(&centers, &targets);
    let reasons: Vec<_> = order.ranks.iter().map(|r| r.reason).collect();
    assert_eq!(reasons, [Reason::CycleBroken, Reason::AfterBlockers]);
    let first = order.approaches[order.ranks[0].target].as_ref().unwrap();
    assert!(first.clearance.slack_m() < 0.0, "its way is not free");
    let second = order.approaches[order.ranks[1].target].as_ref().unwrap();
    assert!(second.clearance.slack_m() >= 0.0);
}

#[test]
fn orders_of_random_frames_hold() {
    let planner = planner();
    let (mut after, mut circles, mut ranks) = (0, 0, 0);
    for seed in 0..400 {
        let world = World::random(seed);
        let order = pick_order(&planner, &world.seen, &world.targets, &world.start);
        assert_eq!(
            order,
            pick_order(&planner, &world.seen, &world.targets, &world.start)
        );
        let place = |target: usize| order.ranks.iter().position(|r| r.target == target);
        for (position, rank) in order.ranks.iter().enumerate() {
            let approach = order.approaches[rank.target].as_ref().unwrap();
            let all_before = rank.blockers.iter().all(|&b| place(b) < Some(position));
            match rank.reason {
                Reason::Unobstructed => assert!(rank.blockers.is_empty()),
                Reason::AfterBlockers => assert!(all_before && !rank.blockers.is_empty()),
                Reason::CycleBroken => assert!(!all_before),
            }
            let free = approach.clearance.slack_m() >= 0.0;
            assert_eq!(free, rank.reason != Reason::CycleBroken);
            // With those before it gone, the way is free indeed.
            if free {
                let mut gone = vec![false; world.apples.len()];
                for earlier in &order.ranks[..position] {
                    gone[world.targets[earlier.target].apple] = true;
                }
                let target = &world.targets[rank.target];
                let again = planner.plan_without(&world.seen, target, &world.start, &gone);
                assert!(again.is_ok(), "scene {seed}");
            }
            after += usize::from(rank.reason == Reason::AfterBlockers);
            circles += usize::from(rank.reason == Reason::CycleBroken);
            ranks += 1;
        }
        let refused = order.approaches.iter().filter(|a| a.is_err()).count();
        assert_eq!(refused + order.ranks.len(), world.targets.len());
    }
    println!("{ranks} ranked, {after} after their blockers, {circles} circles broken");
    assert!(after > 0);
}
