//! Large images: what is drawn is found where it is, once, whatever tile shows it, for any number of threads.

use crate::fake_network::{FakeNetwork, fixed};
use pomona_cloud::ColorImage;
use pomona_detect::{
    Detection, Detector, DetectorOptions, ModelDescription, OnnxDetector, TilingChoice,
};
use pomona_network::Tensor;
use proptest::prelude::*;

const SIDE: usize = 96;
const ROWS: usize = 189;
const BACKGROUND: [u8; 3] = [30, 90, 30];

/// Sees the bright rectangles in its input: it answers as a `YOLOv8` would, with the box around each patch of pixels
/// whose red is above half between red and the background, its edges by how much red the last pixels have.
fn network() -> FakeNetwork {
    let template = Tensor {
        name: "boxes".to_owned(),
        shape: vec![1, 5, ROWS],
        data: Vec::new(),
    };
    FakeNetwork {
        answer: Box::new(|inputs| {
            let boxes = patches(&inputs[0].data[..SIDE * SIDE]);
            let mut data = vec![0.0; 5 * ROWS];
            data[0] = SIDE as f32;
            for (k, [x0, y0, x1, y1]) in boxes.into_iter().enumerate() {
                let numbers = [
                    f32::midpoint(x0, x1),
                    f32::midpoint(y0, y1),
                    x1 - x0,
                    y1 - y0,
                    0.9,
                ];
                for (column, x) in numbers.into_iter().enumerate() {
                    data[column * ROWS + k + 1] = x;
                }
            }
            vec![Tensor {
                name: "boxes".to_owned(),
                shape: vec![1, 5, ROWS],
                data,
            }]
        }),
        ..fixed([SIDE; 2], vec![template])
    }
}

fn patches(red: &[f32]) -> Vec<[f32; 4]> {
    let bright = |x: f32| x > 0.51;
    let mut seen = vec![false; red.len()];
    let mut boxes = Vec::new();
    for start in 0..red.len() {
        if seen[start] || !bright(red[start]) {
            continue;
        }
        let mut around = [SIDE, SIDE, 0, 0];
        let mut open = vec![start];
        seen[start] = true;
        while let Some(at) = open.pop() {
            let (u, v) = (at % SIDE, at / SIDE);
            around = [
                around[0].min(u),
                around[1].min(v),
                around[2].max(u + 1),
                around[3].max(v + 1),
            ];
            let mut go = |inside: bool, to: usize| {
                if inside && !seen[to] && bright(red[to]) {
                    seen[to] = true;
                    open.push(to);
                }
            };
            go(u > 0, at.wrapping_sub(1));
            go(u + 1 < SIDE, at + 1);
            go(v > 0, at.wrapping_sub(SIDE));
            go(v + 1 < SIDE, at + SIDE);
        }
        boxes.push(around.map(|edge| edge as f32));
    }
    boxes
}

fn detector(tiling: TilingChoice) -> OnnxDetector {
    // What is at most 37 pixels wide lies whole in a tile, more than the margin of cut boxes from its borders.
    let text = "coordinates = 'pixels'\ntile = 96\ntile_overlap = 46\nfill = 0";
    let description = ModelDescription::parse(text, "fake.toml").unwrap();
    let options = DetectorOptions::default().with(|o| o.tiling = tiling);
    OnnxDetector::new(Box::new(network()), "fake", &description, &options).unwrap()
}

/// Rectangles that do not touch, one in each cell of a lattice of 60 pixels, and the image's size.
fn rectangles() -> impl Strategy<Value = (Vec<[usize; 4]>, [usize; 2])> {
    // Of one or two pixels of the scaled whole image, or of so many that its box is like that of the tiles.
    let small = (2..40_usize, 2..40_usize, 6..18_usize, 6..18_usize);
    let large = (2..18_usize, 2..18_usize, 18..38_usize, 18..38_usize);
    let one = prop::option::of(prop_oneof![small, large]);
    let cells = prop::collection::vec(one, 7 * 5);
    (cells, 0..60_usize, 0..60_usize).prop_map(|(cells, wider, higher)| {
        let place = |(k, cell): (usize, Option<_>)| {
            let (x, y, width, height) = cell?;
            let (x0, y0) = (60 * (k % 7) + x, 60 * (k / 7) + y);
            Some([x0, y0, x0 + width, y0 + height])
        };
        let drawn = cells.into_iter().enumerate().filter_map(place).collect();
        (drawn, [7 * 60 + wider, 5 * 60 + higher])
    })
}

