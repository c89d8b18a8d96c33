//! Average precision beside that of COCO's own program, where Python has it (`pip install pycocotools`).
//!
//! The Python is that of the variable `PYTHON`, else `python3`.

use pomona_cloud::{LabelKind, LabelledBox, PixelBox};
use pomona_detect::Detection;
use pomona_labels::{Curve, MatchedImage};
use rand_chacha::ChaCha8Rng;
use rand_core::{Rng, SeedableRng};
use serde_json::{Value, json};
use std::path::Path;
use std::process::Command;

/// Labels in all: a prime, so that no recall but 0 and 1 is one of COCO's 101, where its rounding would decide.
const LABELS: usize = 1009;

fn python() -> Option<String> {
    let python = std::env::var("PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let found = Command::new(&python)
        .args(["-c", "import pycocotools.cocoeval"])
        .output();
    if found.is_ok_and(|output| output.status.success()) {
        return Some(python);
    }
    println!("skipped: {python} has no pycocotools");
    None
}

struct Draw(ChaCha8Rng);

impl Draw {
    fn unit(&mut self) -> f64 {
        f64::from(self.0.next_u32()) / 2.0_f64.powi(32)
    }

    fn edges(&mut self) -> [f64; 4] {
        let [x, y, w, h] = [500.0, 500.0, 100.0, 100.0].map(|most| most * self.unit());
        [x, y, x + w + 4.0, y + h + 4.0]
    }

    /// Each edge moved by up to half of `by` of the box's width or height, so that it stays a box.
    fn shifted(&mut self, [x_min, y_min, x_max, y_max]: [f64; 4], by: f64) -> [f64; 4] {
        let mut moved = |edge: f64, side: f64| edge + by * side * (self.unit() - 0.5);
        let (w, h) = (x_max - x_min, y_max - y_min);
        [
            moved(x_min, w),
            moved(y_min, h),
            moved(x_max, w),
            moved(y_max, h),
        ]
    }
}

/// AP50 and AP50-95 of the reference program.
fn reference(python: &str, labels: &Value, results: &Value) -> [f64; 2] {
    let dir = tempfile::tempdir().unwrap();
    let write = |name: &str, value: &Value| {
        let path = dir.path().join(name);
        std::fs::write(&path, value.to_string()).unwrap();
        path
    };
    let program =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/pycocotools/average_precision.py");
    let output = Command::new(python)
        .arg(program)
        .arg(write("labels.json", labels))
        .arg(write("results.json", results))
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    let text = String::from_utf8(output.stdout).unwrap();
    let mut numbers = text.split_whitespace().map(|word| word.parse().unwrap());
    [numbers.next().unwrap(), numbers.next().unwrap()]
}

#[test]
fn average_precision_is_that_of_the_reference_program() {
    let Some(python) = python() else {
        return;
    };
    for seed in 0..3 {
        let mut draw = Draw(ChaCha8Rng::seed_from_u64(seed));
        let (mut images, mut annotations, mut results) = (Vec::new(), Vec::new(), Vec::new());
        let mut outcomes = Vec::new();
        let mut left = LABELS;
        for image in 1.. {
            if left == 0 {
                break;
            }
            images.push(json!({ "id": image, "width": 640, "height": 640, "file_name": format!("{image}.png") }));
            let (mut labels, mut detections) = (Vec::new(), Vec::new());
            let mut see = |edges: [f64; 4], score: f64| {
                let [x_min, y_min, x_max, y_max] = edges;
                results.push(json!({ "image_id": image, "category_id": 1, "bbox": [x_min, y_min, x_max - x_min, y_max - y_min], "score": score }));
                detections.push(Detection {
                    x_min,
                    y_min,
                    x_max,
                    y_max,
                    score,
                    class: 1,
                });
            };
            for _ in 0..left.min((12.0 * draw.unit()) as usize) {
                let edges = draw.edges();
                let is_crowd = draw.unit() < 0.1;
                left -= usize::from(!is_crowd);
                let [x_min, y_min, x_max, y_max] = edges;
                let id = annotations.len() + 1;
                let (w, h) = (x_max - x_min, y_max - y_min);
                annotations.push(json!({ "id": id, "image_id": image, "category_id": 1, "bbox": [x_min, y_min, w, h],
                    "area": w * h, "iscrowd": u8::from(is_crowd) }));
                let mut label = LabelledBox::new(PixelBox {
                    name: String::new(),
                    x_min,
                    y_min,
                    x_max,
                    y_max,
                    score: 1.0,
                });
                if is_crowd {
                    label.kind = LabelKind::Crowd;
                }
                labels.push(label);
                // Some labels are found twice, some not at all.
                while draw.unit() < 0.6 {
                    let score = 0.3 + 0.7 * draw.unit();
                    see(draw.shifted(edges, 0.5), score);
                }
            }
            while draw.unit() < 0.6 {
                let score = draw.unit();
                see(draw.edges(), score);
            }
            outcomes.push(MatchedImage::new(&labels, detections));
        }
        let labels = json!({ "info": {}, "images": images, "annotations": annotations,
            "categories": [{ "id": 1, "name": "apple" }] });
        let theirs = reference(&python, &labels, &json!(results));
        let ours = Curve::of(&outcomes).unwrap();
        println!(
            "seed {seed}: ours {} {}, pycocotools {theirs:?}",
            ours.ap50_101, ours.ap50_95_101
        );
        assert!(
            (ours.ap50_101 - theirs[0]).abs() < 1e-9,
            "{} {theirs:?}",
            ours.ap50_101
        );
        assert!(
            (ours.ap50_95_101 - theirs[1]).abs() < 1e-9,
            "{} {theirs:?}",
            ours.ap50_95_101
        );
    }
}
