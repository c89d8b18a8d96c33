//! Masks as the truth for wood, and what does not count.

use super::evaluated::{SIZE, bench, files, is, line, mask, text, written};
use crate::binary::{pomona, tree};
use pomona_cloud::{ColorImage, GrayImage};
use std::fs;

#[test]
fn masks_are_a_truth_as_strokes_are() {
    let dir = bench();
    fs::create_dir(dir.path().join("true")).unwrap();
    for name in ["tree_1", "other_1"] {
        // The band of the branch: the rows 28 to 32.
        let rows: Vec<(usize, usize)> = (28..33).map(|row| (row, 96)).collect();
        mask(&dir, &format!("true/{name}.wood.png"), &rows);
    }
    let truth = ["--truth-masks".to_owned(), text(&dir, "true")];
    let truth = truth.each_ref().map(String::as_str);
    let run = pomona(&line(&dir, &["good", "poor"], &truth)).succeeded();
    let title = "Wood in true: 2 images of 2 photographs, masks";
    assert!(run.out.contains(title), "{}", run.out);
    let evaluation = written(&dir);
    assert_eq!(evaluation["strokes"]["truth"], "masks");
    assert_eq!(evaluation["strokes"]["images"], 2);
    is(&evaluation["strokes"]["wood_length_px"], 2.0 * 96.0);
    let [good, poor] = [0, 1].map(|i| &evaluation["results"][i]);
    is(&good["recall_wide"]["value"], 1.0);
    is(&good["precision"]["value"], 1.0);
    is(&good["iou"]["value"], 0.2);
    is(&poor["recall_wide"]["value"], 0.5);
    is(&poor["precision"]["value"], 45.0 / 141.0);
    assert!(good.get("posts").is_none());
    let expected = ["report.html", "segmentation.json", "worst-2.png"];
    assert_eq!(files(&dir), expected, "the first misses nothing");

    let small = GrayImage {
        width: 3,
        height: 2,
        values: vec![0; 6],
    };
    small
        .write(dir.path().join("true/tree_1.wood.png"))
        .unwrap();
    let before = tree(dir.path());
    let refused = |words: &[&str]| pomona(&line(&dir, &["good"], &truth)).refused(words);
    refused(&[
        "tree_1.wood.png",
        "3x2 pixels for an image of 96x72",
        "own size",
    ]);
    let gone = ["--truth-masks".to_owned(), text(&dir, "gone")];
    pomona(&line(&dir, &["good"], &gone.each_ref().map(String::as_str)))
        .refused(&["gone", "--truth-masks"]);
    assert_eq!(tree(dir.path()), before);
}

#[test]
fn the_frames_that_scenes_writes_have_their_truth_with_them() {
    let dir = tempfile::tempdir().unwrap();
    let scenes = text(&dir, "scenes");
    pomona(&["scenes", "orchard", "--count", "1", "--out", &scenes]).succeeded();
    let frame = fs::read_dir(&scenes).unwrap().next().unwrap().unwrap();
    let name = frame.file_name().into_string().unwrap();
    let classes = GrayImage::read(frame.path().join("classes.png")).unwrap();
    let mut wood = classes.clone();
    for value in &mut wood.values {
        *value = if *value == 1 { 255 } else { 0 };
    }
    fs::create_dir(dir.path().join("perfect")).unwrap();
    let mask = dir.path().join(format!("perfect/{name}.wood.png"));
    wood.write(mask).unwrap();
    let evaluation = pomona(&[
        "evaluate",
        "--segmentation",
        &*scenes,
        "--truth-masks",
        &*scenes,
        "--masks",
        &*text(&dir, "perfect"),
        "--json",
        "--out",
        &*text(&dir, "out"),
    ])
    .succeeded()
    .json();
    assert_eq!(evaluation["strokes"]["images"], 1);
    let perfect = &evaluation["results"][0];
    for figure in ["recall_wide", "precision", "iou"] {
        is(&perfect[figure]["value"], 1.0);
    }
    is(&perfect["calibration_error"], 0.0);
    assert_eq!(perfect["worst"].as_array().unwrap().len(), 0);
}

#[test]
fn what_is_outside_of_the_discs_is_grey_in_the_pictures_of_the_worst() {
    let dir = tempfile::tempdir().unwrap();
    let frame = dir.path().join("set/frame");
    for folder in [&frame, &dir.path().join("set/all")] {
        fs::create_dir_all(folder).unwrap();
    }
    ColorImage::filled(SIZE[0], SIZE[1], [90, 200, 90])
        .write(frame.join("color.png"))
        .unwrap();
    // One apple in the middle, of radius 8.
    fs::write(frame.join("boxes.txt"), "0 0.5 0.5 0.1667 0.2222\n").unwrap();
    fs::write(
        dir.path().join("set/strokes.txt"),
        "image frame\nwood 0,10.5,2 96,10.5,2\n",
    )
    .unwrap();
    let rows: Vec<(usize, usize)> = (0..SIZE[1]).map(|row| (row, SIZE[0])).collect();
    mask(&dir, "set/all/frame.wood.png", &rows);
    let reds = |more: &[&str]| {
        pomona(&line(&dir, &["set/all"], more)).succeeded();
        let sheet = ColorImage::read(dir.path().join("out/worst-1.png")).unwrap();
        let is_red = |p: &&[u8; 3]| p[0] > 150 && p[1] < 120;
        let is_grey = |p: &&[u8; 3]| p[0].abs_diff(p[2]) < 3 && p[1] > p[0] && p[1] < 170;
        let count = |of: &dyn Fn(&&[u8; 3]) -> bool| sheet.pixels.iter().filter(|p| of(p)).count();
        (count(&is_red), count(&is_grey))
    };
    let (whole, _) = reds(&[]);
    let (within, grey) = reds(&["--apple-radii", "1"]);
    assert!(within > 0 && within * 10 < whole, "{within} of {whole}");
    assert!(grey > whole / 2, "{grey} of {whole}");
}
