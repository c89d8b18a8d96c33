//! Every way in which a frame can be bad: one message, exit code 2, and nothing written.

use crate::binary::{pomona, tree};
use crate::scene::{Bench, pixel_box, scene};
use pomona_cloud::{ColorImage, DepthImage};

/// Picks the frame after `spoil` and checks that it is refused with `words`.
#[track_caller]
fn refused(spoil: impl FnOnce(&Bench), words: &[&str]) {
    let bench = Bench::new();
    spoil(&bench);
    let before = tree(bench.root());
    let run = pomona(&[
        "pick",
        &bench.text("a"),
        "--json",
        "--out",
        &bench.text("out/deep"),
    ]);
    run.refused(words);
    assert_eq!(tree(bench.root()), before, "something was written");
}

fn cut(bench: &Bench, name: &str) {
    let bytes = bench.read(name);
    bench.write(name, &bytes[..bytes.len() / 2]);
}

fn remove(bench: &Bench, name: &str) {
    std::fs::remove_file(bench.path(name)).unwrap();
}

#[test]
fn missing_files() {
    refused(
        |b| std::fs::remove_dir_all(b.path("a")).unwrap(),
        &["a: cannot be read", "check the path"],
    );
    refused(
        |b| remove(b, "a/color.png"),
        &["no color.png or color.jpg in this folder"],
    );
    refused(
        |b| remove(b, "a/depth.png"),
        &["no depth.png in this folder"],
    );
    refused(|b| remove(b, "a/camera.json"), &["no camera.json"]);
    // Without boxes a detector is wanted, and this one has no runtime.
    let bench = Bench::new();
    remove(&bench, "a/boxes.xml");
    let before = tree(bench.root());
    let (frame, out) = (bench.text("a"), bench.text("out/deep"));
    let runtime = bench.text("libnowhere.so");
    pomona(&["pick", &frame, "--out", &out, "--runtime", &runtime])
        .refused(&["no boxes", "--boxes"]);
    assert_eq!(tree(bench.root()), before, "something was written");
}

#[test]
fn truncated_images() {
    refused(|b| cut(b, "a/color.png"), &["color.png", "damaged"]);
    refused(|b| cut(b, "a/depth.png"), &["depth.png", "damaged"]);
    refused(
        |b| b.write("a/color.png", ""),
        &["color.png", "neither a PNG nor a JPEG"],
    );
}

#[test]
fn depth_of_another_size_or_kind() {
    let small = |b: &Bench| {
        DepthImage::empty(160, 120)
            .write(b.path("a/depth.png"))
            .unwrap();
    };
    refused(small, &["320x240", "160x120", "register depth to colour"]);
    let eight_bit = |b: &Bench| {
        ColorImage::filled(320, 240, [9; 3])
            .write(b.path("a/depth.png"))
            .unwrap();
    };
    refused(eight_bit, &["depth.png", "8-bit", "16-bit grey"]);
}

#[test]
fn cameras_that_cannot_be_computed_with() {
    let edit = |from: &'static str, to: &'static str| {
        move |b: &Bench| {
            let text = String::from_utf8(b.read("a/camera.json")).unwrap();
            assert!(text.contains(from), "{text}");
            b.write("a/camera.json", text.replace(from, to));
        }
    };
    refused(
        edit("\"fx\": 540.0", "\"fx\": 0.0"),
        &["camera.json", "`fx` is 0", "positive"],
    );
    refused(
        edit("\"fx\": 540.0", "\"fx\": \"wide\""),
        &["camera.json", "line"],
    );
    refused(edit("\"fx\"", "\"focus\""), &["camera.json"]);
    refused(edit("320", "640"), &["640x240", "320x240"]);
    refused(
        |b| b.write("a/camera.json", "{\"schema\": \"pomona.picks/1\"}"),
        &["camera.json"],
    );
    refused(
        |b| b.write("a/camera.json", "not json"),
        &["camera.json", "line 1"],
    );
}

fn boxes_at(edges: [i32; 4]) -> String {
    let [x0, y0, x1, y1] = edges;
    format!(
        "<annotation><object><name>n7</name><bndbox><xmin>{x0}</xmin><ymin>{y0}</ymin>\
         <xmax>{x1}</xmax><ymax>{y1}</ymax></bndbox></object></annotation>"
    )
}

#[test]
fn boxes_that_hold_nothing() {
    let boxes = |edges| move |b: &Bench| b.write("a/boxes.xml", boxes_at(edges));
    refused(
        boxes([400, 10, 450, 60]),
        &["boxes.xml", "`n7`", "no pixel of the 320x240 image"],
    );
    refused(
        boxes([60, 10, 20, 60]),
        &["boxes.xml", "`n7`", "inverted", "smaller edge first"],
    );
    refused(
        |b| b.write("a/boxes.xml", "<annotation><object/></annotation>"),
        &["boxes.xml", "line 1"],
    );
    refused(|b| cut(b, "a/boxes.xml"), &["boxes.xml", "XML"]);
    let coco = |b: &Bench| {
        remove(b, "a/boxes.xml");
        b.write(
            "a/boxes.json",
            "{\"schema\": \"pomona.truth/1\", \"apples\": []}",
        );
    };
    refused(coco, &["boxes.json", "annotations"]);
}

#[test]
fn boxes_given_apart_are_checked_too() {
    let bench = Bench::new();
    bench.write("far.xml", boxes_at([400, 10, 450, 60]));
    let run = |boxes: &str| {
        pomona(&[
            "pick",
            &bench.text("a"),
            "--boxes",
            &bench.text(boxes),
            "--out",
            &bench.text("out"),
        ])
    };
    run("far.xml").refused(&["far.xml", "`n7`"]);
    run("gone.xml").refused(&["gone.xml", "cannot be read"]);
    assert!(!bench.path("out").exists());
}

#[test]
fn transforms_and_settings_of_another_form() {
    let bench = Bench::new();
    let before = tree(bench.root()).len();
    let run = |flag: &str, value: &str| {
        pomona(&[
            "pick",
            &bench.text("a"),
            flag,
            value,
            "--out",
            &bench.text("out"),
        ])
    };
    bench.write("t.json", "{\"schema\": \"pomona.picks/1\"}");
    run("--transform", &bench.text("t.json")).refused(&["t.json", "schema"]);
    run("--transform", &bench.text("gone.json")).refused(&["gone.json", "cannot be read"]);
    run("--config", &bench.text("gone.toml")).refused(&["gone.toml"]);
    run("--set", "fruit.radius_max_m=0.001").refused(&["fruit.radius_max_m", "0.001"]);
    run("--set", "fruit.radius=1").refused(&["fruit.radius_max_m"]);
    run("--radius-min-mm", "-3").refused(&["fruit.radius_min_m"]);
    assert_eq!(tree(bench.root()).len(), before + 1);
}

#[test]
fn a_box_that_reaches_over_the_edge_is_cut_and_not_refused() {
    let bench = Bench::new();
    let mut over = scene("over").frame;
    over.boxes = Some(vec![pixel_box("edge", [-20.0, -20.0, 12.0, 12.0])]);
    over.write(bench.path("over")).unwrap();
    let (frame, out) = (bench.text("over"), bench.text("out"));
    let taken = ["--set", "robust.check_boxes=false"];
    pomona(&[&["pick", &frame, "--out", &out], &taken[..]].concat()).succeeded();
}
