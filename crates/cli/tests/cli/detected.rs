//! Frames without boxes: the built-in model detects the apples, and all that follows works on them.

use crate::binary::pomona;
use crate::schema::Schema;
use nalgebra::Vector3;
use pomona::Status;
use pomona::record::{BoxRecord, PickRecord, PicksRecord};
use pomona_cloud::PixelBox;
use pomona_scenes::{AppleTruth, Truth};
use std::path::{Path, PathBuf};
use tempfile::TempDir;

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../fixtures/frames")
        .join(name)
}

fn demo() -> PathBuf {
    fixture("orchard-demo")
}

/// A copy of the demo frame without its boxes, in a folder of its own.
fn without_boxes() -> TempDir {
    let dir = tempfile::tempdir().unwrap();
    let copy = dir.path().join("orchard-demo");
    std::fs::create_dir(&copy).unwrap();
    for name in ["color.png", "depth.png", "camera.json"] {
        std::fs::copy(demo().join(name), copy.join(name)).unwrap();
    }
    dir
}

fn overlap(a: &PixelBox, b: &BoxRecord) -> f64 {
    let width = (a.x_max.min(b.x_max) - a.x_min.max(b.x_min)).max(0.0);
    let height = (a.y_max.min(b.y_max) - a.y_min.max(b.y_min)).max(0.0);
    let both = width * height;
    both / (a.width() * a.height() + (b.x_max - b.x_min) * (b.y_max - b.y_min) - both)
}

/// The pick whose box is an apple's.
fn pick_of<'a>(apple: &AppleTruth, record: &'a PicksRecord) -> Option<&'a PickRecord> {
    let same = |p: &&PickRecord| overlap(&apple.bounds, &p.pixel_box) >= 0.5;
    record.picks.iter().find(same)
}

/// The README's first command. Of the 22 apples one lies at the lower edge, mostly cut off; a direction beyond 20° is
/// what the confidence counts as wrong.
#[test]
fn the_row_is_detected_and_picked_towards_its_branches() {
    let dir = tempfile::tempdir().unwrap();
    let (frame, out) = (fixture("row-demo"), dir.path().join("out"));
    let (frame, out) = (frame.to_str().unwrap(), out.to_str().unwrap());
    let run = pomona(&[
        "pick",
        frame,
        "--out",
        out,
        "--json",
        "--runtime",
        "embedded",
    ])
    .succeeded();
    let record: PicksRecord = serde_json::from_value(run.json()).unwrap();
    let truth = Truth::read(fixture("row-demo")).unwrap().apples;
    assert_eq!(truth.len(), 22);
    let found: Vec<_> = truth
        .iter()
        .filter_map(|apple| Some((apple, pick_of(apple, &record)?)))
        .collect();
    assert!(found.len() >= 21, "{} found", found.len());
    let right = found.iter().filter(|(apple, pick)| {
        let pair = pick.direction.zip(apple.direction);
        pair.is_some_and(|(a, b)| Vector3::from(a).angle(&Vector3::from(b)) <= 20_f64.to_radians())
    });
    let right = right.count();
    assert!(right >= 20, "{right} right");
}

#[test]
fn a_frame_without_boxes_is_detected_and_picked() {
    let dir = without_boxes();
    let frame = dir.path().join("orchard-demo");
    let out = dir.path().join("out");
    let (frame, out) = (frame.to_str().unwrap(), out.to_str().unwrap());
    let arguments = [
        "pick",
        frame,
        "--out",
        out,
        "--json",
        "--runtime",
        "embedded",
    ];
    let run = pomona(&arguments).succeeded();
    let value = run.json();
    Schema::read("picks.schema.json").accepts(&value);
    let record: PicksRecord = serde_json::from_value(value).unwrap();
    let detection = record.detection.as_ref().unwrap();
    assert_eq!(detection.runtime.as_deref(), Some("embedded"));

    let truth = Truth::read(demo()).unwrap().apples;
    let picks = truth.iter().filter_map(|apple| pick_of(apple, &record));
    assert_eq!(picks.count(), truth.len());
    assert!(record.picks.iter().any(|p| p.status == Status::Picked));
    assert!(dir.path().join("out/picture.png").is_file());

    // The same again: whatever the number of threads, the same answers.
    let again = pomona(&[&arguments[..], &["--threads", "1"]].concat()).succeeded();
    let again: PicksRecord = serde_json::from_value(again.json()).unwrap();
    assert_eq!(again.without_timing(), record.without_timing());

    let table = pomona(&["pick", frame, "--out", out, "--runtime", "embedded"]).succeeded();
    assert!(
        table.out.contains("mark") && table.out.contains("detection"),
        "{}",
        table.out
    );
}
