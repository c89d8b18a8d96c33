//! Masks of wood measured on strokes, from the command line.

use super::drawn;
use crate::binary::{pomona, tree};
use crate::schema::Schema;
use pomona_cloud::GrayImage;
use serde_json::{Value, json};
use std::fs;
use tempfile::TempDir;

pub(super) const SIZE: [usize; 2] = [96, 72];

/// Two tiles of one photograph and one of another, with a branch of 5 px each, a post, and a twig; a second person
/// who drew half of the first branch; the masks of somebody who marks the branches' centre lines, and of somebody
/// who marks half of the first one and a row far from it.
pub(super) fn bench() -> TempDir {
    let dir = tempfile::tempdir().unwrap();
    for folder in ["set/images", "good", "poor"] {
        fs::create_dir_all(dir.path().join(folder)).unwrap();
    }
    for name in ["tree_1", "tree_2", "other_1"] {
        let image = drawn(SIZE);
        image
            .write(dir.path().join(format!("set/images/{name}.png")))
            .unwrap();
        mask(&dir, &format!("good/{name}.wood.png"), &[(30, 96)]);
        mask(&dir, &format!("poor/{name}.png"), &[(30, 45), (66, 96)]);
    }
    let branch = "wood 0,30.5,2.5 96,30.5,2.5\n";
    let strokes = format!(
        "# drawn by hand\nimage tree_1.png\n{branch}post 0,66.5,1 96,66.5,1\nimage tree_2.png\n{branch}\
         wood 0,50.5,1.5 96,50.5,1.5\nimage other_1.png\n{branch}"
    );
    fs::write(dir.path().join("set/strokes.txt"), strokes).unwrap();
    let second = "image tree_1.png\nwood 0,30.5,2 48,30.5,2\n";
    fs::write(dir.path().join("second.txt"), second).unwrap();
    dir
}

/// A mask that is sure of wood in the first pixels of some rows.
pub(super) fn mask(dir: &TempDir, name: &str, rows: &[(usize, usize)]) {
    let [width, height] = SIZE;
    let mut values = vec![0; width * height];
    for (row, count) in rows {
        values[row * width..row * width + count].fill(255);
    }
    let mask = GrayImage {
        width,
        height,
        values,
    };
    mask.write(dir.path().join(name)).unwrap();
}

pub(super) fn text(dir: &TempDir, name: &str) -> String {
    dir.path().join(name).to_str().unwrap().to_owned()
}

/// The command line that measures on the bench's strokes.
pub(super) fn line(dir: &TempDir, masks: &[&str], more: &[&str]) -> Vec<String> {
    let mut line = ["evaluate", "--segmentation"].map(str::to_owned).to_vec();
    line.push(text(dir, "set"));
    for name in masks {
        line.extend(["--masks".to_owned(), text(dir, name)]);
    }
    line.extend(["--out".to_owned(), text(dir, "out")]);
    line.extend(more.iter().map(ToString::to_string));
    line
}

pub(super) fn written(dir: &TempDir) -> Value {
    serde_json::from_slice(&fs::read(dir.path().join("out/segmentation.json")).unwrap()).unwrap()
}

pub(super) fn schema() -> Schema {
    Schema::read("segmentation-evaluation.schema.json")
}

pub(super) fn files(dir: &TempDir) -> Vec<String> {
    let paths = tree(&dir.path().join("out"));
    paths.iter().map(|p| p.display().to_string()).collect()
}

#[track_caller]
pub(super) fn is(figure: &Value, expected: f64) {
    let value = figure
        .as_f64()
        .unwrap_or_else(|| panic!("{figure} is no number"));
    assert!((value - expected).abs() < 1e-9, "{value}, not {expected}");
}