fn draw(rectangles: &[[usize; 4]], [width, height]: [usize; 2]) -> ColorImage {
    let mut image = ColorImage::filled(width, height, BACKGROUND);
    for [x0, y0, x1, y1] in rectangles {
        for v in *y0..*y1 {
            for u in *x0..*x1 {
                image.pixels[v * width + u] = [230, 30, 30];
            }
        }
    }
    image
}

fn edges(found: &Detection) -> [f64; 4] {
    [found.x_min, found.y_min, found.x_max, found.y_max]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn each_is_found_once_and_where_it_is((drawn, size) in rectangles()) {
        let image = draw(&drawn, size);
        let detector = detector(TilingChoice::Automatic);
        prop_assert!(detector.windows([image.width, image.height]).len() > 20);
        let found = detector.detect(&image).unwrap();
        prop_assert_eq!(found.len(), drawn.len(), "{:?} {:?}", &found, &drawn);
        for edge in &drawn {
            let expected = edge.map(|edge| edge as f64);
            // Tiles show each pixel as one; what the scaled whole image adds weighs a twentieth.
            let near = |found: &Detection| {
                edges(found).into_iter().zip(expected).all(|(a, b)| (a - b).abs() < 0.5)
            };
            prop_assert!(found.iter().any(near), "{:?} {:?}", &found, edge);
        }
    }

    #[test]
    fn the_number_of_threads_changes_nothing((drawn, size) in rectangles()) {
        let image = draw(&drawn, size);
        let found = [1, 2, 5].map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| detector(TilingChoice::Automatic).detect(&image).unwrap())
        });
        prop_assert_eq!(&found[0], &found[1]);
        prop_assert_eq!(&found[0], &found[2]);
    }
}

#[test]
fn what_is_larger_than_a_tile_is_found_whole() {
    let image = draw(&[[100, 60, 290, 240]], [400, 300]);
    let near = |found: &[Detection], within: f64| {
        assert_eq!(found.len(), 1, "{found:?}");
        let expected = [100.0, 60.0, 290.0, 240.0];
        let close = edges(&found[0])
            .into_iter()
            .zip(expected)
            .all(|(a, b)| (a - b).abs() <= within);
        assert!(close, "{found:?}");
    };
    // A pixel of the whole image's pass is 4.2 of the image's.
    near(
        &detector(TilingChoice::Automatic).detect(&image).unwrap(),
        4.2,
    );
    near(&detector(TilingChoice::Whole).detect(&image).unwrap(), 4.2);
    // Tiles alone have only parts of it, which overlap.
    let grid = TilingChoice::Grid {
        columns: 2,
        rows: 2,
    };
    near(&detector(grid).detect(&image).unwrap(), 2.3);
}

#[test]
fn an_image_without_pixels_is_refused() {
    let detector = detector(TilingChoice::Automatic);
    for (width, height, pixels) in [(0, 0, 0), (0, 5, 0), (4, 4, 15), (usize::MAX, 2, 3)] {
        let image = ColorImage {
            width,
            height,
            pixels: vec![[0; 3]; pixels],
        };
        let message = detector.detect(&image).unwrap_err().to_string();
        assert!(message.contains("pixels"), "{message}");
    }
    assert!(
        detector
            .detect(&ColorImage::filled(1, 1, [0; 3]))
            .unwrap()
            .is_empty()
    );
    assert!(
        detector
            .detect(&ColorImage::filled(3000, 1, [0; 3]))
            .unwrap()
            .is_empty()
    );
}
