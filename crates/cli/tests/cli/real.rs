//! Directions on real frames against strokes of wood, from the command line.

use crate::binary::{Run, pomona, tree};
use crate::scene::Bench;
use crate::schema::Schema;
use pomona_cloud::{Frame, GrayImage};
use serde_json::{Value, json};
use std::fs;
use std::path::Path;

/// A frame `a` whose one apple hangs below a level branch, drawn as a stroke from edge to edge.
fn bench() -> Bench {
    let bench = Bench::new();
    pomona(&["pick", &bench.text("a"), "--out", &bench.text("picked")]).succeeded();
    let picks: Value = serde_json::from_slice(&bench.read("picked/picks.json")).unwrap();
    let foot = picks["picks"][0]["foot"].as_array().unwrap();
    let foot: Vec<f64> = foot.iter().map(|x| x.as_f64().unwrap()).collect();
    let camera = Frame::read(bench.path("a")).unwrap().camera;
    let row = camera.fy * foot[1] / foot[2] + camera.cy + 0.5;
    let strokes = format!("image a\nwood 0,{row},3 320,{row},3\npeduncle 1,1,1 2,2,1\n");
    fs::write(bench.path("strokes.txt"), strokes).unwrap();
    bench
}

fn evaluate(bench: &Bench, more: &[&str]) -> Run {
    let mut line: Vec<String> = ["evaluate", "--real"].map(str::to_owned).to_vec();
    line.extend([bench.text("a"), "--out".to_owned(), bench.text("out")]);
    line.extend(more.iter().map(ToString::to_string));
    pomona(&line)
}

#[test]
fn answers_are_held_against_strokes_and_written() {
    let bench = bench();
    fs::write(
        bench.path("apples.csv"),
        "frame,box_name,wood,note\na,blind,none,\n",
    )
    .unwrap();
    let strokes = bench.text("strokes.txt");
    let line = [
        "--strokes",
        &strokes,
        "--segmenter",
        "none",
        "--repeats",
        "3",
    ];
    let run = evaluate(&bench, &[&line[..], &["--json"]].concat()).succeeded();
    let report = run.json();
    Schema::read("real-evaluation.schema.json").accepts(&report);
    let all = &report["results"][0]["all"];
    // Wood is drawn near the apple; the boxes at the corners are too small to have any within three radii.
    assert_eq!(all["seen"]["right"]["share"], json!(1.0), "{all}");
    assert_eq!(all["seen"]["on_wood"]["share"], json!(1.0));
    assert_eq!(all["none"]["refused"]["of"], json!(2));
    assert_eq!(all["perturbed"]["flipped"]["of"], json!(9));
    let files: Vec<String> = tree(&bench.path("out"))
        .iter()
        .map(|path| path.display().to_string())
        .collect();
    assert_eq!(
        files,
        ["real.csv", "real.json", "report.html", "worst-1-1.png"]
    );

    // Another run replaces the files, takes the strokes of the folder and a mask, and makes no copies.
    fs::copy(bench.path("strokes.txt"), bench.path("a/wood.txt")).unwrap();
    fs::create_dir(bench.path("masks")).unwrap();
    mask(&bench.path("masks/a.wood.png"), 320);
    let line = [
        "--wood-masks",
        &bench.text("masks"),
        "--apples",
        &bench.text("apples.csv"),
    ];
    let run = evaluate(&bench, &[&line[..], &["--repeats", "0"]].concat()).succeeded();
    assert!(
        run.out.contains("unlisted") && !run.out.contains("copies"),
        "{}",
        run.out
    );
    let report: Value = serde_json::from_slice(&bench.read("out/real.json")).unwrap();
    Schema::read("real-evaluation.schema.json").accepts(&report);
    assert_eq!(report["wood"], json!("masks"));
    assert!(
        !bench.path("out/worst-1-1.png").exists(),
        "no apple is seen"
    );
}

fn mask(path: &Path, width: usize) {
    let mask = GrayImage {
        width,
        height: 240,
        values: vec![0; width * 240],
    };
    mask.write(path).unwrap();
}

#[test]
fn what_does_not_fit_is_refused() {
    let bench = bench();
    let strokes = bench.text("strokes.txt");
    let masks = bench.text("masks");
    let given = |more: &[&str]| evaluate(&bench, &[&["--strokes", &strokes], more].concat());
    evaluate(&bench, &[]).refused(&["no wood.txt", "--strokes"]);
    given(&["--wood-masks", &masks]).refused(&["a.wood.png", "pomona segment"]);
    fs::create_dir(&masks).unwrap();
    mask(&bench.path("masks/a.wood.png"), 300);
    given(&["--wood-masks", &masks]).refused(&["a.wood.png", "300x240", "320x240"]);
    given(&["--segmenter", "none", "--segmenter", "built-in"]).refused(&["--segmenter", "twice"]);
    fs::write(bench.path("apples.csv"), "frame,box_name,wood\na,9,seen\n").unwrap();
    given(&["--segmenter", "none", "--apples", &bench.text("apples.csv")])
        .refused(&["apples.csv", "0 boxes named 9"]);
    assert!(!bench.path("out").exists());
    // Options of other modes, and those of this one without it.
    for line in [
        &["evaluate", "lab15", "--out", "o", "--repeats", "3"][..],
        &["evaluate", "lab15", "--out", "o", "--strokes", "s"],
        &["evaluate", "--real", "--out", "o"],
        &["evaluate", "--real", "a", "--out", "o", "--calipers", "c"],
        &["evaluate", "--real", "--segmentation", "t", "--out", "o"],
    ] {
        assert_eq!(pomona(line).code, 2, "{line:?}");
    }
}
