use super::*;
use boon::{Compiler, Draft, Schemas};
use clap::Parser;
use pomona_cloud::{BoxChoice, BoxImage, PixelBox, read_boxes};
use pomona_detect::{DetectError, DetectorReport, RuntimeReport};
use serde_json::Value;
use std::path::Path;
use tempfile::TempDir;

fn boxes_in(path: &Path) -> Vec<PixelBox> {
    read_boxes(path, &BoxImage::new(64, 48), &BoxChoice::default())
        .unwrap()
        .value
}

/// Sees one box in the middle of an image, one that reaches out of it, and one beyond it.
struct Middle;

impl Detector for Middle {
    fn detect(&self, image: &ColorImage) -> Result<Vec<Detection>, DetectError> {
        let (w, h) = (image.width as f64, image.height as f64);
        if w < 4.0 {
            return Err(DetectError::Other {
                detector: "middle".to_owned(),
                source: "too small".into(),
            });
        }
        let seen = |[x_min, y_min, x_max, y_max]: [f64; 4], score| Detection {
            x_min,
            y_min,
            x_max,
            y_max,
            score,
            class: 3,
        };
        Ok(vec![
            seen([w / 4.0, h / 4.0, w / 2.0, h / 2.0], 0.875),
            seen([-3.0, 2.0, 9.5, 12.0], 0.5),
            seen([w + 1.0, 2.0, w + 9.0, 12.0], 0.25),
        ])
    }

    fn report(&self) -> DetectorReport {
        let mut runtime = RuntimeReport::new("embedded", "1.2.3");
        runtime.fallback_reason = Some("nothing else found".to_owned());
        let mut report = DetectorReport::new("middle");
        report.family = Some("own".to_owned());
        report.runtime = Some(runtime);
        report.notes = vec!["the input's size is open".to_owned()];
        report
    }
}

#[derive(Parser)]
struct Line {
    #[command(flatten)]
    arguments: DetectArguments,
}

/// Two images of 64 × 48 pixels, a and b.
fn bench() -> TempDir {
    let dir = tempfile::tempdir().unwrap();
    for name in ["a.png", "b.png"] {
        let image = ColorImage::filled(64, 48, [60, 90, 70]);
        image.write(dir.path().join(name)).unwrap();
    }
    dir
}

/// Detects in the images `names` of `dir` and writes into its folder `out`.
fn detect_in(dir: &TempDir, names: &[&str], more: &[&str]) -> Result<(), String> {
    let path = |name: &str| dir.path().join(name).to_str().unwrap().to_owned();
    let images: Vec<String> = names.iter().map(|name| path(name)).collect();
    let out = path("out");
    let line = ["x", "--json", "--out", &out].into_iter();
    let line = line
        .chain(images.iter().map(String::as_str))
        .chain(more.iter().copied());
    let arguments = Line::try_parse_from(line)
        .map_err(|e| e.to_string())?
        .arguments;
    let run = || -> anyhow::Result<()> {
        let images = images_of(&arguments)?;
        let output = claim(&arguments, &images)?;
        let job = Job {
            arguments: &arguments,
            images: &images,
            output: &output,
            detector: &Middle,
            open_ms: 1.5,
        };
        job.run(Terminal::new(clap::ColorChoice::Never))
    };
    run().map_err(|e| e.to_string())
}

fn images_of(arguments: &DetectArguments) -> anyhow::Result<Vec<NamedImage>> {
    images(&arguments.images)
}

