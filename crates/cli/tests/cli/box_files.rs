//! Box files of other programs: which image, which class, and what is said about the rest.

use crate::binary::{Run, pomona};
use crate::scene::{Bench, frame};
use pomona_cloud::PixelBox;
use serde_json::{Value, json};

/// The apple of the frame.
fn apple() -> PixelBox {
    frame("a").boxes.unwrap().remove(0)
}

/// A frame without boxes of its own.
fn bench() -> Bench {
    let bench = Bench::new();
    std::fs::remove_file(bench.path("a/boxes.xml")).unwrap();
    bench
}

#[track_caller]
fn pick(bench: &Bench, more: &[&str]) -> Run {
    let (frame, out) = (bench.text("a"), bench.text("out"));
    let fixed = [
        "pick",
        &frame,
        "--no-picture",
        "--clouds",
        "none",
        "--out",
        &out,
        "--runtime",
        "embedded",
    ];
    // The inference backend says nothing where no detector runs.
    let fixed = if more.contains(&"--detect") {
        &fixed[..]
    } else {
        &fixed[..7]
    };
    pomona(&[fixed, more].concat())
}

/// How many apples the frame has with the file `name` in its folder, and the codes of what is said about it.
#[track_caller]
fn picked(bench: &Bench, name: &str, content: &str, more: &[&str]) -> (usize, Vec<String>) {
    bench.write(&format!("a/{name}"), content);
    let run = pick(bench, more);
    assert_eq!(run.code, 0, "{}", run.err);
    let record = bench.read_json("out/picks.json");
    let codes: Vec<String> = match &record["warnings"] {
        Value::Array(warnings) => warnings
            .iter()
            .map(|w| w["code"].as_str().unwrap().to_owned())
            .collect(),
        _ => Vec::new(),
    };
    for code in &codes {
        assert!(run.err.contains(code.as_str()), "{code}: {}", run.err);
    }
    if more.is_empty() {
        let inspected = pomona(&["inspect", &bench.text("a"), "--json"])
            .succeeded()
            .json();
        assert_eq!(inspected.get("warnings"), record.get("warnings"));
        assert_eq!(
            inspected["boxes"],
            record["picks"].as_array().unwrap().len()
        );
    }
    std::fs::remove_file(bench.path(&format!("a/{name}"))).unwrap();
    (record["picks"].as_array().unwrap().len(), codes)
}

/// The frame with the file `name` in its folder is refused with these words, and so by `inspect`.
#[track_caller]
fn refused(bench: &Bench, name: &str, content: &str, words: &[&str]) {
    bench.write(&format!("a/{name}"), content);
    pick(bench, &[]).refused(words);
    pomona(&["inspect", &bench.text("a")]).refused(words);
    std::fs::remove_file(bench.path(&format!("a/{name}"))).unwrap();
}

fn voc(objects: &[(&str, &PixelBox)]) -> String {
    let object = |(class, b): &(&str, &PixelBox)| {
        format!(
            "<object><name>{class}</name><part><name>stem</name><bndbox><xmin>1</xmin><ymin>1</ymin><xmax>5</xmax>\
             <ymax>5</ymax></bndbox></part><bndbox><xmin>{}</xmin><ymin>{}</ymin><xmax>{}</xmax><ymax>{}</ymax>\
             </bndbox></object>",
            b.x_min, b.y_min, b.x_max, b.y_max
        )
    };
    let objects: String = objects.iter().map(object).collect();
    format!("<annotation><filename>color.png</filename>{objects}</annotation>")
}

fn coco_box(b: &PixelBox) -> Value {
    json!([b.x_min, b.y_min, b.width(), b.height()])
}

fn coco(images: &Value, annotations: &Value, categories: &Value) -> String {
    json!({ "images": images, "annotations": annotations, "categories": categories }).to_string()
}

