//! Wood in colour images, from the command line.

mod evaluated;
mod truth_masks;

use crate::binary::{Run, pomona, tree};
use crate::scene::Bench;
use crate::schema::Schema;
use pomona_cloud::{ColorImage, GrayImage};
use serde_json::{Value, json};
use std::fs;
use std::path::Path;

/// A brown branch before leaves, and a sky.
fn drawn([width, height]: [usize; 2]) -> ColorImage {
    let mut image = ColorImage::filled(width, height, [60, 110, 50]);
    for (k, pixel) in image.pixels.iter_mut().enumerate() {
        let (u, v) = (k % width, k / width);
        if v < height / 4 {
            *pixel = [180, 200, 230];
        }
        if (u + v / 3) % 60 < 8 {
            *pixel = [110 + (k % 7) as u8, 85, 65];
        }
    }
    image
}

/// A folder with the frame `a` and the image `photo.png`.
fn bench() -> Bench {
    let bench = Bench::new();
    drawn([120, 90]).write(bench.path("photo.png")).unwrap();
    bench
}

/// Runs `pomona segment` with the embedded backend, into the folder `out`.
fn segment(bench: &Bench, images: &[&str], more: &[&str]) -> Run {
    let images: Vec<String> = images.iter().map(|name| bench.text(name)).collect();
    let mut line = vec!["segment".to_owned()];
    line.extend(images);
    line.extend(["--out".to_owned(), bench.text("out")]);
    line.extend(["--runtime".to_owned(), "embedded".to_owned()]);
    line.extend(more.iter().map(ToString::to_string));
    pomona(&line)
}

fn files(bench: &Bench) -> Vec<String> {
    let paths = tree(&bench.path("out"));
    paths.iter().map(|p| p.display().to_string()).collect()
}

/// The names and roles in the order of their values.
fn classes(record: &Value) -> Vec<(u64, String, String)> {
    let text = |value: &Value| value.as_str().unwrap().to_owned();
    let class = |c: &Value| {
        (
            c["value"].as_u64().unwrap(),
            text(&c["name"]),
            text(&c["role"]),
        )
    };
    record["classes"]
        .as_array()
        .unwrap()
        .iter()
        .map(class)
        .collect()
}

/// Checks the maps of an image against each other and against the record.
#[track_caller]
fn maps_agree(bench: &Bench, image: &Value, size: [usize; 2]) {
    assert_eq!(json!([image["width"], image["height"]]), json!(size));
    let file = |key: &str| bench.path("out").join(image[key].as_str().unwrap());
    let likeliest = GrayImage::read(file("classes")).unwrap();
    let wood = GrayImage::read(file("wood")).unwrap();
    for map in [&likeliest, &wood] {
        assert_eq!([map.width, map.height], size);
    }
    let count = likeliest.values.len() as f64;
    let mut sum = 0.0;
    for (value, name) in ["rest", "wood", "peduncle", "fruit", "post"]
        .iter()
        .enumerate()
    {
        let of_class = likeliest
            .values
            .iter()
            .filter(|v| usize::from(**v) == value);
        let share = image["share"][name].as_f64().unwrap();
        assert!(
            (share - of_class.count() as f64 / count).abs() < 1e-12,
            "{name}"
        );
        sum += share;
    }
    assert!((sum - 1.0).abs() < 1e-12, "every pixel is seen: {sum}");
    for (class, p) in likeliest.values.iter().zip(&wood.values) {
        // One class of wood among five: the likeliest has a fifth at least, and what has more than half is it.
        assert!(*class != 1 || *p >= 51, "{p}");
        assert!(*class == 1 || *p <= 128, "{p}");
    }
    let Some(picture) = image["picture"].as_str() else {
        return;
    };
    let picture = ColorImage::read(bench.path("out").join(picture)).unwrap();
    assert_eq!([picture.width, picture.height], size);
    let original = ColorImage::read(image["file"].as_str().unwrap()).unwrap();
    let pairs = picture.pixels.iter().zip(&original.pixels);
    for ((drawn, original), class) in pairs.zip(&likeliest.values) {
        assert!(*class != 0 || drawn == original, "the rest stays as it is");
    }
}

