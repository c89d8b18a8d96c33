//! Detections of other programs measured on labelled images.

use crate::binary::{pomona, tree};
use crate::schema::Schema;
use pomona_cloud::ColorImage;
use serde_json::{Value, json};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// Three images with four labels in all, and detections of two programs.
fn bench() -> TempDir {
    let dir = tempfile::tempdir().unwrap();
    for folder in ["tiles/images", "tiles/labels", "good"] {
        fs::create_dir_all(dir.path().join(folder)).unwrap();
    }
    let labels = [
        ("a", "0 0.25 0.25 0.2 0.2\n0 0.75 0.75 0.2 0.2\n"),
        ("b", "0 0.5 0.5 0.4 0.4\n1 0.2 0.8 0.1 0.1\n"),
        ("c", ""),
    ];
    for (name, text) in labels {
        let image = ColorImage::filled(100, 100, [70, 100, 60]);
        image
            .write(dir.path().join(format!("tiles/images/{name}.png")))
            .unwrap();
        fs::write(dir.path().join(format!("tiles/labels/{name}.txt")), text).unwrap();
        let scored: Vec<String> = text.lines().map(|line| format!("{line} 0.9")).collect();
        fs::write(
            dir.path().join(format!("good/{name}.txt")),
            scored.join("\n"),
        )
        .unwrap();
    }
    // One right, one beside its label, one in the empty image.
    let results = json!([
        { "image_id": "a", "category_id": 0, "bbox": [15, 15, 20, 20], "score": 0.8 },
        { "image_id": "b", "category_id": 0, "bbox": [60, 60, 20, 20], "score": 0.7 },
        { "image_id": "c", "category_id": 0, "bbox": [5, 5, 20, 20], "score": 0.1 },
    ]);
    fs::write(dir.path().join("poor.json"), results.to_string()).unwrap();
    dir
}

fn text(dir: &TempDir, name: &str) -> String {
    dir.path().join(name).to_str().unwrap().to_owned()
}

/// The command line that measures these boxes in the bench's folder.
fn line(dir: &TempDir, boxes: &[&str], more: &[&str]) -> Vec<String> {
    let mut line = vec![
        "evaluate".to_owned(),
        "--detection".to_owned(),
        text(dir, "tiles"),
    ];
    for name in boxes {
        line.extend(["--boxes".to_owned(), text(dir, name)]);
    }
    line.extend(["--out".to_owned(), text(dir, "out")]);
    line.extend(more.iter().map(ToString::to_string));
    line
}

fn read_json(path: &Path) -> Value {
    serde_json::from_slice(&fs::read(path).unwrap()).unwrap()
}

#[test]
fn two_programs_in_one_run() {
    let dir = bench();
    let run = pomona(&line(&dir, &["good", "poor.json"], &["--label-class", "0"]));
    // Detections of the class 1 find no label then.
    assert_eq!((run.code, &*run.err), (0, ""), "{}", run.out);
    for word in ["good", "poor", "AP50", "poor - good", "written to"] {
        assert!(run.out.contains(word), "no {word} in {}", run.out);
    }
    let names: Vec<_> = tree(&dir.path().join("out"))
        .iter()
        .map(|p| p.display().to_string())
        .collect();
    assert_eq!(
        names,
        [
            "detection.json",
            "report.html",
            "worst-1.png",
            "worst-2.png"
        ]
    );
    let evaluation = read_json(&dir.path().join("out/detection.json"));
    let schema = Schema::read("detection-evaluation.schema.json");
    schema.accepts(&evaluation);
    for parent in [
        "",
        "/dataset",
        "/results/0",
        "/results/0/curve/best_f1",
        "/results/0/by_size/0/size",
    ] {
        schema.refuses(&evaluation, &format!("{parent}/extra"), Some(json!(1)));
    }
    schema.refuses(&evaluation, "/dataset/form", Some(json!("drawer")));
    schema.refuses(&evaluation, "/results/0/curve/best_f1", None);
    schema.refuses(&evaluation, "/results/0/curve/ap50", Some(Value::Null));
    schema.refuses(&evaluation, "/results/0/recall/high", None);
    assert_eq!(evaluation["dataset"]["labels"], 3);
    assert_eq!(evaluation["dataset"]["background_images"], 1);
    let [good, poor] = [0, 1].map(|i| &evaluation["results"][i]);
    assert_eq!(
        good["at_threshold"],
        json!({"found": 3, "missed": 0, "further": 1, "further_per_image": 1.0 / 3.0, "mean_iou": 1.0})
    );
    assert_eq!(poor["at_threshold"]["found"], 1);
    assert_eq!(poor["at_threshold"]["further"], 1);
    assert!((poor["ap50"]["value"].as_f64().unwrap() - 1.0 / 3.0).abs() < 1e-12);
    assert!(
        evaluation["differences"][0]["ap50"]["value"]
            .as_f64()
            .unwrap()
            < 0.0
    );
    let page = fs::read_to_string(dir.path().join("out/report.html")).unwrap();
    assert!(page.contains("worst-2.png") && page.contains("<svg role=\"img\""));
}