#[test]
fn two_programs_and_a_second_person_in_one_run() {
    let dir = bench();
    let second = text(&dir, "second.txt");
    let run = pomona(&line(
        &dir,
        &["good", "poor"],
        &["--second-strokes", &second],
    ))
    .succeeded();
    for word in [
        "strokes: 3 images of 2 photographs",
        "good",
        "poor - good",
        "By width",
        "A second person's strokes",
        "written to",
    ] {
        assert!(run.out.contains(word), "no {word} in {}", run.out);
    }
    assert_eq!(
        files(&dir),
        [
            "report.html",
            "segmentation.json",
            "worst-1.png",
            "worst-2.png"
        ]
    );
    let evaluation = written(&dir);
    let schema = schema();
    schema.accepts(&evaluation);
    for parent in [
        "",
        "/strokes",
        "/agreement",
        "/results/0",
        "/results/0/recall_wide",
        "/differences/0",
    ] {
        schema.refuses(&evaluation, &format!("{parent}/extra"), Some(json!(1)));
    }
    schema.refuses(
        &evaluation,
        "/schema",
        Some(json!("pomona.segmentation-evaluation/2")),
    );
    schema.refuses(&evaluation, "/tolerance_px", Some(json!(-1)));
    schema.refuses(&evaluation, "/agreement/recall/share", Some(json!(1.5)));
    schema.refuses(&evaluation, "/results/0/curve/0/precision", None);
    assert_eq!(evaluation["schema"], "pomona.segmentation-evaluation/1");
    assert_eq!(evaluation["strokes"]["name"], "strokes");
    assert_eq!(evaluation["strokes"]["photographs"], 2);
    is(&evaluation["strokes"]["wood_length_px"], 4.0 * 96.0);
    is(&evaluation["threshold"], 0.5);

    let [good, poor] = [0, 1].map(|i| &evaluation["results"][i]);
    assert!(good.get("segmenter").is_none(), "nothing of ours ran");
    is(&good["recall_wide"]["value"], 1.0);
    is(&good["recall_thin"]["value"], 0.0);
    is(&good["precision"]["value"], 1.0);
    // Bands of 5 rows, three times, and one of 3 rows.
    is(&good["iou"]["value"], 288.0 / (18.0 * 96.0));
    is(&good["posts"]["value"], 0.0);
    assert_eq!(good["worst"][0]["image"], "tree_2.png");
    is(&poor["recall_wide"]["value"], 0.5);
    is(&poor["precision"]["value"], 45.0 / 141.0);
    is(&poor["posts"]["value"], 1.0);
    let difference = &evaluation["differences"][0]["recall_wide"];
    for end in ["value", "low", "high"] {
        is(&difference[end], -0.5);
    }
    let agreement = &evaluation["agreement"];
    assert_eq!(agreement["images"], 1);
    // Three columns beyond the second one's end are within 3 px of it.
    is(&agreement["recall"]["share"], 51.0 / 96.0);
    is(&agreement["precision"]["share"], 1.0);

    let page = fs::read_to_string(dir.path().join("out/report.html")).unwrap();
    for word in [
        "worst-2.png",
        "<svg role=\"img\"",
        "A second person",
        "tree_2.png",
    ] {
        assert!(page.contains(word), "no {word} in the page");
    }
}

#[test]
fn a_later_run_replaces_the_earlier_and_json_is_the_file() {
    let dir = bench();
    pomona(&line(&dir, &["poor", "good"], &[])).succeeded();
    let run = pomona(&line(&dir, &["good"], &["--json", "--count", "1"])).succeeded();
    assert_eq!(
        files(&dir),
        ["report.html", "segmentation.json"],
        "nothing is bad in the first image"
    );
    let evaluation = written(&dir);
    assert_eq!(evaluation, run.json());
    schema().accepts(&evaluation);
    assert_eq!(evaluation["strokes"]["images"], 1);
    assert!(evaluation["results"][0].get("recall_thin").is_none());
    assert!(evaluation.get("agreement").is_none());
    let again = pomona(&line(
        &dir,
        &["good"],
        &["--json", "--count", "1", "--threads", "1"],
    ));
    assert_eq!(again.succeeded().out, run.out);
}

