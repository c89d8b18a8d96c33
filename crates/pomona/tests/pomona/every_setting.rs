//! No setting without a reader: each is moved off its default, and an answer changes or is refused.

use crate::robot::transform;
use pomona::record::PicksRecord;
use pomona::{
    ApproachConfig, CheckedFrame, Config, FallbackKind, Method, Picker, Robot, find_apples,
};
use pomona_cloud::{ColorImage, Frame, PixelBox};
use pomona_detect::{DetectError, Detection, Detector, DetectorReport};
use pomona_scenes::{Scene, Suite, Truth};
use pomona_settings::readers::{Situation, unread};
use std::path::Path;

fn lab() -> Scene {
    let mut cases = Suite::Lab15.cases();
    cases.find(|c| c.name.ends_with("-x0-s0")).unwrap().scene()
}

/// How many apples of it are looked at.
const APPLES: usize = 5;

/// A small orchard of the fixtures: apples with leaves about them, of which some are hidden.
fn orchard() -> (Frame, Truth) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/frames/orchard-demo");
    let (mut frame, mut truth) = (Frame::read(&folder).unwrap(), Truth::read(folder).unwrap());
    // Enough for every setting, and quick.
    frame.boxes.as_mut().unwrap().truncate(APPLES);
    truth.apples.truncate(APPLES);
    (frame, truth)
}

fn text(record: PicksRecord) -> String {
    serde_json::to_string(&record.without_timing()).unwrap()
}

fn picked(frame: &Frame, config: &Config) -> String {
    let picker = Picker::new(config.clone()).unwrap();
    let frame = CheckedFrame::new(frame).unwrap();
    text(PicksRecord::from(&picker.pick(&frame, 0, None).unwrap()))
}

/// A detector that sees these boxes.
struct Sees(Vec<Detection>);

impl Sees {
    /// All apples but the last one, the first one twice, and a box about half of the image.
    fn of(truth: &Truth, frame: &Frame) -> Self {
        let (_, most) = truth.apples.split_last().unwrap();
        let mut all: Vec<Detection> = most.iter().map(|a| detection(&a.bounds)).collect();
        let first = all[0];
        let shift = 0.2 * (first.x_max - first.x_min);
        all.push(Detection {
            x_min: first.x_min + shift,
            x_max: first.x_max + shift,
            score: 0.8,
            ..first
        });
        all.push(Detection {
            x_min: 0.0,
            y_min: 0.0,
            x_max: 0.5 * frame.color.width as f64,
            y_max: 0.5 * frame.color.height as f64,
            score: 0.5,
            class: 0,
        });
        Self(all)
    }
}

fn detection(bounds: &PixelBox) -> Detection {
    Detection {
        x_min: bounds.x_min,
        y_min: bounds.y_min,
        x_max: bounds.x_max,
        y_max: bounds.y_max,
        score: 0.9,
        class: 0,
    }
}

impl Detector for Sees {
    fn detect(&self, _: &ColorImage) -> Result<Vec<Detection>, DetectError> {
        Ok(self.0.clone())
    }

    fn report(&self) -> DetectorReport {
        DetectorReport::default()
    }
}

fn detected(frame: &Frame, detector: &Sees, config: &Config) -> String {
    let frame = CheckedFrame::new(frame).unwrap();
    let found = find_apples(&frame, detector, config).unwrap();
    let picker = Picker::new(config.clone()).unwrap();
    let answer = picker.pick_detected(&frame, &found, 0, None).unwrap();
    text(PicksRecord::from(&answer))
}