/// Checks a record that has pictures against its schema, and the schema against records that are wrong.
#[track_caller]
fn holds_to_its_schema(record: &Value) {
    let schema = Schema::read("classes.schema.json");
    schema.accepts(record);
    schema.refuses(record, "/schema", Some(json!("pomona.classes/2")));
    schema.refuses(record, "/unseen", Some(json!(0)));
    for parent in [
        "",
        "/segmenter",
        "/segmenter/runtime",
        "/classes/0",
        "/images/0",
    ] {
        schema.refuses(record, &format!("{parent}/extra"), Some(json!(1)));
    }
    schema.refuses(record, "/segmenter/runtime/version", None);
    schema.refuses(record, "/classes/1/role", Some(json!("twig")));
    schema.refuses(record, "/images/0/share/wood", Some(json!(1.5)));
    schema.refuses(record, "/images/0/width", Some(json!(0)));
    schema.refuses(record, "/images/0/wood", None);
}

#[test]
fn an_image_and_a_frame_have_three_files_each_and_a_record() {
    let bench = bench();
    let run = segment(&bench, &["photo.png", "a"], &[]).succeeded();
    for word in [
        "built-in wood model",
        "embedded",
        "photo",
        "120x90",
        "2 images",
        "written to",
    ] {
        assert!(run.out.contains(word), "no {word} in {}", run.out);
    }
    assert_eq!(
        files(&bench),
        [
            "a-classes.png",
            "a.classes.png",
            "a.wood.png",
            "classes.json",
            "photo-classes.png",
            "photo.classes.png",
            "photo.wood.png"
        ]
    );
    let record = bench.read_json("out/classes.json");
    holds_to_its_schema(&record);
    assert_eq!(record["schema"], "pomona.classes/1");
    assert_eq!(record["version"], env!("CARGO_PKG_VERSION"));
    assert_eq!(record["segmenter"]["name"], "built-in wood model");
    assert_eq!(record["segmenter"]["runtime"]["name"], "embedded");
    assert_eq!(record["unseen"], 255);
    let expected = ["rest", "wood", "peduncle", "fruit", "post"];
    let expected: Vec<_> = (0..)
        .zip(expected)
        .map(|(value, name)| (value, name.to_owned(), name.to_owned()))
        .collect();
    assert_eq!(classes(&record), expected);
    let images = record["images"].as_array().unwrap();
    let names: Vec<_> = images.iter().map(|image| &image["name"]).collect();
    assert_eq!(names, ["photo", "a"]);
    maps_agree(&bench, &images[0], [120, 90]);
    maps_agree(&bench, &images[1], [320, 240]);
    assert!(images[0]["segment_ms"].as_f64().unwrap() > 0.0);
}

#[test]
fn the_demo_frame_is_segmented_tile_by_tile_and_the_same_on_any_number_of_threads() {
    let demo = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/frames/orchard-demo");
    let bench = Bench::new();
    let line = |out: &str| {
        let demo = demo.to_str().unwrap().to_owned();
        let out = bench.text(out);
        ["segment".to_owned(), demo, "--out".to_owned(), out]
    };
    let more = ["--runtime", "embedded", "--json"].map(str::to_owned);
    let record = pomona(&[&line("out")[..], &more].concat())
        .succeeded()
        .json();
    assert_eq!(record, bench.read_json("out/classes.json"));
    assert_eq!(record["images"][0]["name"], "orchard-demo");
    maps_agree(&bench, &record["images"][0], [1280, 960]);

    let threads = ["--threads", "1", "--no-picture"].map(str::to_owned);
    pomona(&[&line("one")[..], &more, &threads].concat()).succeeded();
    for name in ["orchard-demo.classes.png", "orchard-demo.wood.png"] {
        let [many, one] = ["out", "one"].map(|out| bench.read(&format!("{out}/{name}")));
        assert!(many == one, "{name}");
    }
}