#[test]
fn threshold_and_tolerance_are_those_of_the_command_line() {
    let dir = bench();
    for name in ["tree_1", "tree_2", "other_1"] {
        // 4 px above the branch's centre line.
        mask(&dir, &format!("good/{name}.wood.png"), &[(26, 96)]);
    }
    let recall = |more: &[&str]| {
        let run = pomona(&line(&dir, &["good"], &[&["--json"][..], more].concat())).succeeded();
        let evaluation = run.json();
        (
            evaluation["tolerance_px"].as_f64(),
            evaluation["results"][0]["recall_wide"]["value"].as_f64(),
        )
    };
    assert_eq!(recall(&[]), (Some(3.0), Some(0.0)));
    assert_eq!(recall(&["--tolerance-px", "4"]), (Some(4.0), Some(1.0)));

    for name in ["tree_1", "tree_2", "other_1"] {
        let path = dir.path().join(format!("good/{name}.wood.png"));
        let mut faint = GrayImage::read(&path).unwrap();
        faint.values.iter_mut().for_each(|value| *value /= 5);
        faint.write(&path).unwrap();
    }
    let wide = ["--tolerance-px", "4"];
    assert_eq!(recall(&wide).1, Some(0.0));
    let low = [&wide[..], &["--wood-threshold", "0.2"]].concat();
    assert_eq!(recall(&low).1, Some(1.0));
}

#[test]
fn the_maps_that_segment_writes_are_worth_what_the_model_is() {
    let dir = bench();
    let maps = text(&dir, "maps");
    let images = text(&dir, "set/images");
    let embedded = ["--runtime", "embedded"];
    pomona(&[&["segment", &*images, "--out", &*maps][..], &embedded].concat()).succeeded();
    let more = [&["--segmenter", "built-in", "--json"][..], &embedded].concat();
    let evaluation = pomona(&line(&dir, &["maps"], &more)).succeeded().json();
    let schema = schema();
    schema.accepts(&evaluation);
    schema.refuses(&evaluation, "/results/0/segmenter/extra", Some(json!(1)));
    let [model, maps] = [0, 1].map(|i| &evaluation["results"][i]);
    assert_eq!(model["name"], "built-in");
    assert_eq!(maps["name"], "maps");
    assert_eq!(model["segmenter"]["runtime"]["name"], "embedded");
    // Half of 255 is rounded up: what is marked at 0.5 is the same.
    for figure in ["recall_wide", "recall_thin", "precision", "iou", "posts"] {
        assert_eq!(model[figure], maps[figure], "{figure}");
    }
    assert_eq!(model["by_width"], maps["by_width"]);
    assert_eq!(model["worst"], maps["worst"]);
    let mean = |result: &Value| {
        let bins = result["calibration"].as_array().unwrap().iter();
        let bins =
            bins.map(|bin| [&bin["pixels"], &bin["probability"]].map(|x| x.as_f64().unwrap()));
        let (pixels, sum) = bins.fold((0.0, 0.0), |(n, sum), [pixels, p]| {
            (n + pixels, sum + pixels * p)
        });
        (pixels, sum / pixels)
    };
    let ((pixels, a), (same, b)) = (mean(model), mean(maps));
    assert_eq!(pixels, same);
    assert!((a - b).abs() < 0.5 / 255.0 + 1e-6, "{a} {b}");
    // At any threshold, they find what the model finds at one less than a hundredth away.
    let curves = [model, maps].map(|r| r["curve"].as_array().unwrap());
    for figure in ["recall_wide", "recall_thin", "posts"] {
        let [of_model, of_maps] = [0, 1].map(|i| {
            curves[i]
                .iter()
                .map(|level| level[figure].as_f64().unwrap())
        });
        let of_model: Vec<f64> = of_model.collect();
        for (level, found) in of_maps.enumerate() {
            let least = of_model.get(level + 1).copied().unwrap_or(0.0);
            let most = of_model[level.saturating_sub(1)].max(if level == 0 { 1.0 } else { 0.0 });
            assert!(
                (least..=most).contains(&found),
                "{figure} at {level}: {found}"
            );
        }
    }
    let difference = &evaluation["differences"][0];
    if !difference.is_null() {
        is(&difference["iou"]["value"], 0.0);
    }
}

