//! Data sets and box files in the forms that they come in, whole and damaged.

use pomona_cloud::{ColorImage, LabelKind, LabelledBox};
use pomona_detect::ClassChoice;
use pomona_labels::{LabelForm, LabelledDataset, LabelledImage, read_detections};
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// A folder with these files; a picture of 40 × 20 pixels for each name that ends so.
fn folder(files: &[(&str, &str)]) -> TempDir {
    let dir = tempfile::tempdir().unwrap();
    for (name, text) in files {
        let path = dir.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        if path.extension().is_some_and(|e| e == "png") {
            ColorImage::filled(40, 20, [90; 3]).write(&path).unwrap();
        } else {
            std::fs::write(&path, text).unwrap();
        }
    }
    dir
}

fn read(dir: &TempDir) -> LabelledDataset {
    LabelledDataset::read(dir.path(), None).unwrap()
}

/// Checks that a folder is refused by a message with all of these words.
#[track_caller]
fn refused(files: &[(&str, &str)], words: &[&str]) {
    let dir = folder(files);
    let message = LabelledDataset::read(dir.path(), None)
        .unwrap_err()
        .to_string();
    for word in words {
        assert!(message.contains(word), "no `{word}` in: {message}");
    }
}

const YOLO: &str = "0 0.5 0.5 0.25 0.5\n1 0.25 0.5 0.1 0.2\n";
const VOC: &str = "<annotation><size><width>40</width><height>20</height></size><object><name>apple</name>\
    <difficult>1</difficult><bndbox><xmin>15</xmin><ymin>5</ymin><xmax>25</xmax><ymax>15</ymax></bndbox></object>\
    <object><name>leaf</name><bndbox><xmin>1</xmin><ymin>5</ymin><xmax>9</xmax><ymax>15</ymax></bndbox></object></annotation>";
const COCO: &str = r#"{"images":[{"id":7,"file_name":"b.png","width":40,"height":20},{"id":3,"file_name":"a.png"}],
    "annotations":[{"id":1,"image_id":7,"category_id":5,"bbox":[15,5,10,10]},{"id":2,"image_id":7,"category_id":6,"bbox":[1,5,8,10]}],
    "categories":[{"id":5,"name":"apple"},{"id":6,"name":"leaf"}]}"#;

#[test]
fn yolo_in_folders_with_an_image_that_is_background() {
    let dir = folder(&[
        ("images/b.png", ""),
        ("images/sub/a.png", ""),
        ("images/none.png", ""),
        ("labels/b.txt", YOLO),
        ("labels/sub/a.txt", ""),
        ("labels/classes.txt", "apple\nleaf\n"),
    ]);
    let dataset = read(&dir);
    let names: Vec<&str> = dataset.images.iter().map(|i| i.name.as_str()).collect();
    assert_eq!(names, ["b.png", "none.png", "sub/a.png"]);
    assert_eq!(
        (dataset.form, dataset.without_label_file),
        (LabelForm::LabelFolder, 1)
    );
    assert_eq!(dataset.classes.into_iter().collect::<Vec<_>>(), [0, 1]);
    let label = &dataset.images[0].boxes[1];
    assert_eq!(
        (label.class_number, label.class_name.as_deref()),
        (Some(1), Some("leaf"))
    );
    assert_eq!(dataset.images[0].boxes[0].bounds.x_min, 15.0);

    for class in [ClassChoice::Number(1), ClassChoice::Name("leaf".to_owned())] {
        let one = LabelledDataset::read(dir.path(), Some(&class)).unwrap();
        assert_eq!(one.images[0].boxes.len(), 1);
    }
    let wrong = LabelledDataset::read(dir.path(), Some(&ClassChoice::Name("pear".to_owned())));
    let message = wrong.unwrap_err().to_string();
    assert!(
        message.contains("`pear`") && message.contains("0 `apple`"),
        "{message}"
    );
}

#[test]
fn labels_beside_their_images() {
    let dir = folder(&[
        ("a.png", ""),
        ("a.txt", YOLO),
        ("b.png", ""),
        ("b.xml", VOC),
        ("README.txt", "mine"),
    ]);
    let dataset = read(&dir);
    assert_eq!(
        (dataset.form, dataset.images.len()),
        (LabelForm::BesideImages, 2)
    );
    assert_eq!(dataset.images[1].boxes[0].kind, LabelKind::Difficult);
}

#[test]
fn voc_as_its_challenge_keeps_it() {
    let dir = folder(&[("JPEGImages/a.png", ""), ("Annotations/a.xml", VOC)]);
    let dataset = read(&dir);
    assert_eq!(
        dataset.images[0].boxes[1].class_name.as_deref(),
        Some("leaf")
    );
    assert!(dataset.classes.is_empty());
}

