//! Boxes that hold no apple are refused or doubted, those of apples are answered as without the check.

use crate::answers::{answer, picker};
use pomona::record::PicksRecord;
use pomona::{CheckedFrame, Config, Method, Picker, Status, find_apples};
use pomona_cloud::{ColorImage, Frame, PixelBox};
use pomona_detect::{DetectError, Detection, Detector, DetectorReport};
use pomona_scenes::{AppleTruth, Scene, Suite};

/// Confidence from which an answer is acted on.
const SURE: f64 = 0.5;

/// Share of an apple that shows, from which nothing else is fitted in its place.
const WELL_SEEN: f64 = 0.6;

/// Boxes on a grid over the whole frame, of `scale` times the first box's size, that touch none of its boxes.
fn grid(frame: &Frame, scale: f64) -> Vec<PixelBox> {
    let own = frame.boxes.as_ref().unwrap();
    let (w, h) = (scale * own[0].width(), scale * own[0].height());
    let (columns, rows) = (frame.color.width as f64 / w, frame.color.height as f64 / h);
    let mut boxes = Vec::new();
    for row in 0..(2.0 * rows) as usize - 1 {
        for column in 0..(2.0 * columns) as usize - 1 {
            let (x, y) = (0.5 * w * column as f64, 0.5 * h * row as f64);
            let apart =
                |b: &PixelBox| x + w < b.x_min || x > b.x_max || y + h < b.y_min || y > b.y_max;
            if own.iter().all(apart) {
                boxes.push(PixelBox {
                    name: boxes.len().to_string(),
                    x_min: x,
                    y_min: y,
                    x_max: x + w,
                    y_max: y + h,
                    score: 1.0,
                });
            }
        }
    }
    boxes
}

fn with_boxes(frame: &Frame, boxes: Vec<PixelBox>) -> Frame {
    let mut frame = frame.clone();
    frame.boxes = Some(boxes);
    frame
}

fn unchecked() -> Picker {
    Picker::new(Config::default().with(|c| c.robust.check_boxes = false)).unwrap()
}

fn scene(suite: Suite, seed: usize) -> Scene {
    suite.cases_to(seed + 1).nth(seed).unwrap().scene()
}

/// How many boxes have an answer of at least [`SURE`].
fn sure(picker: &Picker, frame: &Frame) -> usize {
    let answer = answer(picker, frame, 0);
    let of = |a: &&pomona::AppleAnswer| a.is_picked() && a.confidence.unwrap() >= SURE;
    answer.apples.iter().filter(of).count()
}

#[test]
fn nineteen_of_twenty_boxes_on_leaves_and_branches_are_refused_or_doubted() {
    let (with, without) = (picker(Method::Robust), unchecked());
    let (mut boxes, mut before, mut after) = (0, 0, 0);
    for scene in [
        scene(Suite::Demo, 0),
        scene(Suite::Orchard, 7000),
        scene(Suite::Row, 7000),
        scene(Suite::Dense, 7000),
    ] {
        for scale in [0.7, 1.2] {
            let frame = with_boxes(&scene.frame, grid(&scene.frame, scale));
            boxes += frame.boxes.as_ref().unwrap().len();
            before += sure(&without, &frame);
            after += sure(&with, &frame);
        }
    }
    assert!(boxes > 300 && before > boxes / 10, "{before} of {boxes}");
    assert!(20 * after <= before, "{after} of {before} are left");
}