#[test]
fn leaves_and_trunks_are_no_apples() {
    let (bench, apple) = (bench(), apple());
    let text = voc(&[
        ("apple", &apple),
        ("leaf", &apple),
        ("leaf", &apple),
        ("trunk", &apple),
    ]);
    assert_eq!(
        picked(&bench, "boxes.xml", &text, &[]),
        (1, vec!["boxes_left_out".to_owned()])
    );
    bench.write("a/boxes.xml", &text);
    let run = pick(&bench, &[]);
    assert!(
        run.err
            .contains("1 box is taken; left out are 2 of `leaf`, 1 of `trunk`"),
        "{}",
        run.err
    );
    assert_eq!(
        picked(&bench, "boxes.xml", &text, &["--class", "leaf"]).0,
        2
    );
    refused(
        &bench,
        "boxes.xml",
        &voc(&[("leaf", &apple)]),
        &["boxes.xml", "1 of `leaf`", "--class"],
    );
    // Names that are the apples' own.
    assert_eq!(
        picked(
            &bench,
            "boxes.xml",
            &voc(&[("7", &apple), ("12", &apple)]),
            &[]
        ),
        (2, vec![])
    );

    let categories = json!([{"id": 1, "name": "Apple_Ripe"}, {"id": 2, "name": "trunk"}]);
    let images = json!([{"id": 1, "file_name": "color.png"}]);
    let annotation = |category: u32, crowd: u32| json!({"image_id": 1, "category_id": category, "bbox": coco_box(&apple), "iscrowd": crowd});
    let text = coco(
        &images,
        &json!([annotation(1, 0), annotation(2, 0)]),
        &categories,
    );
    assert_eq!(
        picked(&bench, "boxes.json", &text, &[]),
        (1, vec!["boxes_left_out".to_owned()])
    );
    let crowd = coco(
        &images,
        &json!([annotation(1, 0), annotation(1, 1)]),
        &categories,
    );
    assert_eq!(
        picked(&bench, "boxes.json", &crowd, &[]),
        (1, vec!["boxes_left_out".to_owned()])
    );
    let trunks = coco(&images, &json!([annotation(2, 0)]), &categories);
    assert_eq!(
        picked(&bench, "boxes.json", &trunks, &[]),
        (0, vec!["boxes_left_out".to_owned()])
    );
}

#[test]
fn a_data_set_gives_the_boxes_of_the_frame_s_own_image() {
    let (bench, apple) = (bench(), apple());
    let annotation =
        |image: Value| json!({"image_id": image, "category_id": 1, "bbox": coco_box(&apple)});
    let categories = json!([{"id": 1, "name": "apple"}]);
    let images =
        |first: &str| json!([{"id": 1, "file_name": first}, {"id": 2, "file_name": "b.png"}]);
    let of_both = json!([
        annotation(json!(1)),
        annotation(json!(2)),
        annotation(json!(2))
    ]);
    for name in ["color.png", "a/color.png", "a.jpg"] {
        let text = coco(&images(name), &of_both, &categories);
        assert_eq!(
            picked(&bench, "boxes.json", &text, &[]),
            (1, vec![]),
            "{name}"
        );
    }
    let other = coco(
        &images("color.png"),
        &json!([annotation(json!(2))]),
        &categories,
    );
    assert_eq!(
        picked(&bench, "boxes.json", &other, &[]),
        (0, vec!["no_boxes_of_image".to_owned()])
    );
    let strange = coco(&images("c.png"), &of_both, &categories);
    refused(
        &bench,
        "boxes.json",
        &strange,
        &["boxes.json", "c.png, b.png", "a/color.png"],
    );
    let unlisted = coco(
        &images("color.png"),
        &json!([annotation(json!(7))]),
        &categories,
    );
    refused(
        &bench,
        "boxes.json",
        &unlisted,
        &["image_id 7 is of no image"],
    );

    for (image, category) in [
        (json!("color"), json!(1)),
        (json!(1), json!(1.0)),
        (json!("1"), json!("x")),
    ] {
        let text = coco(
            &json!([{"id": image, "file_name": "color.png", "width": 320.0, "height": 240}]),
            &json!([{"id": "0", "image_id": image, "category_id": category, "bbox": coco_box(&apple)}]),
            &json!([{"id": category, "name": "apple"}]),
        );
        assert_eq!(
            picked(&bench, "boxes.json", &text, &[]),
            (1, vec![]),
            "{text}"
        );
    }
    let renamed = coco(
        &json!([{"id": 1, "file_name": "IMG_7.jpg"}]),
        &json!([annotation(json!(1))]),
        &categories,
    );
    assert_eq!(
        picked(&bench, "boxes.json", &renamed, &[]),
        (1, vec!["box_image_assumed".to_owned()])
    );
}

