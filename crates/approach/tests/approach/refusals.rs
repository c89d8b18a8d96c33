//! Each refusal by a scene that calls for it, and the same scene without its cause.

use crate::world::{Simple, config};
use nalgebra::{Point3, Vector3};
use pomona_approach::{
    Approach, ApproachConfig, Obstacle, Planner, ReachLimit, Refusal, Roll, Stage, StartPose,
};
use pomona_geometry::{Capsule, Segment, Sphere};
use pomona_transforms::Direction;

fn plan(simple: &Simple, config: &ApproachConfig) -> Result<Approach, Refusal> {
    let planner = Planner::new(config.clone()).unwrap();
    planner.plan(&simple.scene(config), &simple.target, &simple.start)
}

#[test]
fn the_plain_scene_is_free() {
    let approach = plan(&Simple::new(), &config()).unwrap();
    assert_eq!(
        (approach.tried, approach.candidate, approach.tilt_rad),
        (1, 0, 0.0)
    );
    // The fingers open across the branch.
    let opening = approach.grasp * Vector3::y();
    assert!(opening.dot(&Vector3::y()).abs() < 1e-12);
    assert!((approach.grasp * Vector3::x() - Vector3::z()).norm() < 1e-12);
    assert!((approach.pre_grasp.translation.vector.z - 0.35).abs() < 1e-12);
    assert!((approach.retreat.translation.vector.z - 0.30).abs() < 1e-12);
}

#[test]
fn unreachable_from_behind() {
    let mut simple = Simple::new();
    simple.target.directions = vec![Direction::new(-Vector3::x()).unwrap()];
    let refusal = plan(&simple, &config()).unwrap_err();
    let Refusal::UnreachableFromBehind {
        angle_rad,
        limit_rad,
    } = refusal
    else {
        panic!("{refusal}");
    };
    // The ray to (0.8, 0, 0.5) against −x.
    assert!((angle_rad - (std::f64::consts::PI - 0.5_f64.atan2(0.8))).abs() < 1e-12);
    assert!(angle_rad > limit_rad);
    // The next candidate is tried before refusing.
    simple
        .target
        .directions
        .push(Direction::new(Vector3::z()).unwrap());
    assert_eq!(plan(&simple, &config()).unwrap().candidate, 1);
}

#[test]
fn out_of_reach_of_shell_and_box() {
    let limit = |change: &dyn Fn(&mut ApproachConfig)| {
        let mut config = config();
        change(&mut config);
        match plan(&Simple::new(), &config).unwrap_err() {
            Refusal::OutOfReach { limit, .. } => limit,
            other => panic!("{other}"),
        }
    };
    assert_eq!(
        limit(&|c| c.reach.shell_outer_m = 0.85),
        ReachLimit::ShellOuter
    );
    assert_eq!(
        limit(&|c| c.reach.shell_inner_m = 0.90),
        ReachLimit::ShellInner
    );
    assert_eq!(limit(&|c| c.reach.box_min_m[2] = 0.4), ReachLimit::Box);
    // The whole way counts, not only its ends: the start here lies outside.
    assert_eq!(limit(&|c| c.reach.box_min_m[0] = 0.4), ReachLimit::Box);
}

#[test]
fn gripper_too_small_in_width_and_in_depth() {
    for change in [
        (|c: &mut ApproachConfig| c.gripper.jaw_width_m = 0.079) as fn(&mut ApproachConfig),
        |c| c.gripper.palm_depth_m = 0.039,
    ] {
        let mut config = config();
        change(&mut config);
        let refusal = plan(&Simple::new(), &config).unwrap_err();
        let Refusal::GripperTooSmall {
            needed_width_m,
            needed_depth_m,
            ..
        } = refusal
        else {
            panic!("{refusal}");
        };
        assert!((needed_width_m - 0.080).abs() < 1e-12 && (needed_depth_m - 0.040).abs() < 1e-12);
    }
    let mut config = config();
    config.gripper.jaw_width_m = 0.081;
    config.gripper.palm_depth_m = 0.041;
    plan(&Simple::new(), &config).unwrap();
}

fn collision(simple: &Simple, config: &ApproachConfig) -> pomona_approach::Clearance {
    match plan(simple, config).unwrap_err() {
        Refusal::Collision(clearance) => clearance,
        other => panic!("{other}"),
    }
}

