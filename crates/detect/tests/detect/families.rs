//! Each family read back from outputs that an encoder of the test wrote: known boxes in, the same boxes out.

use crate::fake_network::{FakeNetwork, fixed, port};
use pomona_cloud::ColorImage;
use pomona_detect::{
    ClassChoice, Detection, Detector, DetectorOptions, Family, ModelDescription, OnnxDetector,
    TilingChoice,
};
use pomona_network::{Element, Tensor};
use proptest::prelude::*;

const SIDE: usize = 416;
const CLASSES: usize = 3;
/// Rows of padding above an image of 4:3 in the middle of a square input of 416 pixels.
const ABOVE: f64 = 52.0;

/// Something to encode: centre and size in pixels of the input, and how it scores.
#[derive(Clone, Copy, Debug)]
struct Object {
    x: f64,
    y: f64,
    width: f64,
    height: f64,
    something: f64,
    score: f64,
    class: usize,
    /// Which of three grids or anchors is to report it.
    grid: usize,
    anchor: usize,
}

/// At most one object in each ninth of an image of 416 by 312 pixels, so that none is suppressed.
fn objects() -> impl Strategy<Value = Vec<Object>> {
    let one = (
        (-30.0..30.0, -18.0..18.0, 12.0..70.0, 12.0..60.0),
        (0.5..0.99, 0.05..0.99, 0..CLASSES, 0..3_usize, 0..3_usize),
    );
    prop::collection::vec(prop::option::of(one), 9).prop_map(|nine| {
        let place = |(k, object): (usize, Option<_>)| {
            let ((x, y, width, height), (something, score, class, grid, anchor)) = object?;
            Some(Object {
                x: 69.0 + 138.0 * (k % 3) as f64 + x,
                y: 52.0 + 104.0 * (k / 3) as f64 + y,
                width,
                height,
                something,
                score,
                class,
                grid,
                anchor,
            })
        };
        nine.into_iter().enumerate().filter_map(place).collect()
    })
}

fn tensor(name: &str, shape: &[usize], data: Vec<f32>) -> Tensor {
    Tensor {
        name: name.to_owned(),
        shape: shape.to_vec(),
        data,
    }
}

fn logit(p: f64) -> f64 {
    (p / (1.0 - p)).ln()
}

/// Ways in which the grids of `YOLOv3` are laid out: given anchor, number, row and column, and the sides of all of
/// them, the shape after the batch and the index.
type Layout = fn([usize; 4], [usize; 4]) -> (Vec<usize>, usize);

const LAYOUTS: [Layout; 5] = [
    |[a, k, v, u], [aa, kk, vv, uu]| (vec![aa * kk, vv, uu], ((a * kk + k) * vv + v) * uu + u),
    |[a, k, v, u], [aa, kk, vv, uu]| (vec![vv, uu, aa * kk], ((v * uu + u) * aa + a) * kk + k),
    |[a, k, v, u], [aa, kk, vv, uu]| (vec![aa, vv, uu, kk], ((a * vv + v) * uu + u) * kk + k),
    |[a, k, v, u], [aa, kk, vv, uu]| (vec![aa, kk, vv, uu], ((a * kk + k) * vv + v) * uu + u),
    |[a, k, v, u], [aa, kk, vv, uu]| (vec![vv, uu, aa, kk], ((v * uu + u) * aa + a) * kk + k),
];