#[test]
fn every_setting_of_picking_has_a_reader() {
    let with = |change: fn(&mut Config)| Config::default().with(change);
    let on = |frame: Frame| move |config: &Config| picked(&frame, config);
    let found = || {
        let (frame, truth) = orchard();
        let detector = Sees::of(&truth, &frame);
        move |config: &Config| detected(&frame, &detector, config)
    };
    let paper = || with(|c| c.method = Method::Paper);
    let refused = with(|c| {
        c.robust.least_confidence = 1.0;
        c.fallback.kind = FallbackKind::None;
    });
    let searched = with(|c| c.detection.depth_search = true);
    let situations = [
        Situation::new(paper(), on(lab().frame)).about(&["paper", "fruit"]),
        Situation::new(paper(), on(orchard().0)).about(&["paper"]),
        Situation::new(refused, on(lab().frame)).about(&["robust", "fallback"]),
        Situation::new(with(|_| {}), on(lab().frame)).about(&["method", "robust", "fruit"]),
        Situation::new(with(|_| {}), found()).about(&["detection"]),
        Situation::new(searched, found()).about(&["detection"]),
        Situation::new(with(|_| {}), on(orchard().0)).about(&["robust", "fallback"]),
    ];
    // The lab's branch passes at 1.3 radii, and the orchard's sphere is found by few of its iterations.
    let special = [
        ("paper.line_distance_min", "1.45"),
        ("paper.line_iterations", "1"),
    ];
    // Fusion is asked about by `pomona-fusion`.
    let unread = unread(&situations, &special, |path| !path.starts_with("fusion"));
    assert!(unread.is_empty(), "{unread:?} change nothing");
}

/// What a robot plans for the answers to a frame, which do not depend on the robot's settings.
fn planned(
    frame: &Frame,
    method: Method,
    base: impl FnOnce(&mut ApproachConfig),
) -> Situation<'_, ApproachConfig> {
    let picker = Picker::new(Config::default().with(|c| c.method = method)).unwrap();
    let frame = CheckedFrame::new(frame).unwrap();
    let transform = transform();
    let picked = picker.pick(&frame, 0, Some(&transform)).unwrap();
    let mut settings = ApproachConfig::default();
    base(&mut settings);
    Situation::new(settings, move |config: &ApproachConfig| {
        let mut answer = picked.clone();
        let robot = Robot::new(config.clone()).unwrap();
        robot.plan(&frame, &mut answer, &transform);
        text(PicksRecord::from(&answer))
    })
}

#[test]
fn every_setting_of_the_robot_has_a_reader() {
    let (lab, orchard) = (lab().frame, orchard().0);
    // The lab's rig stands beside its apple: between leaves one brushes through.
    let brushing = |c: &mut ApproachConfig| c.clearance.cloud_margin_m = -0.05;
    let turning = |c: &mut ApproachConfig| {
        c.clearance.cloud_margin_m = -0.05;
        c.search.roll = pomona_approach::Roll::Free;
    };
    // So short a straight that the pre-grasp depends on the margins.
    let near = |c: &mut ApproachConfig| {
        c.clearance.cloud_margin_m = -0.05;
        c.motion.standoff_m = 0.001;
    };
    let situations = [
        planned(&lab, Method::Robust, brushing),
        planned(&lab, Method::Robust, |_| {}),
        planned(&lab, Method::Robust, near),
        planned(&lab, Method::Robust, turning),
        planned(&lab, Method::Paper, brushing),
        planned(&orchard, Method::Robust, |_| {}),
        planned(&orchard, Method::Paper, |_| {}),
    ];
    let special = [
        ("gripper.tool_axis", "[0.0, 0.0, 1.0]"),
        ("gripper.tcp_from_flange_translation_m", "[0.0, 0.0, -0.2]"),
        (
            "gripper.tcp_from_flange_quaternion_xyzw",
            "[0.0, 0.0, 1.0, 0.0]",
        ),
        ("reach.shoulder_m", "[5.0, 0.0, 0.0]"),
        ("reach.shell_inner_m", "1.0"),
        ("reach.box_min_m", "[0.6, -10.0, -10.0]"),
        ("reach.box_max_m", "[0.6, 10.0, 10.0]"),
        ("motion.start_quaternion_xyzw", "[0.0, 0.0, 1.0, 0.0]"),
    ];
    // What matters far from the apple is asked about by `pomona-approach`.
    let elsewhere = ["clearance.region_m", "search.detour_m"];
    let unread = unread(&situations, &special, |path| !elsewhere.contains(&path));
    assert!(unread.is_empty(), "{unread:?} change nothing");
}