#[test]
fn the_built_in_model_is_measured_where_nothing_else_is_given() {
    let dir = bench();
    let more = ["--runtime", "embedded", "--count", "1"];
    let run = pomona(&line(&dir, &[], &more)).succeeded();
    assert!(run.out.contains("built-in"), "{}", run.out);
    assert_eq!(written(&dir)["results"].as_array().unwrap().len(), 1);
}

#[test]
fn bad_strokes_are_refused_with_their_line_and_nothing_is_written() {
    let dir = bench();
    let other = text(&dir, "other.txt");
    let refused = |content: Option<&[u8]>, more: &[&str], words: &[&str]| {
        match content {
            Some(content) => fs::write(&other, content).unwrap(),
            None => fs::remove_file(&other).unwrap_or_default(),
        }
        let before = tree(dir.path());
        pomona(&line(&dir, &["good"], more)).refused(words);
        assert_eq!(tree(dir.path()), before);
    };
    let strokes = ["--strokes", &other];
    refused(None, &strokes, &["other.txt", "--strokes"]);
    for (content, words) in [
        (
            &b"image tree_1.png\nwood 1,2,3 4,5,6\nbranch 1,2,3 4,5,6\n"[..],
            &["other.txt: line 3", "'branch'", "wood, far, peduncle, post"][..],
        ),
        (
            b"image tree_1.png\nwood 1,2 4,5,6\n",
            &["other.txt: line 2", "x,y,half_width"],
        ),
        (b"wood 1,2,3 4,5,6\n", &["other.txt: line 1", "image NAME"]),
        (b"# nothing\n", &["other.txt", "image NAME"]),
        (b"image \xff\n", &["other.txt", "UTF-8"]),
        (b"image gone.png\n", &["gone.png", "other.txt", "images/"]),
        (
            b"image tree_1.png\nwood 500,500,3 600,600,3\n",
            &["tree_1.png", "96x72", "another image or size"],
        ),
    ] {
        refused(Some(content), &strokes, words);
    }
    let second = ["--second-strokes", &other];
    refused(None, &second, &["other.txt", "--second-strokes"]);
    refused(Some(b"wod"), &second, &["other.txt: line 1", "'wod'"]);

    fs::remove_file(dir.path().join("set/strokes.txt")).unwrap();
    refused(None, &[], &["strokes.txt", "--strokes"]);
}

#[test]
fn bad_masks_and_models_are_refused_and_nothing_is_written() {
    let dir = bench();
    let refused = |masks: &[&str], more: &[&str], words: &[&str]| {
        let before = tree(dir.path());
        pomona(&line(&dir, masks, more)).refused(words);
        assert_eq!(tree(dir.path()), before);
    };
    refused(&["gone"], &[], &["gone", "tree_1", "check the path"]);
    refused(&["good", "good"], &[], &["`good`", "twice"]);
    let twice = ["--segmenter", "built-in"].repeat(2);
    refused(
        &[],
        &[&twice[..], &["--runtime", "embedded"]].concat(),
        &["`built-in`", "twice"],
    );
    let broken = text(&dir, "broken.onnx");
    fs::write(&broken, "no network").unwrap();
    let broken = ["--segmenter", &broken, "--runtime", "embedded"];
    refused(&[], &broken, &["broken.onnx"]);

    let small = GrayImage {
        width: 3,
        height: 2,
        values: vec![0; 6],
    };
    small
        .write(dir.path().join("good/tree_2.wood.png"))
        .unwrap();
    let words = [
        "tree_2.wood.png",
        "3x2 pixels for an image of 96x72",
        "image's size",
    ];
    refused(&["good"], &[], &words);
    fs::copy(
        dir.path().join("set/images/tree_2.png"),
        dir.path().join("good/tree_2.wood.png"),
    )
    .unwrap();
    refused(&["good"], &[], &["tree_2.wood.png", "grey"]);

    fs::create_dir(dir.path().join("out")).unwrap();
    fs::write(dir.path().join("out/report.html"), "mine").unwrap();
    refused(&["poor"], &[], &["report.html", "--out"]);
}