fn names(dir: &TempDir) -> Vec<String> {
    let entries = std::fs::read_dir(dir.path().join("out")).unwrap();
    let mut names: Vec<_> = entries
        .map(|e| e.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

fn record(dir: &TempDir) -> Value {
    let bytes = std::fs::read(dir.path().join("out").join(DETECTIONS)).unwrap();
    serde_json::from_slice(&bytes).unwrap()
}

#[test]
fn each_format_holds_the_boxes_and_a_later_run_replaces_the_earlier() {
    let dir = bench();
    detect_in(&dir, &["a.png", "b.png"], &[]).unwrap();
    assert_eq!(
        names(&dir),
        [
            "a-boxes.png",
            "b-boxes.png",
            "boxes.json",
            "detections.json"
        ]
    );
    let coco = CocoDataset::read(dir.path().join("out/boxes.json")).unwrap();
    assert_eq!(coco.images[1].file_name, "b.png");
    assert_eq!(coco.images[1].boxes[0].bounds.score, 0.875);
    assert_eq!(coco.images[1].boxes[0].class_name.as_deref(), Some("apple"));

    std::fs::write(dir.path().join("out/notes.txt"), "mine").unwrap();
    detect_in(&dir, &["a.png"], &["--format", "voc"]).unwrap();
    assert_eq!(
        names(&dir),
        ["a-boxes.png", "a.xml", "detections.json", "notes.txt"]
    );
    let boxes = boxes_in(&dir.path().join("out/a.xml"));
    assert_eq!(
        (boxes.len(), boxes[0].x_min, boxes[1].x_min),
        (2, 16.0, -3.0)
    );

    detect_in(&dir, &["a.png"], &["--format", "yolo", "--no-picture"]).unwrap();
    assert_eq!(names(&dir), ["a.txt", "detections.json", "notes.txt"]);
    let boxes = boxes_in(&dir.path().join("out/a.txt"));
    assert_eq!((boxes[0].x_max, boxes[0].score), (32.0, 0.875));
}

#[test]
fn the_record_holds_to_its_schema() {
    let dir = bench();
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/detections.schema.json");
    let schema: Value = serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap();
    let mut compiled = Schemas::new();
    let mut compiler = Compiler::new();
    compiler.set_default_draft(Draft::V2020_12);
    compiler.add_resource("detections", schema).unwrap();
    let schema = compiler.compile("detections", &mut compiled).unwrap();
    for more in [&[][..], &["--no-picture", "--format", "voc"]] {
        detect_in(&dir, &["a.png", "b.png"], more).unwrap();
        let record = record(&dir);
        if let Err(errors) = compiled.validate(&record, schema) {
            panic!("{errors}");
        }
        assert_eq!(record["detector"]["runtime"]["version"], "1.2.3");
        assert_eq!(record["images"][0]["detections"][0]["class"], 3);
        // What lies beyond the image is in no file.
        assert_eq!(
            record["images"][0]["detections"].as_array().unwrap().len(),
            2
        );
        for (place, value) in [
            ("/schema", Value::from("pomona.detections/2")),
            ("/images/0/detections/0/score", Value::from(1.5)),
            ("/images/0/width", Value::from(0)),
            ("/detector/runtime/name", Value::from(7)),
        ] {
            let mut changed = record.clone();
            *changed.pointer_mut(place).unwrap() = value;
            assert!(compiled.validate(&changed, schema).is_err(), "{place}");
        }
    }
}

#[test]
fn files_of_others_and_images_of_one_name_are_refused_and_nothing_is_written() {
    let dir = bench();
    std::fs::create_dir(dir.path().join("out")).unwrap();
    std::fs::write(dir.path().join("out/a-boxes.png"), "holiday").unwrap();
    let refused = detect_in(&dir, &["a.png"], &[]).unwrap_err();
    assert!(
        refused.contains("a-boxes.png") && refused.contains("--out"),
        "{refused}"
    );
    detect_in(&dir, &["a.png"], &["--no-picture"]).unwrap();
    let kept = std::fs::read(dir.path().join("out/a-boxes.png")).unwrap();
    assert_eq!(kept, b"holiday");
    let twice = detect_in(&dir, &["a.png", "a.png"], &[]).unwrap_err();
    assert!(twice.contains("`a`"), "{twice}");
}

#[test]
fn a_failure_names_the_image_and_leaves_nothing() {
    let dir = bench();
    ColorImage::filled(2, 2, [0; 3])
        .write(dir.path().join("c.png"))
        .unwrap();
    std::fs::write(dir.path().join("d.png"), "no picture").unwrap();
    for (bad, word) in [
        ("c.png", "too small"),
        ("d.png", "neither a PNG"),
        ("gone.png", "check the path"),
    ] {
        let refused = detect_in(&dir, &["a.png", bad], &[]).unwrap_err();
        assert!(refused.contains(bad) && refused.contains(word), "{refused}");
        assert!(!dir.path().join("out").exists());
    }
}