#[test]
fn a_later_run_replaces_the_earlier_and_leaves_what_is_not_its_own() {
    let bench = bench();
    segment(&bench, &["photo.png", "a"], &[]).succeeded();
    bench.write("out/notes.txt", "mine");
    let before = bench.read("out/a.wood.png");
    let run = segment(&bench, &["a"], &["--no-picture", "--json"]).succeeded();
    assert_eq!(
        files(&bench),
        ["a.classes.png", "a.wood.png", "classes.json", "notes.txt"]
    );
    assert_eq!(run.json(), bench.read_json("out/classes.json"));
    let image = &run.json()["images"][0];
    assert!(image.get("picture").is_none(), "{image}");
    Schema::read("classes.schema.json").accepts(&run.json());
    maps_agree(&bench, image, [320, 240]);
    assert!(
        before == bench.read("out/a.wood.png"),
        "the same image again"
    );
}

#[test]
fn files_of_somebody_else_are_not_replaced() {
    for (name, words) in [
        (
            "photo.wood.png",
            &["photo.wood.png", "no classes.json says"][..],
        ),
        ("photo.classes.png", &["photo.classes.png"]),
        ("photo-classes.png", &["photo-classes.png"]),
        (
            "classes.json",
            &["classes.json", "not a result of this program"],
        ),
    ] {
        let bench = bench();
        fs::create_dir(bench.path("out")).unwrap();
        bench.write(&format!("out/{name}"), "{}");
        segment(&bench, &["photo.png"], &[]).refused(&[words, &["--out"]].concat());
        assert_eq!(files(&bench), [name]);
        assert_eq!(bench.read(&format!("out/{name}")), b"{}");
    }
    let bench = bench();
    fs::create_dir(bench.path("out")).unwrap();
    bench.write("out/photo-classes.png", "mine");
    segment(&bench, &["photo.png"], &["--no-picture"]).succeeded();
    assert_eq!(bench.read("out/photo-classes.png"), b"mine");
}

/// The network of the built-in model, as a file of one's own.
fn own_model(bench: &Bench, description: Option<&str>) -> String {
    let model = Path::new(env!("CARGO_MANIFEST_DIR")).join("../segment/model/wood.onnx");
    fs::copy(model, bench.path("mine.onnx")).unwrap();
    if let Some(text) = description {
        bench.write("mine.toml", text);
    }
    bench.text("mine.onnx")
}

#[test]
fn a_model_of_ones_own_has_the_classes_that_its_description_states() {
    let bench = bench();
    segment(&bench, &["photo.png"], &[]).succeeded();
    let wood = bench.read("out/photo.wood.png");
    let description = "
        classes = ['background', 'trunk', 'stalk', 'apple', 'support wire']
        roles = { 'support wire' = 'post' }
        activation = 'softmax'
        tile = 416";
    let model = own_model(&bench, Some(description));
    let run = segment(&bench, &["photo.png"], &["--model", &model, "--json"]).succeeded();
    let record = run.json();
    assert_eq!(record["segmenter"]["name"], model);
    let expected = [
        ("background", "rest"),
        ("trunk", "wood"),
        ("stalk", "peduncle"),
        ("apple", "fruit"),
        ("support wire", "post"),
    ];
    let expected: Vec<_> = (0..)
        .zip(expected)
        .map(|(value, (name, role))| (value, name.to_owned(), role.to_owned()))
        .collect();
    assert_eq!(classes(&record), expected);
    assert!(wood == bench.read("out/photo.wood.png"), "the same network");

    // Of three classes of wood, the probabilities are added up.
    let more_wood = description.replace("'stalk', 'apple'", "'limb', 'twig'");
    own_model(&bench, Some(&more_wood));
    segment(&bench, &["photo.png"], &["--model", &model]).succeeded();
    let sum = GrayImage::read(bench.path("out/photo.wood.png")).unwrap();
    bench.write("wood.png", &wood);
    let one = GrayImage::read(bench.path("wood.png")).unwrap();
    assert!(
        sum.values
            .iter()
            .zip(&one.values)
            .all(|(sum, one)| sum >= one)
    );
    assert_ne!(sum.values, one.values);
}

