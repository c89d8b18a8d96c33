//! A published network on real frames, where the folder with both is there.

#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

use pomona_cloud::{Frame, PixelBox};
use pomona_detect::{ClassChoice, Detection, DetectorOptions, RuntimeChoice, TilingChoice};
use std::path::{Path, PathBuf};

fn shared(path: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../../shared")
        .join(path);
    if !path.exists() {
        println!("skipped: {} is not here", path.display());
    }
    path.exists().then_some(path)
}

/// How many boxes have a detection of their own at an `IoU` of at least 0.5, the best detections choosing first.
fn matched(boxes: &[PixelBox], found: &[Detection]) -> usize {
    let mut free: Vec<Detection> = boxes
        .iter()
        .map(|b| Detection {
            x_min: b.x_min,
            y_min: b.y_min,
            x_max: b.x_max,
            y_max: b.y_max,
            score: 1.0,
            class: 0,
        })
        .collect();
    let before = free.len();
    for detection in found {
        let best = (0..free.len())
            .max_by(|&a, &b| detection.iou(&free[a]).total_cmp(&detection.iou(&free[b])));
        if let Some(best) = best.filter(|&k| detection.iou(&free[k]) >= 0.5) {
            free.swap_remove(best);
        }
    }
    before - free.len()
}

/// The file carries neither names nor a description: its family is told from its outputs, and the apple is COCO's.
#[test]
fn tiles_find_the_small_apples_that_the_whole_image_hides() {
    let (Some(model), Some(frames)) = (shared("models/yolox_nano_coco.onnx"), shared("frames"))
    else {
        return;
    };
    let open = |tiling| {
        let options = DetectorOptions {
            model: Some(model.clone()),
            runtime: RuntimeChoice::Embedded,
            class: Some(ClassChoice::Name("apple".to_owned())),
            threshold: Some(0.1),
            tiling,
            ..DetectorOptions::default()
        };
        options.open().unwrap()
    };
    let (whole, tiled) = (open(TilingChoice::Whole), open(TilingChoice::Automatic));
    assert_eq!(tiled.report().family.as_deref(), Some("yolox"));
    for name in ["orchard-1218", "orchard-1235"] {
        let frame = Frame::read(frames.join(name)).unwrap();
        let mut boxes = frame.boxes.unwrap();
        boxes.retain(|b| !b.name.starts_with("BALL"));
        let counts = [&whole, &tiled].map(|detector| {
            let found = detector.detect(&frame.color).unwrap();
            (matched(&boxes, &found), found.len())
        });
        println!(
            "{name}: of {} boxes and by so many detections, whole and tiled: {counts:?}",
            boxes.len()
        );
    }
}