#[test]
fn collision_with_each_kind_of_thing() {
    // A branch where a finger comes up.
    let mut simple = Simple::new();
    let axis = Segment::new(Point3::new(0.86, -0.2, 0.5), Point3::new(0.86, 0.2, 0.5)).unwrap();
    simple.branches.push(Capsule::new(axis, 0.004).unwrap());
    let found = collision(&simple, &config());
    assert_eq!(
        (found.obstacle, found.stage),
        (Some(Obstacle::Branch(1)), Stage::Approach)
    );
    assert!(found.slack_m() < 0.0 && (found.point_m[0] - 0.86).abs() < 1e-9);

    // A neighbour below, in the palm's way.
    let mut simple = Simple::new();
    simple
        .apples
        .push(Sphere::new(Point3::new(0.8, 0.03, 0.38), 0.035).unwrap());
    let found = collision(&simple, &config());
    assert_eq!(found.obstacle, Some(Obstacle::Apple(1)));

    // Leaves there.
    let mut simple = Simple::new();
    simple.lump([0.8, 0.0, 0.40]);
    let found = collision(&simple, &config());
    assert_eq!(found.obstacle, Some(Obstacle::Cloud));
    let mut brushing = config();
    brushing.clearance.cloud_margin_m = -0.1;
    plan(&simple, &brushing).unwrap();

    // A neighbour between the fingers that they miss, but the carried apple does not.
    let mut simple = Simple::new();
    let mut wide = config();
    wide.gripper.palm_depth_m = 0.2;
    wide.gripper.jaw_width_m = 0.2;
    wide.motion.standoff_m = 0.05;
    wide.motion.retreat_m = 0.05;
    plan(&simple, &wide).unwrap();
    simple
        .apples
        .push(Sphere::new(Point3::new(0.8, 0.0, 0.432), 0.030).unwrap());
    let found = collision(&simple, &wide);
    assert_eq!(
        (found.obstacle, found.stage),
        (Some(Obstacle::Apple(1)), Stage::Retreat)
    );
}

#[test]
fn a_wall_before_the_tree_stops_the_transit() {
    let mut simple = Simple::new();
    for i in -60..=60 {
        for j in 0..=120 {
            let (y, z) = (0.008 * f64::from(i), 0.008 * f64::from(j));
            simple.cloud.push(Point3::new(0.5, y, z));
        }
    }
    let found = collision(&simple, &config());
    assert_eq!(
        (found.obstacle, found.stage),
        (Some(Obstacle::Cloud), Stage::Transit)
    );
    assert!((found.point_m[0] - 0.5).abs() < 0.01 && found.time_s > 0.0);
}

#[test]
fn a_tilt_within_the_uncertainty_avoids_a_collision() {
    let mut simple = Simple::new();
    // Where the wrist comes to be, on the far side.
    simple.lump([0.85, 0.0, 0.32]);
    let found = collision(&simple, &config());
    assert_eq!(found.obstacle, Some(Obstacle::Cloud));
    simple.target.direction_uncertainty_rad = 0.5;
    let approach = plan(&simple, &config()).unwrap();
    assert!(approach.tried > 1 && approach.tilt_rad > 0.0);
    assert!(approach.tilt_rad <= config().search.tilt_max_rad + 1e-12);
    assert!(approach.clearance.slack_m() >= 0.0);
    // The tool still points along its own direction.
    assert!((approach.grasp * Vector3::x() - approach.direction.vector()).norm() < 1e-12);
}

#[test]
fn a_free_roll_finds_what_the_aligned_one_does_not() {
    let mut simple = Simple::new();
    simple.lump([0.856, 0.0, 0.45]);
    let mut config = config();
    assert_eq!(collision(&simple, &config).obstacle, Some(Obstacle::Cloud));
    config.search.roll = Roll::Free;
    let approach = plan(&simple, &config).unwrap();
    assert!((approach.grasp * Vector3::y()).x.abs() < 0.9);
}

#[test]
fn what_makes_no_sense_is_refused_and_does_not_panic() {
    let mut simple = Simple::new();
    simple.target.apple = 7;
    let refusal = plan(&simple, &config()).unwrap_err();
    assert_eq!(
        refusal,
        Refusal::NoTarget {
            apple: 7,
            apples: 1
        }
    );
    let mut simple = Simple::new();
    simple.target.directions.clear();
    assert_eq!(plan(&simple, &config()).unwrap_err().name(), "no_target");
    let mut simple = Simple::new();
    simple.start = StartPose::looking_along_x(Point3::new(f64::NAN, 0.0, 0.0));
    assert_eq!(plan(&simple, &config()).unwrap_err(), Refusal::NoStart);
    // At the pre-grasp already, and with wild numbers about.
    let mut simple = Simple::new();
    simple.target.branch = Some(Vector3::repeat(f64::NAN));
    simple.target.direction_uncertainty_rad = f64::NAN;
    simple.cloud.push(Point3::new(f64::NAN, f64::INFINITY, 0.0));
    let approach = plan(&simple, &config()).unwrap();
    simple.start = StartPose(approach.pre_grasp);
    plan(&simple, &config()).unwrap();
}
