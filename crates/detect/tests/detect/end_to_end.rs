//! Models that suppress their boxes themselves, tasks, and how classes are named: as exporters write them.

use crate::fake_network::{FakeNetwork, fixed, port};
use pomona_cloud::ColorImage;
use pomona_detect::{
    ClassChoice, Detection, Detector, DetectorOptions, Family, ModelDescription, OnnxDetector,
};
use pomona_network::Tensor;

/// Left, upper, right and lower edge, score and class of two boxes of class 1 and one of class 0.
const ROWS: [[f32; 6]; 3] = [
    [120.0, 130.0, 200.0, 190.0, 0.9, 1.0],
    [430.0, 270.0, 530.0, 370.0, 0.8, 1.0],
    [10.0, 10.0, 40.0, 40.0, 0.7, 0.0],
];

const NAMES: &str = "{0: 'leaf', 1: 'apple', 2: 'stem'}";

fn tensor(shape: &[usize], data: Vec<f32>) -> Tensor {
    Tensor {
        name: "output0".to_owned(),
        shape: shape.to_vec(),
        data,
    }
}

/// A network that answers these rows, filled up with rows of zeros, and declares an output of `declared`.
fn network(
    rows: &[&[f32]],
    count: usize,
    declared: &[usize],
    metadata: &[(&str, &str)],
) -> FakeNetwork {
    let columns = rows[0].len();
    let mut data = rows.concat();
    data.resize(count * columns, 0.0);
    let mut network = fixed([640, 640], vec![tensor(&[1, count, columns], data)]);
    network.outputs = vec![port("output0", declared)];
    network.metadata = metadata
        .iter()
        .map(|(k, v)| ((*k).to_owned(), (*v).to_owned()))
        .collect();
    network
}

fn open(network: FakeNetwork, options: &DetectorOptions) -> Result<OnnxDetector, String> {
    let none = ModelDescription::default();
    OnnxDetector::new(Box::new(network), "m.onnx", &none, options).map_err(|e| e.to_string())
}

fn found(
    network: FakeNetwork,
    class: Option<usize>,
) -> Result<(Vec<Detection>, OnnxDetector), String> {
    let options = DetectorOptions::default().with(|o| o.class = class.map(ClassChoice::Number));
    let detector = open(network, &options)?;
    let image = ColorImage::filled(640, 640, [0; 3]);
    let found = detector.detect(&image).map_err(|e| e.to_string())?;
    Ok((found, detector))
}

/// What it says where it cannot be opened or read.
fn refusal(network: FakeNetwork) -> String {
    found(network, None).map(|_| ()).unwrap_err()
}

#[track_caller]
fn two_apples(found: &[Detection], class: usize) {
    let numbers = |d: &Detection| [d.x_min, d.y_min, d.x_max, d.y_max, d.score];
    let close = |d: &Detection, row: &[f32; 6]| {
        numbers(d)
            .iter()
            .zip(row)
            .all(|(a, b)| (a - f64::from(*b)).abs() < 1e-4)
    };
    assert_eq!(found.len(), 2, "{found:?}");
    assert!(
        close(&found[0], &ROWS[0]) && close(&found[1], &ROWS[1]),
        "{found:?}"
    );
    assert!(found.iter().all(|d| d.class == class), "{found:?}");
}

#[test]
fn suppressed_boxes_are_read_whether_their_number_is_open_or_not() {
    let rows: Vec<&[f32]> = ROWS.iter().map(|row| &row[..]).collect();
    for (count, declared) in [(300, [1, 300, 6]), (3, [1, 0, 6]), (300, [0, 0, 6])] {
        for metadata in [
            &[("names", NAMES)][..],
            &[("names", NAMES), ("task", "detect"), ("end2end", "True")],
        ] {
            let (found, detector) =
                found(network(&rows, count, &declared, metadata), None).unwrap();
            two_apples(&found, 1);
            assert_eq!(detector.family(), Family::EndToEnd, "{declared:?}");
            assert_eq!(detector.report().class_name.as_deref(), Some("apple"));
        }
        // Without names a class has to be asked for, unless all boxes are of one.
        let (asked, _) = found(network(&rows, count, &declared, &[]), Some(1)).unwrap();
        two_apples(&asked, 1);
        let refused = refusal(network(&rows, count, &declared, &[]));
        assert!(
            refused.contains("classes 1 and 0") && refused.contains("--class"),
            "{refused}"
        );
        let (alone, detector) =
            found(network(&rows[..2], count.max(3), &declared, &[]), None).unwrap();
        two_apples(&alone, 1);
        assert!(detector.report().notes[0].contains("does not name its classes"));
    }
    // One class, as a fruit detector has it: the same columns as of YOLOv5, and other rows.
    let own: Vec<[f32; 6]> = ROWS[..2]
        .iter()
        .map(|row| [row[0], row[1], row[2], row[3], row[4], 0.0])
        .collect();
    let own: Vec<&[f32]> = own.iter().map(|row| &row[..]).collect();
    let (alone, _) = found(
        network(&own, 2, &[1, 0, 6], &[("names", "{0: 'apple'}")]),
        None,
    )
    .unwrap();
    two_apples(&alone, 0);
    // Nothing seen at all.
    let mut nothing = network(&own, 2, &[1, 0, 6], &[]);
    nothing.answer = Box::new(|_| vec![tensor(&[1, 0, 6], Vec::new())]);
    assert!(found(nothing, None).unwrap().0.is_empty());
}