#[test]
fn a_program_that_detects_nothing_has_no_best_f1() {
    let dir = bench();
    fs::create_dir(dir.path().join("none")).unwrap();
    fs::write(dir.path().join("none/a.txt"), "").unwrap();
    let run = pomona(&line(&dir, &["none"], &["--json", "--label-class", "0"])).succeeded();
    let evaluation = run.json();
    Schema::read("detection-evaluation.schema.json").accepts(&evaluation);
    let curve = evaluation["results"][0]["curve"].as_object().unwrap();
    assert_eq!(curve["best_f1"], Value::Null);
}

#[test]
fn a_later_run_replaces_the_earlier_and_json_is_the_file() {
    let dir = bench();
    pomona(&line(&dir, &["good", "poor.json"], &["--label-class", "0"])).succeeded();
    let run = pomona(&line(
        &dir,
        &["good"],
        &["--label-class", "0", "--class", "0", "--json"],
    ))
    .succeeded();
    let names: Vec<_> = tree(&dir.path().join("out"))
        .iter()
        .map(|p| p.display().to_string())
        .collect();
    assert_eq!(
        names,
        ["detection.json", "report.html"],
        "nothing is bad now"
    );
    assert_eq!(
        read_json(&dir.path().join("out/detection.json")),
        run.json()
    );
    let again = pomona(
        &[
            line(
                &dir,
                &["good"],
                &["--label-class", "0", "--class", "0", "--json"],
            ),
            vec!["--threads".to_owned(), "1".to_owned()],
        ]
        .concat(),
    );
    assert_eq!(again.succeeded().out, run.out);
}

#[test]
fn what_counts_alike_and_what_is_left_out_is_said() {
    let dir = bench();
    fs::remove_file(dir.path().join("tiles/labels/c.txt")).unwrap();
    let run = pomona(&line(&dir, &["poor.json"], &[]));
    assert_eq!(run.code, 0);
    assert!(
        run.err.contains("1 image without a label file"),
        "{}",
        run.err
    );
    assert!(
        run.err.contains("labels of 2 classes count alike"),
        "{}",
        run.err
    );
    fs::write(dir.path().join("good/a.txt"), "0 0.25 0.25 0.2 0.2\n").unwrap();
    fs::write(dir.path().join("good/b.txt"), "").unwrap();
    let run = pomona(&line(&dir, &["good"], &["--label-class", "0"]));
    assert!(run.err.contains("every box has the score 1"), "{}", run.err);
}

#[test]
fn bad_input_is_refused_and_nothing_is_written() {
    let dir = bench();
    let refused = |boxes: &[&str], more: &[&str], words: &[&str]| {
        let before = tree(dir.path());
        pomona(&line(&dir, boxes, more)).refused(words);
        assert_eq!(tree(dir.path()), before);
    };
    refused(&["gone.json"], &["--label-class", "0"], &["gone.json"]);
    refused(
        &["good"],
        &["--label-class", "7"],
        &["class 7", "--label-class"],
    );
    refused(
        &["good"],
        &["--label-class", "0", "--ignore-label", "BALL_*"],
        &["BALL_*"],
    );
    refused(
        &["good", "good"],
        &["--label-class", "0"],
        &["`good`", "twice"],
    );
    refused(
        &["good"],
        &["--label-class", "0", "--class", "0", "--class", "1"],
        &["--class stands 2 times"],
    );
    fs::create_dir(dir.path().join("out")).unwrap();
    fs::write(dir.path().join("out/report.html"), "mine").unwrap();
    refused(
        &["good"],
        &["--label-class", "0"],
        &["report.html", "--out"],
    );
    let usage = pomona(&["evaluate", "lab15", "--detection", "x", "--out", "y"]);
    assert_eq!(usage.code, 2);
    assert!(usage.err.contains("--detection"), "{}", usage.err);
    let usage = pomona(&["evaluate", "--out", "y"]);
    assert_eq!(usage.code, 2);
}