#[test]
fn slips_of_the_command_line_are_usage_errors() {
    let dir = tempfile::tempdir().unwrap();
    let out = text(&dir, "out");
    for (more, word) in [
        ("--strokes s.txt", "--segmentation"),
        ("lab15 --strokes s.txt", "--segmentation"),
        ("lab15 --segmenter built-in", "--segmentation"),
        ("a --calipers c.csv --strokes s.txt", "--segmentation"),
        ("--segmentation x --detection y", "--detection"),
        ("--segmentation x lab15", "--segmentation"),
        (
            "--segmentation x --strokes s --truth-masks m",
            "--truth-masks",
        ),
        (
            "--segmentation x --second-strokes s --truth-masks m",
            "--truth-masks",
        ),
        ("--segmentation x --wood-threshold 1.5", "from 0 to 1"),
        ("--segmentation x --tolerance-px NaN", "from 0 to 100"),
    ] {
        let more: Vec<&str> = more.split(' ').collect();
        let usage = pomona(&[&["evaluate", "--out", &out][..], &more].concat());
        assert_eq!((usage.code, &*usage.out), (2, ""));
        assert!(usage.err.contains(word), "{}", usage.err);
    }
    assert!(tree(dir.path()).is_empty());
}

#[test]
fn options_of_another_mode_are_usage_errors() {
    let dir = tempfile::tempdir().unwrap();
    let out = text(&dir, "out");
    for (mode, options, owner) in [
        (
            "lab15",
            &[
                "--truth-masks m",
                "--second-strokes s.txt",
                "--masks m",
                "--wood-threshold 0.4",
                "--tolerance-px 2",
            ][..],
            "belongs to --segmentation, not to suites and frames with truth",
        ),
        (
            "lab15",
            &[
                "--boxes b.json",
                "--model built-in",
                "--class apple",
                "--label-class apple",
                "--ignore-label x",
                "--threshold 0.3",
                "--lowest-score 0.1",
                "--nms-iou 0.4",
            ],
            "belongs to --detection, not to suites and frames with truth",
        ),
        (
            "lab15",
            &["--runtime embedded", "--tiles whole"],
            "belongs to --detection and --segmentation",
        ),
        (
            "a --calipers c.csv",
            &["--masks m"],
            "belongs to --segmentation, not to --calipers",
        ),
        (
            "a --calipers c.csv",
            &["--calibration-poses 9"],
            "belongs to suites and frames with truth, not to --calipers",
        ),
        (
            "--detection x",
            &["--wood-threshold 0.5"],
            "belongs to --segmentation, not to --detection",
        ),
        (
            "--detection x",
            &["--robot"],
            "belongs to suites and frames with truth, not to --detection",
        ),
        (
            "--segmentation x",
            &["--boxes b.json", "--threshold 0.25", "--nms-iou 0.4"],
            "belongs to --detection, not to --segmentation",
        ),
        (
            "--segmentation x",
            &["--robot"],
            "belongs to suites and frames with truth, not to --segmentation",
        ),
    ] {
        for option in options {
            let words: Vec<&str> = mode.split(' ').chain(option.split(' ')).collect();
            let usage = pomona(&[&["evaluate", "--out", &out][..], &words].concat());
            assert_eq!((usage.code, &*usage.out), (2, ""), "{option}");
            let name = option.split(' ').next().unwrap();
            let message = format!("error: {name} {owner}");
            assert!(usage.err.contains(&message), "{option}: {}", usage.err);
            assert!(usage.err.contains("pomona evaluate"), "{}", usage.err);
        }
    }
    assert!(tree(dir.path()).is_empty());
}