#[test]
fn apples_keep_their_picks_with_their_confidence() {
    let (with, without) = (picker(Method::Robust), unchecked());
    for scene in [scene(Suite::Demo, 0), scene(Suite::Row, 7000)] {
        let checked = answer(&with, &scene.frame, 0);
        let taken = answer(&without, &scene.frame, 0);
        let mut kept = 0;
        for (a, b) in checked.apples.iter().zip(&taken.apples) {
            let of_it = |apple: &&AppleTruth| apple.bounds.name == a.bounds.name;
            let truth = scene.truth.apples.iter().find(of_it).unwrap();
            // What is mostly hidden may be fitted to the leaf before it, and is then no apple.
            if !b.is_picked() || truth.visible_share.unwrap_or(1.0) < WELL_SEEN {
                continue;
            }
            kept += 1;
            assert_eq!((a.status, a.pick), (b.status, b.pick));
            let (presence, stated) = (a.presence.unwrap(), b.confidence.unwrap());
            assert!(presence > 0.9 && b.presence.is_none(), "{presence}");
            assert_eq!(a.confidence, Some(stated.min(presence)));
        }
        assert!(kept >= 8, "{kept} apples");
    }
}

#[test]
fn without_colours_depth_alone_decides() {
    let scene = scene(Suite::Demo, 0);
    let mut grey = scene.frame.clone();
    grey.color = ColorImage::filled(grey.color.width, grey.color.height, [0; 3]);
    let robust = picker(Method::Robust);
    let (colored, dark) = (answer(&robust, &scene.frame, 0), answer(&robust, &grey, 0));
    for (a, b) in colored.apples.iter().zip(&dark.apples) {
        assert_eq!((a.status, a.pick), (b.status, b.pick));
        assert!(a.presence >= b.presence, "colour speaks for apples only");
    }
    let empty = with_boxes(&grey, grid(&grey, 1.0));
    assert!(20 * sure(&robust, &empty) <= empty.boxes.unwrap().len());
}

#[test]
fn the_published_method_does_not_check() {
    let frame = scene(Suite::Demo, 0).frame;
    let empty = with_boxes(&frame, grid(&frame, 1.0));
    let text = |check: bool| {
        let config = Config::default().with(|c| {
            c.method = Method::Paper;
            c.robust.check_boxes = check;
        });
        let answer = answer(&Picker::new(config).unwrap(), &empty, 0);
        serde_json::to_string(&PicksRecord::from(&answer).without_timing()).unwrap()
    };
    assert_eq!(text(true), text(false));
}

#[test]
fn a_refused_box_has_no_apple_in_the_record() {
    let frame = scene(Suite::Demo, 0).frame;
    let empty = with_boxes(&frame, grid(&frame, 1.0));
    let answer = answer(&picker(Method::Robust), &empty, 0);
    let mut refused = answer.apples.iter().filter(|a| a.status == Status::NoApple);
    let refused = refused.next().unwrap();
    assert!(refused.presence.unwrap() < 0.5);
    assert!(refused.apple.is_none() && refused.fallback.is_none() && refused.pick.is_none());
}

/// A detector that sees these boxes.
struct Sees(Vec<PixelBox>);

impl Detector for Sees {
    fn detect(&self, _: &ColorImage) -> Result<Vec<Detection>, DetectError> {
        let seen = self.0.iter().map(|b| Detection {
            x_min: b.x_min,
            y_min: b.y_min,
            x_max: b.x_max,
            y_max: b.y_max,
            score: 0.9,
            class: 0,
        });
        Ok(seen.collect())
    }

    fn report(&self) -> DetectorReport {
        DetectorReport::new("fixed")
    }
}

#[test]
fn boxes_that_depth_marks_are_picked_where_the_settings_ask_for_it() {
    let frame = scene(Suite::Demo, 0).frame;
    let detector = Sees(grid(&frame, 1.0));
    let config = Config::default().with(|c| c.detection.pick_marked = true);
    let frame = CheckedFrame::new(&frame).unwrap();
    let detected = find_apples(&frame, &detector, &config).unwrap();
    let picker = Picker::new(config).unwrap();
    let answer = picker.pick_detected(&frame, &detected, 0, None).unwrap();
    let marked = answer
        .apples
        .iter()
        .filter(|a| a.origin.unwrap().mark.refuses());
    let picked = marked.filter(|a| a.is_picked());
    assert!(picked.count() > 5);
}
