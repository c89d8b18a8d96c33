//! Both runtimes find the same boxes, whatever the network: IoU at least 0.99, scores within 1e-3.

use crate::onnx;
use crate::shared::shared;
use pomona_cloud::ColorImage;
use pomona_detect::{
    ClassChoice, Detection, Detector, DetectorOptions, RuntimeChoice, TilingChoice,
};
use std::path::{Path, PathBuf};

/// Largest difference between the scores of one box.
const SCORE: f64 = 1e-3;

/// Lowest score that counts here: low, so that there are many boxes.
const THRESHOLD: f64 = 0.1;

/// The inference backends that this machine has; says so where ONNX Runtime is not among them.
fn runtimes() -> Vec<RuntimeChoice> {
    let mut choices = vec![RuntimeChoice::Embedded];
    if has_onnx_runtime() {
        choices.push(RuntimeChoice::OnnxRuntime);
    }
    choices
}

/// Whether ONNX Runtime can be used here; prints why not.
fn has_onnx_runtime() -> bool {
    let options = DetectorOptions::default().with(|o| o.runtime = RuntimeChoice::OnnxRuntime);
    let opened = options.open();
    if let Err(error) = &opened {
        println!("skipped for ONNX Runtime: {error}");
    }
    opened.is_ok()
}

fn detectors(model: &Path, class: Option<usize>, tiling: TilingChoice) -> Vec<Box<dyn Detector>> {
    let open = |runtime| {
        let options = DetectorOptions::default().with(|o| {
            o.model = Some(model.to_owned());
            o.runtime = runtime;
            o.class = class.map(ClassChoice::Number);
            o.threshold = Some(THRESHOLD);
            o.tiling = tiling;
        });
        options.open().unwrap()
    };
    runtimes().into_iter().map(open).collect()
}

/// Every box of one has its like in the other, unless it just reached the threshold.
fn assert_held(ours: &[Detection], theirs: &[Detection]) {
    for one in ours.iter().filter(|one| one.score > THRESHOLD + SCORE) {
        let like = |other: &&Detection| {
            one.class == other.class
                && one.iou(other) >= 0.99
                && (one.score - other.score).abs() <= SCORE
        };
        assert!(
            theirs.iter().any(|other| like(&other)),
            "nothing like {one:?}"
        );
    }
}

/// How many boxes both runtimes find, the same ones; `None` where there are not two.
fn boxes(detectors: &[Box<dyn Detector>], image: &ColorImage) -> Option<usize> {
    let [one, other] = detectors else { return None };
    let (one, other) = (one.detect(image).unwrap(), other.detect(image).unwrap());
    assert_held(&one, &other);
    assert_held(&other, &one);
    Some(one.len())
}

/// An image of soft blobs in many colours.
fn blobs(width: usize, height: usize) -> ColorImage {
    let mut noise = onnx::Noise(9);
    let mut draw = |most: f32| most * noise.even();
    let spots: Vec<[f32; 6]> = (0..60)
        .map(|_| {
            let center = [draw(width as f32), draw(height as f32), 6.0 + draw(30.0)];
            [
                center[0],
                center[1],
                center[2],
                draw(255.0),
                draw(255.0),
                draw(255.0),
            ]
        })
        .collect();
    let mut image = ColorImage::filled(width, height, [60, 110, 50]);
    for (index, pixel) in image.pixels.iter_mut().enumerate() {
        let (u, v) = ((index % width) as f32, (index / width) as f32);
        for &[x, y, radius, red, green, blue] in &spots {
            let squared = ((u - x).powi(2) + (v - y).powi(2)) / radius.powi(2);
            if squared < 1.0 {
                let light = 1.0 - 0.5 * squared;
                *pixel = [red, green, blue].map(|color| (light * color) as u8);
            }
        }
    }
    image
}

#[test]
fn a_network_of_noise_finds_the_same_boxes_tiled_or_not() {
    if !has_onnx_runtime() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let model = folder.path().join("yolov3-tiny.onnx");
    std::fs::write(&model, onnx::yolov3_tiny(128, 1).to_bytes()).unwrap();
    for tiling in [TilingChoice::Whole, TilingChoice::Automatic] {
        let found = boxes(&detectors(&model, None, tiling), &blobs(320, 240));
        assert!(found.is_none_or(|count| count > 20), "{found:?}");
    }
}

#[test]
fn the_built_in_model_finds_the_same_boxes() {
    let model = Path::new(env!("CARGO_MANIFEST_DIR")).join("model/apple.onnx");
    if !model.exists() || !has_onnx_runtime() {
        println!("skipped: no {} or no ONNX Runtime", model.display());
        return;
    }
    let detectors = detectors(&model, None, TilingChoice::Automatic);
    boxes(&detectors, &blobs(700, 500));
    let found: Vec<_> = tiles().iter().map(|tile| boxes(&detectors, tile)).collect();
    assert!(
        found.iter().flatten().sum::<usize>() >= found.len(),
        "{found:?}"
    );
}

#[test]
fn yolox_nano_finds_the_same_boxes() {
    let Some(model) = shared("models/yolox_nano_coco.onnx") else {
        return;
    };
    if !has_onnx_runtime() {
        return;
    }
    // Class 47 of COCO is the apple.
    let detectors = detectors(&model, Some(47), TilingChoice::Automatic);
    let found: Vec<_> = tiles().iter().map(|tile| boxes(&detectors, tile)).collect();
    assert!(
        found.iter().flatten().sum::<usize>() >= found.len(),
        "{found:?}"
    );
}

/// A few of the recorded tiles, if they are here.
fn tiles() -> Vec<ColorImage> {
    let Some(folder) = shared("apple-tiles/val/images") else {
        return Vec::new();
    };
    let entries = std::fs::read_dir(folder).unwrap();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    let chosen = paths.iter().step_by((paths.len() / 6).max(1));
    chosen.map(|path| ColorImage::read(path).unwrap()).collect()
}