#[test]
fn yolo_polygons_pixels_and_other_orders() {
    let (bench, b) = (bench(), apple());
    let [x0, y0, x1, y1] = [
        b.x_min / 320.0,
        b.y_min / 240.0,
        b.x_max / 320.0,
        b.y_max / 240.0,
    ];
    let polygon = format!("0 {x0} {y0} {x1} {y0} {x1} {y1} {x0} {y1}\n");
    assert_eq!(picked(&bench, "boxes.txt", &polygon, &[]), (1, vec![]));
    bench.write("a/boxes.txt", &polygon);
    pick(&bench, &[]);
    let of_polygon = bench.read_json("out/picks.json")["picks"][0]["box"].clone();
    for edge in [("x_min", b.x_min), ("y_max", b.y_max)] {
        assert!(
            (of_polygon[edge.0].as_f64().unwrap() - edge.1).abs() < 1e-9,
            "{of_polygon}"
        );
    }
    let pixels = "0 160 120 40 40\n";
    refused(
        &bench,
        "boxes.txt",
        pixels,
        &["boxes.txt", "line 1", "160", "pixels", "320", "240"],
    );
    let corners = "0 0.4 0.4 0.5 0.6\n0 0.8 0.5 0.95 0.6\n";
    assert_eq!(
        picked(&bench, "boxes.txt", corners, &[]).1,
        ["box_order_doubtful"]
    );
    let score_first = "0 0.83 0.44 0.59 0.08 0.1\n0 0.83 0.5 0.5 0.1 0.12\n";
    assert_eq!(
        picked(&bench, "boxes.txt", score_first, &[]).1,
        ["box_order_doubtful"]
    );
    // Numbers tell no apple from a leaf, unless their names lie beside them.
    let two = format!("0 {x0} {y0} {x1} {y0} {x1} {y1}\n1 0.5 0.5 0.1 0.1\n");
    refused(
        &bench,
        "boxes.txt",
        &two,
        &["1 of class 0, 1 of class 1", "--class"],
    );
    assert_eq!(picked(&bench, "boxes.txt", &two, &["--class", "1"]).0, 1);
    bench.write("a/classes.txt", "leaf\napple\n");
    assert_eq!(
        picked(&bench, "boxes.txt", &two, &[]),
        (1, vec!["boxes_left_out".to_owned()])
    );
}

#[test]
fn files_of_labelme_label_studio_and_cvat() {
    let (bench, b) = (bench(), apple());
    let labelme = json!({
        "version": "5.5.0", "imagePath": "color.png", "imageData": null, "imageWidth": 320, "imageHeight": 240,
        "shapes": [
            {"label": "apple", "shape_type": "rectangle", "points": [[b.x_max, b.y_min], [b.x_min, b.y_max]]},
            {"label": "leaf", "shape_type": "polygon", "points": [[1, 1], [9, 1], [5, 8]]}]
    });
    let [x, y] = [b.x_min / 3.2, b.y_min / 2.4];
    let region = |class: &str| {
        json!({"type": "rectanglelabels", "original_width": 320, "original_height": 240, "value": {
            "x": x, "y": y, "width": b.width() / 3.2, "height": b.height() / 2.4, "rotation": 0,
            "rectanglelabels": [class]}})
    };
    let studio = json!([
        {"id": 1, "data": {"image": "/data/upload/2/0123abcd-color.png"},
         "annotations": [{"result": [region("apple"), region("trunk")]}]},
        {"id": 2, "data": {"image": "/data/upload/2/0123abcd-b.png"}, "annotations": []}]);
    for text in [labelme.to_string(), studio.to_string()] {
        assert_eq!(
            picked(&bench, "boxes.json", &text, &[]),
            (1, vec!["boxes_left_out".to_owned()]),
            "{text}"
        );
    }
    let cvat = format!(
        "<annotations><version>1.1</version><image id='0' name='color.png' width='320' height='240'>\
         <box label='apple' xtl='{}' ytl='{}' xbr='{}' ybr='{}'/></image><image id='1' name='b.png'/></annotations>",
        b.x_min, b.y_min, b.x_max, b.y_max
    );
    assert_eq!(picked(&bench, "boxes.xml", &cvat, &[]), (1, vec![]));
}

