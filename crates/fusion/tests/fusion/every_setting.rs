//! No setting without a reader: each is moved off its default, and an answer changes.

use crate::drawn_tree::{Trial, View, still};
use nalgebra::{Isometry3, Vector3};
use pomona::{CheckedFrame, FrameAnswer, RobotFromCamera};
use pomona_fusion::{FusedCloud, FusedRecord, FusionConfig, PosedAnswer, fuse};
use pomona_scenes::Suite;
use pomona_settings::readers::{Situation, unread};
use pomona_transforms::Transform;

type Posed = (FrameAnswer, RobotFromCamera);

/// Three frames of a tree that sways, one of whose apples has moved, hardly seen, and two of which are answered
/// differently in one frame.
fn trial(seed: u64) -> Vec<Posed> {
    let mut trial = Trial::new(seed);
    let tree = trial.tree(6);
    let mut after = tree.clone();
    after[3].center += trial.normals().normalize() * 0.03;
    after[4].center += Vector3::new(0.02, 0.02, 0.0);
    after[1].direction = -after[1].direction;
    after[2].direction = (after[2].direction + trial.normals() * 0.15).normalize();
    let sway = trial.normals() * 0.006;
    let moved = View { sway, ..still(0.3) };
    let mut second = trial.answer("b", &after, &moved);
    second.0.apples[4].apple.as_mut().unwrap().visible_share = Some(0.2);
    vec![
        trial.answer("a", &tree, &still(-0.3)),
        second,
        trial.answer("c", &tree, &still(0.1)),
    ]
}

/// The same as a method that states no errors would answer it.
fn without_errors(mut frames: Vec<Posed>) -> Vec<Posed> {
    for apple in frames.iter_mut().flat_map(|f| &mut f.0.apples) {
        let fitted = apple.apple.as_mut().unwrap();
        (fitted.center_covariance, fitted.radius_sd_m) = (None, None);
        apple.pick.as_mut().unwrap().sd_rad = None;
        apple.confidence = None;
    }
    frames
}

fn fused(trials: &[Vec<Posed>], config: &FusionConfig) -> String {
    let one = |frames: &Vec<Posed>| {
        let posed: Vec<PosedAnswer> = frames.iter().map(|(a, p)| PosedAnswer::new(a, p)).collect();
        let tree = fuse(&posed, config).unwrap();
        serde_json::to_string(&FusedRecord::from(&tree)).unwrap()
    };
    trials.iter().map(one).collect()
}

#[test]
fn every_setting_of_fusion_has_a_reader() {
    let trials: Vec<_> = (0..12).map(trial).collect();
    let silent: Vec<_> = (0..12).map(trial).map(without_errors).collect();
    let scene = Suite::Lab15.cases().next().unwrap().scene();
    let joined = |config: &FusionConfig| {
        let frame = CheckedFrame::new(&scene.frame).unwrap();
        let still = Transform::from_isometry(&Isometry3::identity()).unwrap();
        let pose = RobotFromCamera::new(still, "base_link", "camera_color_optical_frame");
        let mut cloud = FusedCloud::new(config.voxel_m);
        cloud
            .add(frame.frame(), &pose, &Isometry3::identity())
            .unwrap();
        cloud.cloud().len().to_string()
    };
    let situations = [
        Situation::new(FusionConfig::default(), |c| fused(&trials, c)),
        Situation::new(FusionConfig::default(), |c| fused(&silent, c)),
        Situation::new(FusionConfig::default(), joined).about(&["voxel_m"]),
    ];
    let unread = unread(&situations, &[], |_| true);
    assert!(unread.is_empty(), "{unread:?} change nothing");
}
