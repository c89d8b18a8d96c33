//! Fusion of drawn and rendered trees: positions better than each frame's, sway distinguished from moved fruit, refusals.

use crate::drawn_tree::{Trial, View, still};
use crate::orchard_views::views;
use nalgebra::{Matrix6, Vector3};
use pomona::{FrameAnswer, RobotFromCamera};
use pomona_fusion::{
    DirectionUse, FusedRecord, FusedStatus, FusedTree, FusionConfig, FusionError, PosedAnswer,
    PositionUse, fuse,
};
use pomona_transforms::{Position, RobotFrame};

fn fused(frames: &[(FrameAnswer, RobotFromCamera)], config: &FusionConfig) -> FusedTree {
    let posed: Vec<PosedAnswer> = frames
        .iter()
        .map(|(answer, robot_from_camera)| PosedAnswer::new(answer, robot_from_camera))
        .collect();
    fuse(&posed, config).unwrap()
}

/// The stated errors of the trials are whole: nothing is to be added.
fn exact() -> FusionConfig {
    FusionConfig::default().with(|c| {
        c.center_floor_m = 0.0;
        c.radius_floor_m = 0.0;
        c.direction_floor_rad = 0.0;
    })
}

#[test]
fn fused_positions_are_better_than_each_frame_and_their_covariance_is_true() {
    let (mut single, mut together, mut squares, mut angles, mut singles) =
        (0.0, 0.0, 0.0, 0.0, 0.0);
    let mut count = 0.0;
    for seed in 0..60 {
        let mut trial = Trial::new(seed);
        let tree = trial.tree(8);
        let config = exact().with(|c| (c.sway_sd_m, c.sway_sd_rad) = (0.0, 0.0));
        let frames: Vec<_> = [-0.6, 0.0, 0.6]
            .iter()
            .enumerate()
            .map(|(k, &angle)| {
                let view = View {
                    pose_sd: (0.001, 0.001),
                    ..still(angle)
                };
                trial.answer(&format!("f{k}"), &tree, &view)
            })
            .collect();
        let fusion = fused(&frames, &config);
        assert_eq!(fusion.apples.len(), tree.len());
        for (apple, truth) in fusion.apples.iter().zip(&tree) {
            assert_eq!(apple.observations.len(), 3);
            let error = apple.center.position.point().coords - truth.center;
            together += error.norm();
            squares += error.dot(&(apple.center.covariance_m2.try_inverse().unwrap() * error));
            angles += apple
                .direction
                .unwrap()
                .direction
                .vector()
                .angle(&truth.direction);
            for (answer, pose) in &frames {
                let own = &answer.apples[apple.observations[0].pick];
                let center = pose.transform.position(&own.apple.unwrap().center);
                single += (center.point().coords - truth.center).norm() / 3.0;
                let direction = pose.transform.direction(&own.pick.unwrap().direction);
                singles += direction.vector().angle(&truth.direction) / 3.0;
            }
            count += 1.0;
        }
    }
    assert!(
        together < 0.6 * single,
        "{} mm against {}",
        together / count * 1e3,
        single / count * 1e3
    );
    assert!(
        angles < 0.7 * singles,
        "{} against {}",
        angles / count,
        singles / count
    );
    // The mean of a chi-square of three degrees of freedom is 3.
    let mean = squares / count;
    assert!(mean > 2.4 && mean < 3.6, "{mean}");
}

#[test]
fn sway_is_measured_and_not_taken_for_movement() {
    let mut off = 0.0;
    for seed in 0..20 {
        let mut trial = Trial::new(100 + seed);
        let tree = trial.tree(10);
        let sway = trial.normals() * 0.008;
        let frames = [
            trial.answer("a", &tree, &still(-0.3)),
            trial.answer("b", &tree, &View { sway, ..still(0.3) }),
        ];
        let fusion = fused(&frames, &exact());
        assert!(
            fusion
                .apples
                .iter()
                .all(|a| a.movement.is_none() && a.observations.len() == 2)
        );
        let shift = fusion.frames[1].shift.as_ref().unwrap();
        off += (shift.by - sway).norm() / 20.0;
        assert!(shift.significant || sway.norm() < 0.01);
        assert_eq!(fusion.frames[1].shared, 10);
    }
    assert!(off < 0.003, "{off}");
}

#[test]
fn the_apple_that_moved_is_found_among_those_that_swayed() {
    let mut off = 0.0;
    for seed in 0..40 {
        let mut trial = Trial::new(200 + seed);
        let tree = trial.tree(8);
        let way = trial.normals().normalize() * 0.03;
        let mut after = tree.clone();
        after[3].center += way;
        let sway = trial.normals() * 0.006;
        let frames = [
            trial.answer("a", &tree, &still(-0.4)),
            trial.answer("b", &after, &View { sway, ..still(0.4) }),
        ];
        let fusion = fused(&frames, &exact());
        let moved: Vec<_> = fusion
            .apples
            .iter()
            .filter(|a| a.movement.is_some())
            .collect();
        assert_eq!(moved.len(), 1, "seed {seed}");
        let movement = moved[0].movement.as_ref().unwrap();
        assert_eq!(moved[0].observations[0].pick, 3);
        assert_eq!(movement.frames, [0]);
        let error = (movement.by - way).norm();
        assert!(error < 0.02, "{movement:?}");
        off += error / 40.0;
        assert_eq!(moved[0].observations[0].direction_use, DirectionUse::Stale);
        assert!(moved[0].reason.contains("moved"));
        assert_eq!(fusion.apples.len(), 8);
    }
    assert!(off < 0.007, "{off}");
}

