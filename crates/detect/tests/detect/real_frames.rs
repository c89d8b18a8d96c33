//! A published network on real frames, where the folder with both is there.

use crate::shared::shared;
use pomona_cloud::{ColorImage, Frame, PixelBox};
use pomona_detect::{ClassChoice, Detection, DetectorOptions, RuntimeChoice, TilingChoice};
use std::path::Path;

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

/// The boxes of the apples that people labelled, and the image.
fn frame(frames: &Path, name: &str) -> (Vec<PixelBox>, ColorImage) {
    let frame = Frame::read(frames.join(name)).unwrap();
    let mut boxes = frame.boxes.unwrap();
    boxes.retain(|b| !b.name.starts_with("BALL"));
    (boxes, frame.color)
}

/// The file carries neither names nor a description: its family is told from its outputs, and the apple is COCO's.
#[test]
fn tiles_find_the_small_apples_that_the_whole_image_hides() {
    let (Some(model), Some(frames)) = (shared("models/yolox_nano_coco.onnx"), shared("frames"))
    else {
        return;
    };
    let open = |tiling| {
        let options = DetectorOptions::default().with(|o| {
            o.model = Some(model.clone());
            o.runtime = RuntimeChoice::Embedded;
            o.class = Some(ClassChoice::Name("apple".to_owned()));
            o.threshold = Some(0.1);
            o.tiling = tiling;
        });
        options.open().unwrap()
    };
    let (whole, tiled) = (open(TilingChoice::Whole), open(TilingChoice::Automatic));
    assert_eq!(tiled.report().family.as_deref(), Some("yolox"));
    for name in ["orchard-1218", "orchard-1235"] {
        let (boxes, image) = frame(&frames, name);
        let [in_whole, in_tiles] = [&whole, &tiled].map(|detector| {
            let found = detector.detect(&image).unwrap();
            let matched = matched(&boxes, &found);
            println!(
                "{name}: {matched} of {} by {} boxes",
                boxes.len(),
                found.len()
            );
            matched
        });
        // Measured: 7 and 5 on the whole image, 22 and 22 tiled.
        assert!(in_whole <= 10, "{in_whole}");
        assert!(in_tiles >= 21, "{in_tiles}");
    }
}

#[test]
fn the_built_in_model_on_real_frames() {
    let Some(frames) = shared("frames") else {
        return;
    };
    let options = DetectorOptions::default().with(|o| o.runtime = RuntimeChoice::Embedded);
    let detector = options.open().unwrap();
    for name in ["orchard-1218", "orchard-1235"] {
        let (boxes, image) = frame(&frames, name);
        let found = detector.detect(&image).unwrap();
        let matched = matched(&boxes, &found);
        println!(
            "{name}: {matched} of {} by {} boxes",
            boxes.len(),
            found.len()
        );
        // Measured: 25 and 25, by 204 and 198 boxes.
        assert!(matched >= 24, "{matched}");
    }
}