fn yolov3(
    objects: &[Object],
    layout: Layout,
    strides: &[usize],
    anchors: &[[f64; 2]],
) -> Vec<Tensor> {
    // The coarsest first, as darknet and Keras have them.
    let grids = (0..strides.len()).rev();
    grids
        .map(|grid| {
            let stride = strides[grid];
            let cells = SIDE / stride;
            let sides = [3, 5 + CLASSES, cells, cells];
            let mut shape = layout([0; 4], sides).0;
            shape.insert(0, 1);
            let mut data = vec![-30.0; shape.iter().product()];
            for object in objects.iter().filter(|o| o.grid % strides.len() == grid) {
                let [u, v] = [object.x, object.y].map(|c| (c / stride as f64) as usize);
                // A centre next to a cell's edge has a logit that a float rounds off.
                let inside = |c: f64, cell: usize| c / stride as f64 - cell as f64;
                let anchor = anchors[3 * grid + object.anchor];
                let mut set = |k, value: f64| {
                    data[layout([object.anchor, k, v, u], sides).1] = value as f32;
                };
                set(0, logit(inside(object.x, u)));
                set(1, logit(inside(object.y, v)));
                set(2, (object.width / anchor[0]).ln());
                set(3, (object.height / anchor[1]).ln());
                set(4, logit(object.something));
                set(5 + object.class, logit(object.score));
            }
            tensor(&format!("grid{stride}"), &shape, data)
        })
        .collect()
}

/// Rows of numbers: box, something, classes.
fn rows(count: usize, objects: &[Object], unit: f64) -> Vec<f32> {
    let columns = 5 + CLASSES;
    let mut data = vec![0.0; count * columns];
    for (k, row) in data.chunks_exact_mut(columns).enumerate() {
        // Each cell says where it is, as networks do.
        row[0] = ((k % 52) as f64 * 8.0 / unit) as f32;
    }
    for (k, o) in objects.iter().enumerate() {
        let row = &mut data[(97 * k + 5) * columns..][..columns];
        let numbers = [o.x, o.y, o.width, o.height].map(|x| (x / unit) as f32);
        row[..4].copy_from_slice(&numbers);
        row[4] = o.something as f32;
        row[5 + o.class] = o.score as f32;
    }
    data
}

fn yolov8(objects: &[Object]) -> (usize, Vec<f32>) {
    let (count, columns) = (3549, 4 + CLASSES);
    let mut data = vec![0.0; count * columns];
    for (k, x) in data[..count].iter_mut().enumerate() {
        *x = ((k % 52) * 8) as f32;
    }
    for (k, o) in objects.iter().enumerate() {
        let at = 97 * k + 5;
        for (column, x) in [o.x, o.y, o.width, o.height].into_iter().enumerate() {
            data[column * count + at] = x as f32;
        }
        data[(4 + o.class) * count + at] = o.score as f32;
    }
    (columns, data)
}

fn yolox(objects: &[Object]) -> Vec<f32> {
    let columns = 5 + CLASSES;
    let mut data = Vec::new();
    for (grid, stride) in [8, 16, 32].into_iter().enumerate() {
        let cells = SIDE / stride;
        let start = data.len();
        data.resize(start + cells * cells * columns, 0.0);
        for o in objects.iter().filter(|o| o.grid == grid) {
            // A neighbouring cell reports it as well as its own does.
            let [u, v] = [o.x, o.y].map(|c| (c / stride as f64 + o.anchor as f64 - 1.0) as usize);
            let row = &mut data[start + (v * cells + u) * columns..][..columns];
            row[0] = (o.x / stride as f64 - u as f64) as f32;
            row[1] = (o.y / stride as f64 - v as f64) as f32;
            row[2] = (o.width / stride as f64).ln() as f32;
            row[3] = (o.height / stride as f64).ln() as f32;
            row[4] = o.something as f32;
            row[5 + o.class] = o.score as f32;
        }
    }
    data
}