#[test]
fn apples_at_rest_are_called_moved_no_more_often_than_the_rate_says() {
    // At a rate of 1 %, so that it can be counted.
    let config = exact().with(|c| c.moved_rate = 0.01);
    let (mut moved, mut tests) = (0, 0);
    for seed in 0..400 {
        let mut trial = Trial::new(1000 + seed);
        let tree = trial.tree(6);
        let sway = trial.normals() * 0.01;
        let view = View {
            sway,
            pose_sd: (0.002, 0.002),
            ..still(0.4)
        };
        let frames = [
            trial.answer("a", &tree, &still(-0.4)),
            trial.answer("b", &tree, &view),
        ];
        let fusion = fused(&frames, &config);
        tests += tree.len();
        moved += fusion
            .apples
            .iter()
            .filter(|a| a.movement.is_some())
            .count();
    }
    // 24 of 2400 are expected; 40 is three standard deviations more.
    assert!(moved < 40, "{moved} of {tests}");
    // By the default rate, 1 in 1000, the same trials with two frames:
    let default = (0..150).filter(|&seed| {
        let mut trial = Trial::new(1000 + seed);
        let tree = trial.tree(6);
        let sway = trial.normals() * 0.01;
        let frames = [
            trial.answer("a", &tree, &still(-0.4)),
            trial.answer("b", &tree, &View { sway, ..still(0.4) }),
        ];
        let fusion = fused(&frames, &FusionConfig::default());
        fusion.apples.iter().any(|a| a.movement.is_some())
    });
    assert_eq!(default.count(), 0);
}

#[test]
fn apples_of_one_frame_are_kept_and_never_joined_with_their_own() {
    let mut trial = Trial::new(7);
    let tree = trial.tree(6);
    let frames = [
        trial.answer("a", &tree[..4], &still(-0.3)),
        trial.answer("b", &tree[2..], &still(0.3)),
    ];
    let fusion = fused(&frames, &exact());
    let seen: Vec<usize> = fusion.apples.iter().map(|a| a.observations.len()).collect();
    assert_eq!(seen, [1, 1, 2, 2, 1, 1]);
    assert!(fusion.apples[0].reason.contains("seen in 1 frame"));
    // The same position twice in one frame stays two apples.
    let twice = [tree[0], tree[0]];
    let frames = [
        trial.answer("a", &twice, &still(-0.3)),
        trial.answer("b", &tree[..1], &still(0.3)),
    ];
    let fusion = fused(&frames, &exact());
    for apple in &fusion.apples {
        let mut frames: Vec<usize> = apple.observations.iter().map(|s| s.frame).collect();
        frames.dedup();
        assert_eq!(frames.len(), apple.observations.len());
    }
}

#[test]
fn a_direction_that_contradicts_is_dropped_by_name() {
    let mut trial = Trial::new(9);
    let tree = trial.tree(5);
    let mut wrong = tree.clone();
    wrong[1].direction = -wrong[1].direction;
    let frames = [
        trial.answer("a", &tree, &still(-0.4)),
        trial.answer("b", &wrong, &still(0.0)),
        trial.answer("c", &tree, &still(0.4)),
    ];
    let fusion = fused(&frames, &exact());
    let apple = &fusion.apples[1];
    let uses: Vec<_> = apple.observations.iter().map(|s| s.direction_use).collect();
    assert_eq!(
        uses,
        [
            DirectionUse::Used,
            DirectionUse::Outlier,
            DirectionUse::Used
        ]
    );
    assert_eq!(apple.status, FusedStatus::Picked);
    assert!(
        apple.reason.contains("2 of 3 directions agree"),
        "{}",
        apple.reason
    );
    assert!(apple.confidence.unwrap() < fusion.apples[0].confidence.unwrap());
    let two = fused(&frames[..2], &exact());
    assert_eq!(two.apples[1].status, FusedStatus::Contradiction);
    assert!(two.apples[1].direction.is_none());
}