#[test]
fn rows_of_six_on_a_grid_are_still_yolov5_s() {
    let row: &[f32] = &[160.0, 160.0, 80.0, 60.0, 0.9, 1.0];
    let (seen, detector) = found(network(&[row], 25_200, &[1, 0, 6], &[]), None).unwrap();
    assert_eq!((detector.family(), seen.len()), (Family::YoloV5, 1));
    assert!((seen[0].x_min - 120.0).abs() < 1e-4, "{seen:?}");
}

#[test]
fn numbers_that_are_no_classes_are_refused() {
    let row: &[f32] = &[120.0, 130.0, 200.0, 190.0, 0.9, 0.5];
    let message = refusal(network(&[row], 300, &[1, 300, 6], &[]));
    assert!(
        message.contains("class 0.5") && message.contains("`family`"),
        "{message}"
    );
    let row: &[f32] = &[120.0, 130.0, 200.0, 190.0, 0.9, 7.0];
    let message = refusal(network(&[row], 300, &[1, 300, 6], &[("names", NAMES)]));
    assert!(message.contains("class 7"), "{message}");
}

#[test]
fn masks_and_key_points_behind_the_boxes_are_passed_over() {
    let seen = |task: &str, more: usize| {
        let mut rows: Vec<Vec<f32>> = ROWS.iter().map(|row| row.to_vec()).collect();
        for row in &mut rows {
            row.resize(6 + more, 0.5);
        }
        let rows: Vec<&[f32]> = rows.iter().map(|row| &row[..]).collect();
        let metadata = [("names", NAMES), ("task", task), ("end2end", "True")];
        found(network(&rows, 300, &[1, 300, 6 + more], &metadata), None)
            .unwrap()
            .0
    };
    two_apples(&seen("segment", 32), 1);
    two_apples(&seen("pose", 6), 1);

    // `YOLOv8`'s form: box, three classes, and 32 numbers of a mask.
    let mut data = vec![0.0; (4 + 3 + 32) * 8400];
    for (k, value) in [
        (0, 160.0),
        (1, 160.0),
        (2, 80.0),
        (3, 60.0),
        (5, 0.9),
        (7, 0.99),
    ] {
        data[k * 8400 + 17] = value;
    }
    let mut segmenter = fixed([640, 640], vec![tensor(&[1, 39, 8400], data)]);
    segmenter.metadata = vec![
        ("names".to_owned(), NAMES.to_owned()),
        ("task".to_owned(), "segment".to_owned()),
    ];
    let (seen, detector) = found(segmenter, None).unwrap();
    assert_eq!(
        (detector.family(), seen.len(), seen[0].class),
        (Family::YoloV8, 1, 1)
    );
    assert!((seen[0].score - 0.9).abs() < 1e-6, "{seen:?}");
}

#[test]
fn a_model_that_gives_no_upright_boxes_is_refused_by_its_task() {
    for (task, shape) in [("obb", [1, 8, 8400]), ("classify", [1, 1, 3])] {
        let mut model = fixed(
            [640, 640],
            vec![tensor(&shape, vec![0.0; shape.iter().product()])],
        );
        model.metadata = vec![
            ("task".to_owned(), task.to_owned()),
            ("names".to_owned(), NAMES.to_owned()),
        ];
        let message = open(model, &DetectorOptions::default())
            .map(|_| ())
            .unwrap_err();
        assert!(message.contains(&format!("task is `{task}`")), "{message}");
    }
}

#[test]
fn a_class_is_found_by_a_word_of_its_name_or_refused() {
    let model = |names: &str| {
        let mut data = vec![0.0; 7 * 8400];
        for (k, value) in [(0, 160.0), (1, 160.0), (2, 80.0), (3, 60.0), (5, 0.9)] {
            data[k * 8400] = value;
        }
        let mut model = fixed([640, 640], vec![tensor(&[1, 7, 8400], data)]);
        model.metadata = vec![("names".to_owned(), names.to_owned())];
        model
    };
    let (seen, detector) = found(model("{0: 'Leaf', 1: 'Apple_Ripe', 2: 'Stem'}"), None).unwrap();
    assert_eq!((seen.len(), seen[0].class), (1, 1));
    let report = detector.report();
    assert_eq!(report.class_name.as_deref(), Some("Apple_Ripe"));
    assert!(report.notes[0].contains("`Apple_Ripe`"), "{report:?}");
    // Ripe and unripe ones are apples both.
    let both = found(
        model("{0: 'unripe apple', 1: 'ripe apple', 2: 'leaf'}"),
        None,
    )
    .unwrap()
    .0;
    assert_eq!(both.len(), 1);
    let refused = refusal(model("{0: 'leaf', 1: 'trunk', 2: 'stem'}"));
    assert!(
        refused.contains("class `apple`") && refused.contains("`trunk`"),
        "{refused}"
    );
}

#[test]
fn yolox_that_was_exported_decoded_is_told_by_its_numbers() {
    let columns = 8;
    let mut data = vec![0.0; 8400 * columns];
    data[4321 * columns..4322 * columns]
        .copy_from_slice(&[160.0, 160.0, 80.0, 60.0, 0.9, 0.0, 1.0, 0.0]);
    let mut model = fixed([640, 640], vec![tensor(&[1, 8400, columns], data)]);
    model.metadata = vec![("names".to_owned(), NAMES.to_owned())];
    let (seen, detector) = found(model, None).unwrap();
    assert_eq!((detector.family(), seen.len()), (Family::YoloX, 1));
    let d = &seen[0];
    for (edge, expected) in [
        (d.x_min, 120.0),
        (d.y_min, 130.0),
        (d.x_max, 200.0),
        (d.y_max, 190.0),
    ] {
        assert!((edge - expected).abs() < 1e-4, "{seen:?}");
    }
}