/// Boxes as y and x of two corners, scores by class, and the rows that its own suppression would leave.
fn zoo(objects: &[Object], tiny: bool) -> FakeNetwork {
    let count = 40;
    let mut boxes = vec![0.0; count * 4];
    let mut scores = vec![0.0; CLASSES * count];
    let mut chosen = Vec::new();
    for (k, o) in objects.iter().enumerate() {
        let row = 4 * k + 1;
        let (w, h) = (o.width / 2.0, o.height / 2.0);
        let corners = [o.y - h, o.x - w, o.y + h, o.x + w];
        boxes[4 * row..4 * row + 4].copy_from_slice(&corners.map(|x| x as f32));
        scores[o.class * count + row] = o.score as f32;
        chosen.extend([0.0, o.class as f32, row as f32]);
    }
    // What the tiny export fills unused places with, and another batch.
    chosen.extend([-1.0, -1.0, -1.0, 1.0, 0.0, 1.0]);
    let left = chosen.len() / 3;
    let shape = if tiny {
        vec![1, left, 3]
    } else {
        vec![left, 3]
    };
    let mut indices = port("indices", &if tiny { vec![1, 0, 3] } else { vec![0, 3] });
    indices.element = Element::I32;
    let tensors = vec![
        tensor("boxes", &[1, count, 4], boxes),
        tensor("scores", &[1, CLASSES, count], scores),
        tensor("indices", &shape, chosen),
    ];
    FakeNetwork {
        inputs: vec![port("input_1", &[0, 3, 0, 0]), port("image_shape", &[0, 2])],
        outputs: vec![
            port("boxes", &[1, 0, 4]),
            port("scores", &[1, CLASSES, 0]),
            indices,
        ],
        metadata: Vec::new(),
        answer: Box::new(move |inputs| {
            assert_eq!(inputs[1].data, [416.0, 416.0]);
            tensors.clone()
        }),
    }
}

/// What a detector of one class sees in an image of 416 by 312 pixels times `scale`.
fn detect(
    network: FakeNetwork,
    description: &str,
    class: usize,
    scale: usize,
) -> (Family, Vec<Detection>) {
    let options = DetectorOptions::default().with(|o| {
        o.class = Some(ClassChoice::Number(class));
        o.tiling = TilingChoice::Whole;
    });
    let description = ModelDescription::parse(description, "test.toml").unwrap();
    let detector =
        OnnxDetector::new(Box::new(network), "test.onnx", &description, &options).unwrap();
    let image = ColorImage::filled(416 * scale, 312 * scale, [90, 140, 60]);
    (detector.family(), detector.detect(&image).unwrap())
}

/// All objects of each class are seen, where they are and as they score, and nothing else is.
fn check(
    objects: &[Object],
    family: Family,
    description: &str,
    scored_twice: bool,
    encode: impl Fn(&[Object]) -> FakeNetwork,
) {
    let above = if family == Family::YoloX { 0.0 } else { ABOVE };
    let moved: Vec<Object> = objects
        .iter()
        .map(|o| Object {
            y: o.y + above,
            ..*o
        })
        .collect();
    for scale in [1, 2] {
        for class in 0..CLASSES {
            let (found_family, found) = detect(encode(&moved), description, class, scale);
            assert_eq!(found_family, family);
            let mut expected: Vec<Detection> = objects
                .iter()
                .filter(|o| o.class == class)
                .map(|o| Detection {
                    x_min: (o.x - o.width / 2.0) * scale as f64,
                    y_min: (o.y - o.height / 2.0) * scale as f64,
                    x_max: (o.x + o.width / 2.0) * scale as f64,
                    y_max: (o.y + o.height / 2.0) * scale as f64,
                    score: if scored_twice {
                        o.score * o.something
                    } else {
                        o.score
                    },
                    class,
                })
                .filter(|d| d.score >= 0.25)
                .collect();
            expected.sort_by(|a, b| b.score.total_cmp(&a.score));
            assert_eq!(found.len(), expected.len(), "{found:?} {expected:?}");
            for (found, expected) in found.iter().zip(&expected) {
                let differences = [
                    found.x_min - expected.x_min,
                    found.y_min - expected.y_min,
                    found.x_max - expected.x_max,
                    found.y_max - expected.y_max,
                ];
                let largest = differences
                    .into_iter()
                    .fold(0.0, |m: f64, d| m.max(d.abs()));
                assert!(largest <= 1e-4 * scale as f64, "{found:?} {expected:?}");
                assert!((found.score - expected.score).abs() < 1e-6);
                assert_eq!(found.class, class);
            }
        }
    }
}

