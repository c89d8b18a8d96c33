//! What is told from a network's inputs and outputs, what a description adds, and what is refused.

use crate::fake_network::{FakeNetwork, fixed, port};
use pomona_cloud::ColorImage;
use pomona_detect::{
    ClassChoice, Detector, DetectorOptions, Family, ModelDescription, OnnxDetector, TilingChoice,
};
use pomona_network::{Port, Tensor};
use std::sync::{Arc, Mutex};

/// Shapes of the outputs; 0 is an axis that is left open.
type Outputs<'a> = &'a [&'a [usize]];

fn open(
    input: &[usize],
    outputs: Outputs<'_>,
    description: &str,
    options: &DetectorOptions,
) -> Result<OnnxDetector, String> {
    let name = |k: usize| format!("output{k}");
    let outputs: Vec<Port> = outputs
        .iter()
        .enumerate()
        .map(|(k, shape)| port(&name(k), shape))
        .collect();
    let answers: Vec<Tensor> = outputs
        .iter()
        .map(|port| {
            let shape: Vec<usize> = port.shape.iter().map(|side| side.unwrap_or(1)).collect();
            let data = vec![0.0; shape.iter().product()];
            Tensor {
                name: port.name.clone(),
                shape,
                data,
            }
        })
        .collect();
    let network = FakeNetwork {
        inputs: vec![port("images", input)],
        outputs,
        metadata: Vec::new(),
        answer: Box::new(move |_| answers.clone()),
    };
    let description = ModelDescription::parse(description, "m.toml").map_err(|e| e.to_string())?;
    OnnxDetector::new(Box::new(network), "m.onnx", &description, options).map_err(|e| e.to_string())
}

fn family(input: &[usize], outputs: Outputs<'_>, description: &str) -> Result<Family, String> {
    open(input, outputs, description, &DetectorOptions::default()).map(|detector| detector.family())
}

const SQUARE: [usize; 4] = [1, 3, 416, 416];
const OPEN: [usize; 4] = [0, 3, 0, 0];

#[test]
fn families_are_told_apart() {
    let told: [(&[usize], Outputs<'_>, Family); 22] = [
        (&SQUARE, &[&[1, 3549, 85]], Family::YoloX),
        (&SQUARE, &[&[0, 3549, 6]], Family::YoloX),
        (&[1, 3, 480, 640], &[&[1, 6300, 85]], Family::YoloX),
        (&SQUARE, &[&[1, 10_647, 85]], Family::YoloV5),
        (&[1, 3, 640, 640], &[&[1, 25_200, 6]], Family::YoloV5),
        (&[1, 3, 1280, 1280], &[&[1, 102_000, 85]], Family::YoloV5),
        (
            &[1, 3, 640, 640],
            &[&[1, 25_200, 85], &[1, 3, 80, 80, 85]],
            Family::YoloV5,
        ),
        (&SQUARE, &[&[1, 2535, 85]], Family::YoloV5),
        (&OPEN, &[&[0, 0, 85]], Family::YoloV5),
        (&SQUARE, &[&[1, 84, 3549]], Family::YoloV8),
        (&SQUARE, &[&[1, 5, 3549]], Family::YoloV8),
        (&[1, 3, 640, 640], &[&[1, 84, 8400]], Family::YoloV8),
        (&[1, 3, 1280, 1280], &[&[1, 84, 34_000]], Family::YoloV8),
        (&OPEN, &[&[0, 84, 0]], Family::YoloV8),
        (
            &SQUARE,
            &[&[1, 255, 52, 52], &[1, 255, 26, 26], &[1, 255, 13, 13]],
            Family::YoloV3,
        ),
        (
            &SQUARE,
            &[&[1, 13, 13, 255], &[1, 26, 26, 255]],
            Family::YoloV3,
        ),
        (
            &OPEN,
            &[&[0, 0, 0, 3, 85], &[0, 0, 0, 3, 85]],
            Family::YoloV3,
        ),
        (&[1, 3, 320, 320], &[&[1, 2100, 85]], Family::YoloX),
        (&[1, 3, 320, 320], &[&[1, 6300, 85]], Family::YoloV5),
        (&SQUARE, &[&[1, 300, 6]], Family::EndToEnd),
        (&OPEN, &[&[1, 300, 6]], Family::EndToEnd),
        (&[1, 3, 640, 640], &[&[0, 100, 6]], Family::EndToEnd),
    ];
    for (input, outputs, expected) in told {
        assert_eq!(family(input, outputs, ""), Ok(expected), "{outputs:?}");
    }
}

#[test]
fn a_description_wins() {
    let yolov5 = "family = 'yolov5'";
    assert_eq!(
        family(&SQUARE, &[&[1, 3549, 85]], yolov5),
        Ok(Family::YoloV5)
    );
    // Seven columns are three classes and a box, not two and something.
    let three = "classes = ['apple', 'leaf', 'sky']";
    assert_eq!(family(&SQUARE, &[&[1, 3549, 7]], three), Ok(Family::YoloV8));
    // A size that the model leaves open tells what its rows are.
    let size = "input_size = [416, 416]";
    assert_eq!(family(&OPEN, &[&[1, 3549, 85]], size), Ok(Family::YoloX));
    // Strides of one's own.
    assert_eq!(
        family(&SQUARE, &[&[1, 676, 85]], "strides = [16]"),
        Ok(Family::YoloX)
    );
}

/// No detector, and a message that says all of this.
fn refused(input: &[usize], outputs: Outputs<'_>, description: &str, words: &[&str]) {
    refused_with(
        &DetectorOptions::default(),
        input,
        outputs,
        description,
        words,
    );
}

fn refused_with(
    options: &DetectorOptions,
    input: &[usize],
    outputs: Outputs<'_>,
    description: &str,
    words: &[&str],
) {
    let opened = open(input, outputs, description, options);
    let message = opened.map(|_| ()).unwrap_err();
    for word in words {
        assert!(message.contains(word), "`{word}` is not in: {message}");
    }
}

#[test]
fn outputs_of_no_family_are_refused() {
    refused(
        &SQUARE,
        &[&[1, 1000]],
        "",
        &["`output0` [1, 1000]", "no known family"],
    );
    refused(&SQUARE, &[], "", &["m.onnx: outputs: ", "family"]);
    refused(
        &SQUARE,
        &[&[1, 3550, 85]],
        "",
        &["[1, 3550, 85] of a 416x416 input", "`family`"],
    );
    refused(
        &SQUARE,
        &[&[1, 300, 7]],
        "",
        &["neither one nor three rows"],
    );
    refused(&OPEN, &[&[0, 0, 0]], "", &["[?, ?, ?]", "leaves open"]);
    refused(
        &OPEN,
        &[&[1, 3549, 85]],
        "",
        &["input's size is open", "`input_size`"],
    );
}

#[test]
fn inputs_that_are_no_single_colour_image_are_refused() {
    refused(
        &[4, 3, 416, 416],
        &[&[4, 5, 3549]],
        "",
        &["several images", "batch of 1"],
    );
    refused(
        &[1, 416, 416, 3],
        &[&[1, 5, 3549]],
        "",
        &["channels come last"],
    );
    refused(&[1, 3, 416], &[&[1, 5, 3549]], "", &["four axes"]);
}

#[test]
fn descriptions_and_options_that_contradict_the_model_are_refused() {
    let coco: Outputs<'_> = &[&[1, 84, 3549]];
    let one: Outputs<'_> = &[&[1, 5, 3549]];
    refused(
        &SQUARE,
        coco,
        "input_size = [640, 640]",
        &["width is 416, not 640"],
    );
    refused(
        &SQUARE,
        coco,
        "classes = ['apple']",
        &["1 names", "80 classes"],
    );
    refused(&SQUARE, coco, "class = 80", &["class 80", "0 to 79"]);
    let choice = |class| DetectorOptions::default().with(|o| o.class = Some(class));
    let named = |name: &str| choice(ClassChoice::Name(name.to_owned()));
    refused_with(
        &named("aple"),
        &SQUARE,
        coco,
        "",
        &["class `aple`", "`apple`"],
    );
    refused_with(
        &named("apple"),
        &SQUARE,
        &[&[1, 7, 3549]],
        "",
        &["no names", "number"],
    );
    let second = choice(ClassChoice::Number(1));
    refused_with(&second, &SQUARE, one, "", &["class 1", "1 classes"]);
    let threshold = DetectorOptions::default().with(|o| o.threshold = Some(f64::NAN));
    refused_with(&threshold, &SQUARE, one, "", &["threshold = NaN"]);
    let tiling = DetectorOptions::default().with(|o| {
        o.tiling = TilingChoice::Grid {
            columns: 0,
            rows: 1,
        }
    });
    refused_with(&tiling, &SQUARE, one, "", &["tiling = 0x1"]);
}

#[test]
fn what_shows_only_while_running_is_refused_then() {
    let image = ColorImage::filled(416, 416, [0; 3]);
    let cases: [(&[usize], Outputs<'_>, &str, &[&str]); 6] = [
        // The fake answers one row for an open axis.
        (
            &SQUARE,
            &[&[1, 3549, 0]],
            "family = 'yolox'",
            &["`output0`", "1 columns"],
        ),
        (
            &SQUARE,
            &[&[1, 0, 85]],
            "family = 'yolox'",
            &["1 rows", "[8, 16, 32] on 416x416", "3549 cells"],
        ),
        (
            &SQUARE,
            &[&[1, 0, 0, 0], &[1, 0, 0, 0]],
            "",
            &["`output0`", "no grid of a 416x416 input"],
        ),
        (&SQUARE, &[&[1, 27, 26, 26]], "", &["1 grids", "`anchors`"]),
        (
            &SQUARE,
            &[&[1, 27, 26, 26], &[1, 27, 26, 26]],
            "",
            &["same grid"],
        ),
        (
            &SQUARE,
            &[&[2, 0, 85]],
            "family = 'yolov5'",
            &["[2, 1, 85]", "batch of one"],
        ),
    ];
    for (input, outputs, description, words) in cases {
        let detector = open(input, outputs, description, &DetectorOptions::default()).unwrap();
        let message = detector.detect(&image).unwrap_err().to_string();
        assert!(message.starts_with("m.onnx: "), "{message}");
        for word in words {
            assert!(message.contains(word), "`{word}` is not in: {message}");
        }
    }
}

#[test]
fn yolox_with_open_rows_is_not_taken_for_yolov5() {
    let data = vec![0.0; 3549 * 85];
    let mut network = fixed(
        [416, 416],
        vec![Tensor {
            name: "o".to_owned(),
            shape: vec![1, 3549, 85],
            data,
        }],
    );
    network.outputs = vec![port("o", &[0, 0, 85])];
    let none = ModelDescription::default();
    let detector = OnnxDetector::new(
        Box::new(network),
        "m.onnx",
        &none,
        &DetectorOptions::default(),
    );
    let image = ColorImage::filled(416, 416, [0; 3]);
    let message = detector.unwrap().detect(&image).unwrap_err().to_string();
    assert!(message.contains("family = \"yolox\""), "{message}");
}

#[test]
fn an_open_size_is_the_usual_one_and_noted() {
    let options = DetectorOptions::default();
    let detector = open(&OPEN, &[&[0, 84, 0]], "", &options).unwrap();
    assert_eq!(detector.input_size(), [640, 640]);
    assert!(
        detector.report().notes[0].contains("640x640"),
        "{:?}",
        detector.report()
    );
    let heads: &[&[usize]] = &[&[0, 0, 0, 255], &[0, 0, 0, 255]];
    assert_eq!(
        open(&OPEN, heads, "", &options).unwrap().input_size(),
        [416, 416]
    );
    let wide = open(&[1, 3, 320, 0], &[&[0, 84, 0]], "", &options).unwrap();
    assert_eq!(wide.input_size(), [640, 320]);
    let stated = open(&OPEN, &[&[0, 84, 0]], "input_size = [512, 384]", &options).unwrap();
    assert_eq!(stated.input_size(), [512, 384]);
    assert!(stated.report().notes.is_empty());
}

#[test]
fn names_in_the_model_count() {
    let mut network = fixed([416, 416], vec![]);
    network.outputs = vec![port("o", &[1, 6, 3549])];
    network.metadata = vec![("names".to_owned(), "{0: 'leaf', 1: 'apple'}".to_owned())];
    network.answer = Box::new(|_| {
        let mut data = vec![0.0; 6 * 3549];
        for (k, value) in [100.0, 100.0, 50.0, 50.0, 0.9, 0.8].into_iter().enumerate() {
            data[k * 3549] = value;
        }
        vec![Tensor {
            name: "o".to_owned(),
            shape: vec![1, 6, 3549],
            data,
        }]
    });
    let none = ModelDescription::default();
    let detector = OnnxDetector::new(
        Box::new(network),
        "m.onnx",
        &none,
        &DetectorOptions::default(),
    );
    let seen = detector
        .unwrap()
        .detect(&ColorImage::filled(416, 416, [0; 3]))
        .unwrap();
    assert_eq!(seen.len(), 1);
    assert_eq!(seen[0].class, 1);
    assert!((seen[0].score - 0.8).abs() < 1e-6);
}

/// The numbers that a network gets are those that its family is trained on, or what its description says.
#[test]
fn pixels_are_prepared_as_the_family_or_the_description_says() {
    let prepared = |output: &[usize], description: &str| {
        let got = Arc::new(Mutex::new(Vec::new()));
        let answer = {
            let (got, shape) = (Arc::clone(&got), output.to_vec());
            move |inputs: &[Tensor]| {
                got.lock().unwrap().clone_from(&inputs[0].data);
                let data = vec![0.0; shape.iter().product()];
                vec![Tensor {
                    name: "o".to_owned(),
                    shape: shape.clone(),
                    data,
                }]
            }
        };
        let mut network = fixed([416, 416], vec![]);
        network.outputs = vec![port("o", output)];
        network.answer = Box::new(answer);
        let description = ModelDescription::parse(description, "m.toml").unwrap();
        let options = DetectorOptions::default();
        let detector =
            OnnxDetector::new(Box::new(network), "m.onnx", &description, &options).unwrap();
        detector
            .detect(&ColorImage::filled(416, 208, [255, 51, 0]))
            .unwrap();
        let got = got.lock().unwrap().clone();
        // First row, middle, last row; red, green, blue or the other way round.
        [0, 208, 415].map(|row| [0, 1, 2].map(|c| got[(c * 416 + row) * 416 + 7]))
    };
    let grey = [114.0 / 255.0; 3];
    let near = |found: [[f32; 3]; 3], expected: [[f32; 3]; 3]| {
        let pairs = found.as_flattened().iter().zip(expected.as_flattened());
        let close = pairs.into_iter().all(|(a, b)| (a - b).abs() < 1e-5);
        assert!(close, "{found:?} {expected:?}");
    };
    near(prepared(&[1, 5, 3549], ""), [grey, [1.0, 0.2, 0.0], grey]);
    near(prepared(&[1, 10_647, 6], ""), [grey, [1.0, 0.2, 0.0], grey]);
    near(
        prepared(&[1, 3549, 6], ""),
        [[0.0, 51.0, 255.0], [114.0; 3], [114.0; 3]],
    );
    let heads = prepared(&[1, 18, 13, 13], "anchors = [[9, 9], [20, 20], [40, 40]]");
    near(
        heads,
        [[128.0 / 255.0; 3], [1.0, 0.2, 0.0], [128.0 / 255.0; 3]],
    );
    let own =
        "channels = 'bgr'\npadding = 'stretch'\nscale = 1\nmean = [0, 1, 5]\nstd = [1, 2, 250]";
    near(prepared(&[1, 5, 3549], own), [[0.0, 25.0, 1.0]; 3]);
}