#[test]
fn a_camera_at_rest_shares_its_error_and_the_same_input_gives_the_same_bytes() {
    let mut trial = Trial::new(11);
    let tree = trial.tree(6);
    let (first, pose) = trial.answer("a", &tree, &still(0.0));
    let (second, _) = trial.answer("b", &tree, &still(0.0));
    let mut covariance = Matrix6::zeros();
    covariance.fill_diagonal(0.004_f64.powi(2));
    let pose = RobotFromCamera {
        covariance: Some(covariance),
        ..pose
    };
    let frames = [(first, pose.clone()), (second, pose)];
    let fusion = fused(&frames, &exact());
    let variance = fusion.apples[0].center.covariance_m2.trace() / 3.0;
    assert!(
        variance > 0.004_f64.powi(2),
        "the pose's error does not average out: {variance}"
    );
    let text = |tree: &FusedTree| serde_json::to_string(&FusedRecord::from(tree)).unwrap();
    assert_eq!(text(&fusion), text(&fused(&frames, &exact())));
}

#[test]
fn what_contradicts_itself_is_refused_by_name() {
    let mut trial = Trial::new(13);
    let tree = trial.tree(3);
    let a = trial.answer("a", &tree, &still(-0.3));
    let b = trial.answer("b", &tree, &still(0.3));
    let run = |frames: &[(FrameAnswer, RobotFromCamera)]| {
        let posed: Vec<PosedAnswer> = frames
            .iter()
            .map(|(answer, robot_from_camera)| PosedAnswer::new(answer, robot_from_camera))
            .collect();
        fuse(&posed, &FusionConfig::default()).unwrap_err()
    };
    assert!(matches!(
        run(std::slice::from_ref(&a)),
        FusionError::TooFew { count: 1 }
    ));
    let mut renamed = a.clone();
    renamed.0.id = "c".into();
    for twice in [a.clone(), renamed] {
        let error = run(&[a.clone(), twice]);
        assert!(matches!(error, FusionError::SameFrame { .. }), "{error}");
        assert!(error.to_string().contains("'a'"));
    }
    let mut elsewhere = b.clone();
    elsewhere.1.to = "other_arm".into();
    assert!(
        run(&[a.clone(), elsewhere])
            .to_string()
            .contains("other_arm")
    );
    let mut wrong = b;
    wrong.1.from = "left_camera".into();
    assert!(run(&[a, wrong]).to_string().contains("left_camera"));
}

#[test]
fn frames_without_apples_are_no_error() {
    let mut trial = Trial::new(17);
    let frames = [
        trial.answer("a", &[], &still(-0.3)),
        trial.answer("b", &[], &still(0.3)),
    ];
    assert!(fused(&frames, &exact()).apples.is_empty());
}

#[test]
fn rendered_orchards_from_three_poses() {
    let (mut together, mut single, mut count) = (0.0, 0.0, 0.0);
    let (mut moved, mut answered, mut right) = (0, 0, 0);
    for seed in 0..6 {
        let scene = views(3000 + seed);
        let fusion = fused(&scene.frames, &FusionConfig::default());
        moved += fusion
            .apples
            .iter()
            .filter(|a| a.movement.is_some())
            .count();
        for (truth, true_direction) in scene.centers.iter().zip(&scene.directions) {
            let error = |center: Position<RobotFrame>| (center.point().coords - truth).norm();
            let near = fusion
                .apples
                .iter()
                .filter(|a| a.observations.len() > 1 && error(a.center.position) < 0.03);
            for apple in near {
                let of_frames: Vec<f64> = apple
                    .observations
                    .iter()
                    .map(|s| {
                        let (answer, pose) = &scene.frames[s.frame];
                        let center = answer.apples[s.pick].apple.unwrap().center;
                        error(pose.transform.position(&center))
                    })
                    .collect();
                together += error(apple.center.position);
                single += of_frames.iter().sum::<f64>() / of_frames.len() as f64;
                count += 1.0;
                if let (Some(fused), Some(true_direction)) = (apple.direction, true_direction) {
                    let angle = fused.direction.vector().angle(true_direction);
                    answered += 1;
                    right += usize::from(angle < 20_f64.to_radians());
                }
            }
        }
    }
    assert!(count >= 6.0, "{count}");
    assert!(answered >= 6 && right == answered, "{right} of {answered}");
    assert_eq!(moved, 0);
    assert!(
        together < single,
        "{} mm against {}",
        together / count * 1e3,
        single / count * 1e3
    );
}

#[test]
fn a_position_that_is_hardly_visible_is_a_misfit_and_no_movement() {
    let mut trial = Trial::new(200);
    let tree = trial.tree(8);
    let mut after = tree.clone();
    after[3].center += Vector3::new(0.02, 0.02, 0.0);
    let first = trial.answer("a", &tree, &still(-0.4));
    let mut second = trial.answer("b", &after, &still(0.4));
    second.0.apples[3].apple.as_mut().unwrap().visible_share = Some(0.1);
    let fusion = fused(&[first, second], &exact());
    assert_eq!(fusion.apples.len(), 8);
    let apple = &fusion.apples[3];
    assert!(
        apple.movement.is_none() && apple.reason.contains("misfit"),
        "{}",
        apple.reason
    );
    assert_eq!(apple.observations[1].position_use, PositionUse::Misfit);
    assert!((apple.center.position.point().coords - tree[3].center).norm() < 0.012);
}
