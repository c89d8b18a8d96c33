//! `pomona pick` by the colour image.

use crate::binary::{Run, pomona};
use crate::scene::Bench;
use pomona::record::PicksRecord;
use pomona_cloud::GrayImage;

fn pick(bench: &Bench, frames: &[&str], more: &[&str]) -> Run {
    let mut line = vec!["pick".to_owned()];
    line.extend(frames.iter().map(|name| bench.text(name)));
    line.extend(["--out".to_owned(), bench.text("out")]);
    line.extend(more.iter().map(ToString::to_string));
    pomona(&line)
}

fn record(bench: &Bench) -> PicksRecord {
    serde_json::from_slice(&bench.read("out/picks.json")).unwrap()
}

/// A mask of the frame's size with a band of wood about each of these rows, from edge to edge.
fn mask(bench: &Bench, width: usize, rows: &[usize]) -> String {
    let mut mask = GrayImage {
        width,
        height: 240,
        values: vec![0; width * 240],
    };
    for row in rows {
        mask.values[(row - 2) * width..(row + 3) * width].fill(255);
    }
    mask.write(bench.path("wood.png")).unwrap();
    bench.text("wood.png")
}

#[test]
fn somebody_elses_mask_decides_what_is_wood() {
    let bench = Bench::new();
    pick(&bench, &["a"], &[]).succeeded();
    let by_depth = record(&bench).picks[0].clone();
    // The branch is level, above the apple: at the row of its foot.
    let camera = pomona_cloud::Frame::read(bench.path("a")).unwrap().camera;
    let [_, y, z] = by_depth.foot.unwrap();
    let row = (camera.fy * y / z + camera.cy).round() as usize;
    assert!(by_depth.confidence.unwrap() > 0.9);

    pick(&bench, &["a"], &["--wood", &mask(&bench, 320, &[row])]).succeeded();
    let by_both = record(&bench).picks[0].clone();
    assert!(by_both.direction.unwrap()[1] < -0.9, "{by_both:?}");
    let best = &by_both.candidates[0];
    assert!(best.wood.unwrap() > 0.9);
    assert!((best.score - by_both.confidence.unwrap()).abs() < 1e-12);

    pick(&bench, &["a"], &["--wood", &mask(&bench, 320, &[])]).succeeded();
    let nowhere = record(&bench).picks[0].clone();
    assert_eq!(nowhere.status.name(), "no_branch", "{nowhere:?}");
    assert!(nowhere.confidence.unwrap() < 0.35);
}

#[test]
fn a_mask_that_does_not_fit_is_refused() {
    let bench = Bench::new();
    let mask = mask(&bench, 300, &[100]);
    pick(&bench, &["a"], &["--wood", &mask]).refused(&["'a'", "300 x 240", "320 x 240"]);
    pick(&bench, &["a"], &["--wood", &bench.text("none.png")]).refused(&["none.png"]);
    pick(&bench, &["a", "a"], &["--wood", &mask]).refused(&["--wood", "one frame"]);
}

#[test]
fn the_built_in_segmenter_is_run_about_the_apples() {
    let bench = Bench::new();
    let run = pick(
        &bench,
        &["a"],
        &["--segmenter", "built-in", "--runtime", "embedded"],
    );
    run.succeeded();
    let candidates = record(&bench).picks[0].candidates.clone();
    assert!(!candidates.is_empty() && candidates.iter().all(|c| c.wood.is_some()));
    let none = bench.text("none.onnx");
    pick(&bench, &["a"], &["--segmenter", &none]).refused(&["none.onnx"]);
}