const ANCHORS: [[f64; 2]; 9] = [
    [10.0, 13.0],
    [16.0, 30.0],
    [33.0, 23.0],
    [30.0, 61.0],
    [62.0, 45.0],
    [59.0, 119.0],
    [116.0, 90.0],
    [156.0, 198.0],
    [373.0, 326.0],
];

const OWN: [[f64; 2]; 6] = [
    [9.0, 9.0],
    [17.0, 18.0],
    [30.0, 31.0],
    [40.0, 50.0],
    [60.0, 60.0],
    [99.0, 90.0],
];
const OWN_TOML: &str = "anchors = [[9, 9], [17, 18], [30, 31], [40, 50], [60, 60], [99, 90]]";

proptest! {
    #![proptest_config(ProptestConfig::with_cases(8))]

    #[test]
    fn yolov3_in_every_layout(objects in objects(), layout in 0..LAYOUTS.len()) {
        let layout = LAYOUTS[layout];
        check(&objects, Family::YoloV3, "", true, |objects| {
            fixed([SIDE; 2], yolov3(objects, layout, &[8, 16, 32], &ANCHORS))
        });
    }

    #[test]
    fn yolov3_tiny_and_anchors_of_one_s_own(objects in objects(), layout in 0..LAYOUTS.len()) {
        let tiny = [[10.0, 14.0], [23.0, 27.0], [37.0, 58.0], [81.0, 82.0], [135.0, 169.0], [344.0, 319.0]];
        let layout = LAYOUTS[layout];
        check(&objects, Family::YoloV3, "", true, |objects| {
            fixed([SIDE; 2], yolov3(objects, layout, &[16, 32], &tiny))
        });
        check(&objects, Family::YoloV3, OWN_TOML, true, |objects| {
            fixed([SIDE; 2], yolov3(objects, layout, &[16, 32], &OWN))
        });
    }

    #[test]
    fn yolov3_of_the_zoo(objects in objects(), tiny in any::<bool>()) {
        check(&objects, Family::YoloV3Nms, "", false, |objects| zoo(objects, tiny));
    }

    #[test]
    fn yolov5_in_pixels_and_in_shares(objects in objects()) {
        for unit in [1.0, SIDE as f64] {
            check(&objects, Family::YoloV5, "", true, |objects| {
                let data = rows(3 * 3549, objects, unit);
                fixed([SIDE; 2], vec![tensor("output0", &[1, 3 * 3549, 5 + CLASSES], data)])
            });
        }
    }

    #[test]
    fn yolox_that_decodes_itself_is_stated(objects in objects()) {
        check(&objects, Family::YoloV5, "family = 'yolov5'", true, |objects| {
            let data = rows(3549, objects, 1.0);
            fixed([SIDE; 2], vec![tensor("output", &[1, 3549, 5 + CLASSES], data)])
        });
    }

    #[test]
    fn yolov8_either_way_round(objects in objects()) {
        check(&objects, Family::YoloV8, "", false, |objects| {
            let (columns, data) = yolov8(objects);
            fixed([SIDE; 2], vec![tensor("output0", &[1, columns, 3549], data)])
        });
        check(&objects, Family::YoloV8, "family = 'yolov8'", false, |objects| {
            let (columns, data) = yolov8(objects);
            let turned = (0..data.len()).map(|k| data[k % columns * 3549 + k / columns]).collect();
            fixed([SIDE; 2], vec![tensor("output0", &[1, 3549, columns], turned)])
        });
    }

    #[test]
    fn yolox_on_its_grids(objects in objects()) {
        check(&objects, Family::YoloX, "", true, |objects| {
            fixed([SIDE; 2], vec![tensor("output", &[1, 3549, 5 + CLASSES], yolox(objects))])
        });
    }
}
