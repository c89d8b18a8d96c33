//! Paths: continuous, within their limits, straight where they should be.

use crate::world::{World, planner};
use nalgebra::Vector3;
use pomona_approach::Stage;

#[test]
fn pieces_join_to_the_second_derivative() {
    let planner = planner();
    let motion = &planner.config().motion;
    let (mut joints, mut worst, mut with_detour) = (0, 0.0_f64, 0);
    for seed in 0..1000 {
        let world = World::random(seed);
        for target in &world.targets {
            let Ok(approach) = planner.plan(&world.seen, target, &world.start) else {
                continue;
            };
            let path = &approach.path;
            for pair in path.pieces().windows(2) {
                let before = pair[0].curve.at(pair[0].curve.duration_s);
                let after = pair[1].curve.at(0.0);
                let end = pair[0].start_s + pair[0].curve.duration_s;
                assert!((end - pair[1].start_s).abs() < 1e-12);
                for gap in [
                    before.position - after.position,
                    before.velocity - after.velocity,
                    before.acceleration - after.acceleration,
                ] {
                    worst = worst.max(gap.norm());
                }
                joints += 1;
            }
            with_detour += usize::from(path.pieces().len() == 4);
            let fastest = path
                .samples(500)
                .iter()
                .map(|s| s.velocity.norm())
                .fold(0.0, f64::max);
            assert!(fastest <= motion.speed_max_m_per_s * 1.01, "{fastest}");
            let turning = path
                .samples(500)
                .iter()
                .map(|s| s.angular_velocity.norm())
                .fold(0.0, f64::max);
            assert!(turning <= motion.turn_max_rad_per_s * 1.0001, "{turning}");
        }
    }
    println!("{joints} joints, {with_detour} paths by a detour, worst gap {worst:.1e}");
    assert!(joints > 1000 && with_detour > 0 && worst < 1e-9);
}

#[test]
fn the_orientation_is_smooth_and_then_fixed() {
    let planner = planner();
    for seed in 0..100 {
        let world = World::random(seed);
        let Ok(approach) = planner.plan(&world.seen, &world.targets[0], &world.start) else {
            continue;
        };
        let path = &approach.path;
        let first = path.sample(0.0);
        assert!(first.rotation.angle_to(&world.start.0.rotation) < 1e-9);
        assert!((first.position.coords - world.start.0.translation.vector).norm() < 1e-12);
        assert!(first.velocity.norm() < 1e-12 && first.angular_velocity.norm() < 1e-12);
        let h = 1e-4;
        for i in 1..50 {
            let t = path.pre_grasp_s() * f64::from(i) / 50.0;
            let (a, b) = (path.sample(t - h), path.sample(t + h));
            let turn = (b.rotation * a.rotation.inverse()).scaled_axis() / (2.0 * h);
            assert!((turn - path.sample(t).angular_velocity).norm() < 1e-5);
        }
        let grasp = approach.grasp.rotation;
        let (from, to) = (path.pre_grasp_s(), path.duration_s());
        for i in 0..=50 {
            let sample = path.sample(from + (to - from) * f64::from(i) / 50.0);
            assert!(sample.rotation.angle_to(&grasp) < 1e-7);
            let off = sample.position.coords - approach.grasp.translation.vector;
            let along = approach.direction.vector();
            assert!((off - along * off.dot(&along)).norm() < 1e-9, "straight");
            assert!(off.dot(&along) <= 1e-9, "never beyond the apple");
        }
    }
}

#[test]
fn the_approach_only_goes_forward_and_the_retreat_only_back() {
    let planner = planner();
    let world = (0..50).map(World::random);
    for world in world {
        let Ok(approach) = planner.plan(&world.seen, &world.targets[0], &world.start) else {
            continue;
        };
        let along: Vector3<f64> = approach.direction.vector();
        for piece in approach.path.pieces() {
            let sign = match piece.stage {
                Stage::Transit => continue,
                Stage::Approach => 1.0,
                Stage::Retreat => -1.0,
            };
            for i in 0..=100 {
                let state = piece
                    .curve
                    .at(piece.curve.duration_s * f64::from(i) / 100.0);
                assert!(state.velocity.dot(&along) * sign >= -1e-12);
            }
        }
        let end = approach.path.sample(f64::INFINITY);
        assert!((end.position.coords - approach.retreat.translation.vector).norm() < 1e-9);
        assert!(end.velocity.norm() < 1e-9);
    }
}