#[test]
fn coco_with_its_images_beside_or_a_folder_up() {
    for (file, images) in [
        ("annotations.json", ""),
        ("mine.json", "images/"),
        ("annotations/instances_val2017.json", "val2017/"),
    ] {
        let (a, b) = (format!("{images}a.png"), format!("{images}b.png"));
        let dir = folder(&[(file, COCO), (&a, ""), (&b, "")]);
        let dataset = read(&dir);
        assert_eq!(dataset.form, LabelForm::Coco);
        let labels: Vec<usize> = dataset.images.iter().map(|i| i.boxes.len()).collect();
        assert_eq!(labels, [0, 2], "{file}");
        let named = LabelledDataset::read(dir.path().join(file), None).unwrap();
        assert_eq!(named, dataset);
    }
}

#[test]
fn frames_alone_and_together() {
    let dir = folder(&[
        ("one/color.png", ""),
        ("one/boxes.xml", VOC),
        ("two/color.png", ""),
        ("two/boxes.txt", YOLO),
        ("three/color.png", ""),
        ("three/depth.png", ""),
        ("calipers.csv", "box_name,diameter_mm\n"),
    ]);
    let dataset = read(&dir);
    assert_eq!(
        (dataset.form, dataset.frames_without_boxes),
        (LabelForm::Frames, 1)
    );
    let names: Vec<&str> = dataset.images.iter().map(|i| i.name.as_str()).collect();
    assert_eq!(names, ["one", "two"]);
    let file = dir.path().join("found.json");
    let found = COCO
        .replace("b.png", "two/color.png")
        .replace("a.png", "one/color.png");
    std::fs::write(&file, found).unwrap();
    let detections = read_detections(&file, &dataset, None).unwrap();
    let counts: Vec<usize> = detections.iter().map(Vec::len).collect();
    assert_eq!(counts, [0, 2]);
    let one = LabelledDataset::read(dir.path().join("one"), None).unwrap();
    assert_eq!(one.images[0].boxes.len(), 2);
    let message = LabelledDataset::read(dir.path().join("three"), None)
        .unwrap_err()
        .to_string();
    assert!(
        message.contains("boxes.xml") && message.contains("three"),
        "{message}"
    );
}

#[test]
fn bad_folders_are_refused_with_file_and_remedy() {
    refused(
        &[("notes.md", "")],
        &["neither images with labels", "give such a folder"],
    );
    refused(
        &[("images/a.png", ""), ("labels/b.txt", YOLO)],
        &["b.txt", "without its image", "remove the label"],
    );
    refused(
        &[("a.png", ""), ("b.png", ""), ("a.txt", YOLO)],
        &["b.png", "no label file", "add an empty one"],
    );
    refused(
        &[("a.png", ""), ("a.txt", YOLO), ("a.xml", VOC)],
        &["a.xml", "a.txt", "keep one of the two"],
    );
    refused(
        &[("images/a.png", ""), ("labels/a.txt", "0 0.5\n")],
        &["a.txt", "line 1"],
    );
    refused(
        &[
            ("images/a.png", ""),
            ("labels/a.txt", "0 2.5 0.5 0.1 0.1\n"),
        ],
        &["a.txt", "holds no pixel"],
    );
    refused(
        &[("images/a.txt", ""), ("labels/a.txt", YOLO)],
        &["give such a folder"],
    );
    let unknown = COCO.replace(
        "\"image_id\":7,\"category_id\":6",
        "\"image_id\":8,\"category_id\":6",
    );
    refused(
        &[("annotations.json", &unknown), ("a.png", ""), ("b.png", "")],
        &["`annotations`[1]", "image_id 8"],
    );
    refused(
        &[("annotations.json", COCO), ("a.png", "")],
        &["b.png", "annotations.json", "put the images there"],
    );
    refused(
        &[("annotations.json", COCO), ("b.png", "")],
        &["a.png", "check the path"],
    );
    refused(
        &[("annotations.json", "{\"images\": ["), ("a.png", "")],
        &["annotations.json", "line 1"],
    );
    let other = COCO.replace("\"width\":40", "\"width\":640");
    refused(
        &[("annotations.json", &other), ("a.png", ""), ("b.png", "")],
        &["640x20", "40x20"],
    );
    refused(
        &[
            ("x.json", COCO),
            ("y.json", COCO),
            ("a.png", ""),
            ("b.png", ""),
        ],
        &["several COCO files", "x.json", "y.json"],
    );
    let gone = LabelledDataset::read("no/such/folder", None)
        .unwrap_err()
        .to_string();
    assert!(gone.contains("no/such/folder"), "{gone}");
}

/// What is read for a data set with the images `a.png` (no label) and `b.png`.
fn detections(name: &str, text: &str) -> Result<Vec<Vec<f64>>, String> {
    detections_of(name, text, None)
}

