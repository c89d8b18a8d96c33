//! No setting without a reader: each is moved off its default, and an answer changes or is refused.

use crate::robot::transform;
use pomona::record::PicksRecord;
use pomona::{
    ApproachConfig, CheckedFrame, Config, FallbackKind, Method, Picker, Robot, find_apples,
};
use pomona_cloud::{ColorImage, Frame, PixelBox};
use pomona_detect::{DetectError, Detection, Detector};
use pomona_scenes::{Scene, Suite, Truth};
use pomona_settings::{Description, Setting, Settings, set};
use std::path::Path;

/// A scene, and the settings that stand beside the one that is moved.
struct Situation<T> {
    name: &'static str,
    /// Settings by which it differs from the defaults.
    beside: fn(&mut T),
    /// All that is answered, as text.
    answer: Box<dyn Fn(&T) -> String>,
}

impl<T: Settings> Situation<T> {
    fn base(&self) -> T {
        let mut settings = T::default();
        (self.beside)(&mut settings);
        settings
    }

    /// Whether some value of the setting changes the answer.
    fn shows(&self, setting: &Setting, usual: &str) -> bool {
        let base = self.base();
        let changed = |value| {
            let settings = set(&base, &setting.path, value).unwrap();
            let sound = settings.check("").is_ok();
            sound && (self.answer)(&settings) != usual
        };
        let special = SPECIAL.iter().filter(|(path, _)| *path == setting.path);
        let special = special.map(|(_, value)| value.parse().unwrap());
        special.chain(setting.other_values()).any(changed)
    }
}

/// Values for settings that scaling alone would not move.
const SPECIAL: &[(&str, &str)] = &[
    ("gripper.tool_axis", "[0.0, 0.0, 1.0]"),
    ("gripper.tcp_from_flange_translation_m", "[0.0, 0.0, -0.2]"),
    (
        "gripper.tcp_from_flange_quaternion_xyzw",
        "[0.0, 0.0, 1.0, 0.0]",
    ),
    ("reach.shoulder_m", "[0.0, 0.0, 0.3]"),
    ("reach.box_min_m", "[0.6, -10.0, -10.0]"),
    ("reach.box_max_m", "[0.6, 10.0, 10.0]"),
    ("motion.start_quaternion_xyzw", "[0.0, 0.0, 1.0, 0.0]"),
];

/// The paths of those settings that no situation shows. Each is tried in the situations until one shows it.
fn unread<T: Settings>(situations: &[Situation<T>], apart: &str) -> Vec<String> {
    let usual: Vec<String> = situations.iter().map(|s| (s.answer)(&s.base())).collect();
    let settings = Description::of::<T>().settings;
    let of_others = |setting: &Setting| setting.section_and_name().0 == apart;
    settings
        .iter()
        .filter(|setting| !of_others(setting))
        .filter(|setting| {
            let mut all = situations.iter().zip(&usual);
            !all.any(|(situation, usual)| situation.shows(setting, usual))
        })
        .map(|setting| setting.path.clone())
        .collect()
}

fn lab() -> Scene {
    let mut cases = Suite::Lab15.cases();
    cases.find(|c| c.name.ends_with("-x0-s0")).unwrap().scene()
}

/// A small orchard of the fixtures: apples with leaves about them, of which some are hidden.
fn orchard() -> (Frame, Truth) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/frames/orchard-demo");
    (Frame::read(&folder).unwrap(), Truth::read(folder).unwrap())
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
    let boxed = |name, beside, frame: Frame| Situation {
        name,
        beside,
        answer: Box::new(move |config: &Config| picked(&frame, config)),
    };
    let found = |name, beside| {
        let (frame, truth) = orchard();
        let detector = Sees::of(&truth, &frame);
        Situation {
            name,
            beside,
            answer: Box::new(move |config: &Config| detected(&frame, &detector, config)),
        }
    };
    let situations = [
        boxed("a lab apple", |_| {}, lab().frame),
        boxed("the same, paper", |c| c.method = Method::Paper, lab().frame),
        boxed("an orchard", |_| {}, orchard().0),
        boxed(
            "a refused apple",
            |c| {
                c.robust.least_confidence = 1.0;
                c.fallback.kind = FallbackKind::None;
            },
            lab().frame,
        ),
        found("an orchard, detected", |_| {}),
        found("the same, searched", |c| c.detection.depth_search = true),
    ];
    let unread = unread(&situations, "fusion");
    let names = situations.map(|s| s.name);
    assert!(unread.is_empty(), "{unread:?} change nothing in {names:?}");
}

fn planned(frame: &Frame, method: Method, config: &ApproachConfig) -> String {
    let picker = Picker::new(Config::default().with(|c| c.method = method)).unwrap();
    let frame = CheckedFrame::new(frame).unwrap();
    let transform = transform();
    let mut answer = picker.pick(&frame, 0, Some(&transform)).unwrap();
    let robot = Robot::new(config.clone()).unwrap();
    robot.plan(&frame, &mut answer, &transform);
    text(PicksRecord::from(&answer))
}

#[test]
fn every_setting_of_the_robot_has_a_reader() {
    let of = |name, beside, frame: Frame, method| Situation {
        name,
        beside,
        answer: Box::new(move |config: &ApproachConfig| planned(&frame, method, config)),
    };
    // The lab's rig stands beside its apple: between leaves one brushes through.
    let brushing = |c: &mut ApproachConfig| c.clearance.cloud_margin_m = -0.05;
    let turning = |c: &mut ApproachConfig| {
        c.clearance.cloud_margin_m = -0.05;
        c.search.roll = pomona_approach::Roll::Free;
    };
    let situations = [
        of("a free apple", brushing, lab().frame, Method::Robust),
        of("an apple in the way", |_| {}, lab().frame, Method::Robust),
        of("any roll", turning, lab().frame, Method::Robust),
        of("paper", brushing, lab().frame, Method::Paper),
        of("an orchard", |_| {}, orchard().0, Method::Robust),
        of("an orchard, paper", |_| {}, orchard().0, Method::Paper),
    ];
    let unread = unread(&situations, "");
    let names = situations.map(|s| s.name);
    assert!(unread.is_empty(), "{unread:?} change nothing in {names:?}");
}