#[test]
fn options_of_the_detector_beside_boxes_are_used_or_refused() {
    let (bench, apple) = (bench(), apple());
    let text =
        voc(&[("apple", &apple)]).replace("</name><part>", "</name><score>0.4</score><part>");
    assert_eq!(
        picked(&bench, "boxes.xml", &text, &["--threshold", "0.3"]),
        (1, vec![])
    );
    assert_eq!(
        picked(&bench, "boxes.xml", &text, &["--threshold", "0.5"]),
        (0, vec!["boxes_left_out".to_owned()])
    );
    bench.write("a/boxes.xml", &text);
    pick(&bench, &["--class", "pear"]).refused(&["boxes.xml", "`pear`", "1 of `apple`"]);
    for option in [
        ["--model", "built-in"],
        ["--nms-iou", "0.5"],
        ["--tiles", "2x2"],
        ["--runtime", "embedded"],
    ] {
        pick(&bench, &option).refused(&[option[0], "--detect"]);
    }
    pick(
        &bench,
        &["--boxes", &bench.text("a/boxes.xml"), "--model", "built-in"],
    )
    .refused(&["--model"]);
    // Boxes that are not asked for cannot be in the way.
    bench.write("a/boxes.xml", "<broken");
    pick(&bench, &["--detect", "--model", "built-in"]).succeeded();
    pomona(&["convert", &bench.text("a"), &bench.text("a.ply")]).succeeded();
}

#[test]
fn what_detect_writes_is_taken_by_pick() {
    let bench = bench();
    frame("b").write(bench.path("b")).unwrap();
    let (a, b, out) = (bench.text("a"), bench.text("b"), bench.text("boxes"));
    for format in ["coco", "voc", "yolo"] {
        pomona(&[
            "detect",
            &a,
            &b,
            "--runtime",
            "embedded",
            "--format",
            format,
            "--no-picture",
            "--out",
            &out,
        ])
        .succeeded();
        let record = bench.read_json("boxes/detections.json");
        let found = record["images"][0]["detections"].as_array().unwrap().len();
        assert!(found > 0, "nothing to compare");
        let own = match format {
            "coco" => "boxes.json",
            "voc" => "a.xml",
            _ => "a.txt",
        };
        for name in ["detections.json", own] {
            let path = bench.text(&format!("boxes/{name}"));
            let run = pick(&bench, &["--boxes", &path]);
            assert_eq!(
                (run.code, &*run.err),
                (0, ""),
                "{format} {name}: {}",
                run.err
            );
            assert_eq!(
                bench.read_json("out/picks.json")["picks"]
                    .as_array()
                    .unwrap()
                    .len(),
                found,
                "{format} {name}"
            );
        }
    }
    std::fs::copy(
        bench.path("boxes/detections.json"),
        bench.path("a/detections.json"),
    )
    .unwrap();
    let facts = pomona(&["inspect", &bench.text("a/detections.json"), "--json"])
        .succeeded()
        .json();
    assert_eq!(
        (&facts["kind"], &facts["images"]),
        (&json!("detections"), &json!(2))
    );
    pomona(&[
        "detect",
        &a,
        &b,
        "--runtime",
        "embedded",
        "--no-picture",
        "--out",
        &out,
    ])
    .succeeded();
    let facts = pomona(&["inspect", &bench.text("boxes/boxes.json"), "--json"])
        .succeeded()
        .json();
    assert_eq!(
        (&facts["kind"], &facts["classes"]),
        (&json!("boxes of images"), &json!(["apple"]))
    );
}
