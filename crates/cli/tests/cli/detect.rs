//! Apples in colour images, from the command line.

use crate::binary::{pomona, tree};
use crate::scene::Bench;
use crate::schema::Schema;
use std::path::Path;

#[test]
fn what_cannot_be_used_is_refused_and_nothing_is_written() {
    let bench = Bench::new();
    bench.write("broken.onnx", "no network");
    bench.write("text.png", "no picture");
    let refused = |image: &str, more: &[&str], words: &[&str]| {
        let before = tree(bench.root());
        let line = ["detect", &bench.text(image), "--out", &bench.text("out")];
        pomona(&[&line[..], more].concat()).refused(words);
        assert_eq!(tree(bench.root()), before);
    };
    let (gone, broken) = (bench.text("gone.onnx"), bench.text("broken.onnx"));
    refused("a", &["--model", &gone], &["gone.onnx"]);
    let embedded = ["--runtime", "embedded", "--model"];
    refused("a", &[&embedded[..], &[&broken]].concat(), &["broken.onnx"]);
    let usage = pomona(&["detect", &bench.text("a"), "--out", "x", "--tiles", "3by2"]);
    assert_eq!(usage.code, 2);
    assert!(usage.err.contains("3x2"), "{}", usage.err);
}

#[test]
fn a_published_network_from_image_to_evaluation() {
    let shared = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared");
    let model = shared.join("models/yolox_nano_coco.onnx");
    let frame = shared.join("frames/orchard-1218");
    if !model.is_file() || !frame.is_dir() {
        println!("skipped: no models and frames in {}", shared.display());
        return;
    }
    let bench = Bench::new();
    let (model, frame) = (model.to_str().unwrap(), frame.to_str().unwrap());
    let out = bench.text("out");
    let how = [
        "--model",
        model,
        "--runtime",
        "embedded",
        "--tiles",
        "whole",
    ];
    let line = [
        &[
            "detect",
            frame,
            "--threshold",
            "0.05",
            "--json",
            "--out",
            &out,
        ],
        &how[..],
    ]
    .concat();
    let record = pomona(&line).succeeded().json();
    Schema::read("detections.schema.json").accepts(&record);
    assert_eq!(record["detector"]["runtime"]["name"], "embedded");
    assert_eq!(record["detector"]["family"], "yolox");
    assert_eq!(record["images"][0]["name"], "orchard-1218");
    let seen = record["images"][0]["detections"].as_array().unwrap().len();
    assert!(seen > 5, "{seen} boxes");

    // The same model, once as a model and once as the boxes that it wrote: the same figures.
    let boxes = bench.text("out/boxes.json");
    let evaluation = bench.text("evaluation");
    std::fs::create_dir(bench.path("set")).unwrap();
    for (from, to) in [("color.png", "color.png"), ("boxes.xml", "color.xml")] {
        std::fs::copy(Path::new(frame).join(from), bench.path("set").join(to)).unwrap();
    }
    let set = bench.text("set");
    let line = [
        &[
            "evaluate",
            "--detection",
            &set,
            "--boxes",
            &boxes,
            "--ignore-label",
            "BALL_*",
        ],
        &[
            "--lowest-score",
            "0.05",
            "--threshold",
            "0.05",
            "--json",
            "--out",
            &evaluation,
        ],
        &how[..],
    ];
    let measured = pomona(&line.concat()).succeeded().json();
    Schema::read("detection-evaluation.schema.json").accepts(&measured);
    let [by_model, by_boxes] = [0, 1].map(|i| &measured["results"][i]);
    assert_eq!(measured["dataset"]["labels"], 26);
    assert_eq!(by_model["detections"], seen);
    assert_eq!(by_model["detector"]["runtime"]["name"], "embedded");
    let [a, b] = [by_model, by_boxes].map(|r| r["ap50"]["value"].as_f64().unwrap());
    assert!(a > 0.0 && (a - b).abs() < 1e-9, "{a} {b}");
    assert_eq!(
        by_model["at_threshold"]["found"],
        by_boxes["at_threshold"]["found"]
    );
}