#[test]
fn what_is_assumed_about_a_model_is_said_and_recorded() {
    let bench = bench();
    let classes = "classes = ['rest', 'wood', 'peduncle', 'fruit', 'post']";
    let model = own_model(&bench, Some(classes));
    let run = segment(&bench, &["photo.png"], &["--model", &model, "--json"]);
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(
        run.err.contains("note: ") && run.err.contains("`activation`"),
        "{}",
        run.err
    );
    Schema::read("classes.schema.json").accepts(&run.json());
    let notes = run.json()["segmenter"]["notes"].to_string();
    assert!(notes.contains("logits"), "{notes}");
}

#[test]
fn what_cannot_be_used_is_refused_and_nothing_is_written() {
    let bench = bench();
    bench.write("text.png", "no picture");
    bench.write("broken.onnx", "no network");
    fs::create_dir(bench.path("empty")).unwrap();
    let refused = |images: &[&str], more: &[&str], words: &[&str]| {
        let before = tree(bench.root());
        segment(&bench, images, more).refused(words);
        assert_eq!(tree(bench.root()), before);
    };
    refused(&["text.png"], &[], &["text.png", "PNG"]);
    // The first image is fine, and written nowhere either.
    refused(&["photo.png", "text.png"], &[], &["text.png"]);
    refused(&["gone.png"], &[], &["gone.png", "check the path"]);
    refused(&["empty"], &[], &["empty", "give images"]);
    refused(
        &["photo.png", "photo.png"],
        &[],
        &["`photo`", "runs of their own"],
    );
    let (gone, broken) = (bench.text("gone.onnx"), bench.text("broken.onnx"));
    refused(
        &["photo.png"],
        &["--model", &gone],
        &["gone.onnx", "check the path"],
    );
    refused(
        &["photo.png"],
        &["--model", &broken],
        &["broken.onnx", "ONNX"],
    );
}

#[test]
fn a_description_that_does_not_fit_is_refused_with_its_file_and_the_way_out() {
    let bench = bench();
    for (description, words) in [
        (
            Some("tile = 416\nactivaton = 'softmax'"),
            &[
                "mine.toml",
                "line 2",
                "`activaton`",
                "nearest keys",
                "`activation`",
            ][..],
        ),
        (
            Some("activation = 'tanh'"),
            &["mine.toml", "line 1", "tanh", "docs/segmentation.md"],
        ),
        (
            Some("classes = ['rest', 'wood']"),
            &["mine.onnx", "`classes`", "2 names for an output of 5"],
        ),
        (
            Some("classes = ['a', 'b', 'c', 'd', 'e']"),
            &["mine.onnx", "is wood", "roles = { NAME = \"wood\" }"],
        ),
        (
            None,
            &["mine.onnx", "nobody says what they are", "`classes`"],
        ),
    ] {
        let _ = fs::remove_file(bench.path("mine.toml"));
        let model = own_model(&bench, description);
        let before = tree(bench.root());
        segment(&bench, &["photo.png"], &["--model", &model]).refused(words);
        assert_eq!(tree(bench.root()), before);
    }
}

#[test]
fn slips_of_the_command_line_are_usage_errors() {
    for (line, word) in [
        (&["segment"][..], "IMAGE"),
        (&["segment", "photo.png"], "--out"),
        (
            &["segment", "photo.png", "--out", "x", "--tiles", "3by2"],
            "3x2",
        ),
        (
            &["segment", "photo.png", "--out", "x", "--runtime", "onnx"],
            "embedded",
        ),
    ] {
        let usage = pomona(line);
        assert_eq!((usage.code, &*usage.out), (2, ""));
        assert!(usage.err.contains(word), "{}", usage.err);
    }
}