fn detections_of(
    name: &str,
    text: &str,
    class: Option<&ClassChoice>,
) -> Result<Vec<Vec<f64>>, String> {
    let dir = folder(&[("annotations.json", COCO), ("a.png", ""), ("b.png", "")]);
    let dataset = read(&dir);
    let found = folder(&[(name, text)]);
    let path = if name.contains('/') {
        found.path().join(name.split('/').next().unwrap())
    } else {
        found.path().join(name)
    };
    let detections = read_detections(path, &dataset, class).map_err(|e| e.to_string())?;
    let scores = |of: &Vec<pomona_detect::Detection>| of.iter().map(|d| d.score).collect();
    Ok(detections.iter().map(scores).collect())
}

#[test]
fn boxes_of_other_programs_find_their_images() {
    let expected = Ok(vec![vec![], vec![0.75]]);
    let list = |image: &str| {
        format!(r#"[{{"image_id":{image},"category_id":5,"bbox":[1,2,3,4],"score":0.75}}]"#)
    };
    for image in ["7", "\"b\"", "\"b.png\"", "\"some/where/b.png\""] {
        assert_eq!(detections("r.json", &list(image)), expected, "{image}");
    }
    let whole = r#"{"images":[{"id":1,"file_name":"b.png"},{"id":2,"file_name":"elsewhere.png"}],
        "annotations":[{"image_id":1,"category_id":5,"bbox":[1,2,3,4],"score":0.75}]}"#;
    assert_eq!(detections("r.json", whole), expected);
    let yolo = "0 0.5 0.5 0.25 0.5 0.75\n";
    assert_eq!(detections("exp/b.txt", yolo), expected);
    assert_eq!(detections("exp/labels/b.txt", yolo), expected);
    let voc = VOC.replace("<difficult>1</difficult>", "<score>0.75</score>");
    let class = ClassChoice::Name("apple".to_owned());
    assert_eq!(detections_of("exp/b.xml", &voc, Some(&class)), expected);
}

#[test]
fn boxes_of_other_images_and_classes_are_refused() {
    let refused = |name: &str, text: &str, words: &[&str]| {
        let message = detections(name, text).unwrap_err();
        for word in words {
            assert!(message.contains(word), "no `{word}` in: {message}");
        }
    };
    let list = |image: &str| format!(r#"[{{"image_id":{image},"bbox":[1,2,3,4],"score":0.75}}]"#);
    refused("r.json", &list("8"), &["r.json", "image 8"]);
    refused("r.json", &list("\"c\""), &["r.json", "image c"]);
    refused(
        "r.json",
        r#"[{"image_id":7,"bbox":[1,2,3,4]}]"#,
        &["r.json", "score"],
    );
    refused(
        "r.json",
        r#"[{"image_id":7,"bbox":[1,2,3,4],"score":7}]"#,
        &["r.json", "score is 7"],
    );
    refused(
        "exp/c.txt",
        "0 0.5 0.5 0.25 0.5 0.75\n",
        &["c.txt", "no image of this name"],
    );
    refused("exp/c.md", "", &["exp", "no YOLO, VOC or COCO file"]);
    let class = ClassChoice::Number(9);
    let message = detections_of("r.json", &list("7"), Some(&class)).unwrap_err();
    assert!(message.contains("--class"), "{message}");
}

fn shared(name: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../../shared")
        .join(name);
    if path.is_dir() {
        return Some(path);
    }
    println!("skipped: no {}", path.display());
    None
}

#[test]
fn tiles_of_real_trees_are_read_whole() {
    let Some(tiles) = shared("apple-tiles/val") else {
        return;
    };
    let dataset = LabelledDataset::read(tiles, None).unwrap();
    let labels: usize = dataset.images.iter().map(|i| i.boxes.len()).sum();
    assert_eq!((dataset.images.len(), labels), (130, 1081));
    assert!(
        dataset
            .images
            .iter()
            .all(|i| (i.width, i.height) == (416, 416))
    );
}

#[test]
fn real_frames_are_read_by_their_colour_images() {
    let Some(frames) = shared("frames") else {
        return;
    };
    let mut dataset = LabelledDataset::read(frames, None).unwrap();
    // Each frame has 26 apples and two reference balls.
    assert_eq!((dataset.ignore("BALL_*"), dataset.ignore("BALL_")), (4, 0));
    let counts = |label: &&LabelledBox| label.kind == LabelKind::Object;
    let of_image = |i: &LabelledImage| i.boxes.iter().filter(counts).count();
    let labels: Vec<usize> = dataset.images.iter().map(of_image).collect();
    assert_eq!(labels, [26, 26]);
}

#[test]
fn the_frame_that_comes_along_is_read() {
    let frames = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/frames");
    let dataset = LabelledDataset::read(frames, None).unwrap();
    assert_eq!(dataset.images[0].name, "orchard-demo");
    assert!(!dataset.images[0].boxes.is_empty());
    // The other one has no boxes: there, apples are to be found.
    assert_eq!((dataset.images.len(), dataset.frames_without_boxes), (1, 1));
}
