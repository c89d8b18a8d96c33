//! Networks that do not do what a segmenter does: each message names the model, the place and the remedy.

use crate::fake_network::{FakeNetwork, network, redness, tensor};
use pomona_cloud::{ColorImage, PixelWindow};
use pomona_segment::{
    OnnxSegmenter, SegmentDescription, Segmenter, SegmenterOptions, TilingChoice,
};

fn open(network: FakeNetwork, text: &str) -> Result<OnnxSegmenter, String> {
    let description = SegmentDescription::parse(text, "m.toml").unwrap();
    OnnxSegmenter::new(
        Box::new(network),
        "m.onnx",
        &description,
        TilingChoice::Automatic,
    )
    .map_err(|error| error.to_string())
}

const STATED: &str = "classes = ['leaf', 'branch']\nactivation = 'none'";

#[test]
fn outputs_that_are_no_maps_are_refused_when_opened() {
    for (shape, part) in [
        (&[1, 2, 8][..], "[1, 2, 8] is not one map for each class"),
        (&[2, 2, 8, 8], "not one map"),
        (&[1, 3, 8, 8], "2 names for an output of 3 channels"),
    ] {
        let error = open(network([8, 8], shape, |_| Vec::new()), STATED)
            .err()
            .unwrap();
        assert!(
            error.starts_with("m.onnx: ") && error.contains(part),
            "{error}"
        );
    }
    let silent = open(
        network([8, 8], &[1, 5, 8, 8], |_| {
            vec![tensor(&[1, 5, 8, 8], vec![0.0; 320])]
        }),
        "",
    );
    assert!(silent.err().unwrap().contains("list `classes`"));
}

#[test]
fn answers_that_do_not_fit_are_refused_when_run() {
    let image = ColorImage::filled(8, 8, [100; 3]);
    let message = |shape: &'static [usize], data: Vec<f32>| {
        let liar = network([8, 8], &[1, 2, 8, 8], move |_| {
            vec![tensor(shape, data.clone())]
        });
        let error = open(liar, STATED)
            .unwrap()
            .segment(&image)
            .unwrap_err()
            .to_string();
        assert!(error.starts_with("m.onnx: "), "{error}");
        error
    };
    assert!(message(&[1, 2, 8, 8], vec![f32::NAN; 128]).contains("NaN in channel 0 at (0, 0)"));
    assert!(message(&[1, 2, 8, 8], vec![0.5; 100]).contains("100 numbers"));
    assert!(message(&[1, 3, 8, 8], vec![0.3; 192]).contains("3 channels for 2 classes"));
    assert!(message(&[], vec![0.3]).contains("its shape is []"));
}

#[test]
fn what_is_assumed_is_said() {
    let silent = open(redness([8, 8], 1), "classes = ['leaf', 'branch']").unwrap();
    assert!(silent.report().notes[0].contains("taken for probabilities"));
    let logits = network([8, 8], &[1, 1, 8, 8], |_| {
        vec![tensor(&[1, 1, 8, 8], vec![-3.0; 64])]
    });
    let notes = open(logits, "").unwrap().report().notes;
    assert!(
        notes[0].contains("taken for logits") && notes[1].contains("`wood`"),
        "{notes:?}"
    );
    let open_size = network([0, 0], &[1, 0, 0, 0], |image| {
        let [_, _, h, w] = image.shape[..] else {
            return Vec::new();
        };
        let data = [vec![2.0; w * h], vec![-2.0; w * h]].concat();
        vec![tensor(&[1, 2, h, w], data)]
    });
    let notes = open(open_size, "classes = ['leaf', 'branch']")
        .unwrap()
        .report()
        .notes;
    assert!(notes[0].contains("416x416"), "{notes:?}");
    assert!(
        open(redness([8, 8], 1), STATED)
            .unwrap()
            .report()
            .notes
            .is_empty()
    );
}

#[test]
fn windows_and_images_that_do_not_fit_are_refused() {
    let segmenter = open(redness([8, 8], 1), STATED).unwrap();
    let image = ColorImage::filled(8, 8, [100; 3]);
    let beyond = PixelWindow {
        x0: 4,
        y0: 4,
        x1: 9,
        y1: 8,
    };
    let error = segmenter
        .segment_windows(&image, &[beyond])
        .unwrap_err()
        .to_string();
    assert!(error.contains("(4, 4) to (9, 8)"), "{error}");
    let empty = ColorImage {
        pixels: Vec::new(),
        ..image
    };
    assert!(segmenter.segment(&empty).is_err());
}

#[test]
fn files_that_are_no_models_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("wood.onnx");
    let message = || {
        let options = SegmenterOptions::of_model(Some(path.clone()));
        options.open().err().unwrap().to_string()
    };
    assert!(message().contains("wood.onnx: cannot be read"));
    std::fs::write(&path, [0_u8; 40]).unwrap();
    assert!(message().contains("wood.onnx"));
    std::fs::write(folder.path().join("wood.toml"), "clases = ['a']").unwrap();
    let unknown = message();
    assert!(unknown.contains("wood.toml: line 1, `clases`") && unknown.contains("`classes`"));
}
