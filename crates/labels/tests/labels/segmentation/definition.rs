//! Random strokes and marks measured twice: by the library, and by the definitions of `docs/segmentation.md`.

use super::orchard::{ByColor, Channel, OPTIONS, STROKES, painted, read, source};
use pomona_cloud::ColorImage;
use pomona_labels::{Stroke, StrokeClass, StrokePoint, evaluate_segmentation, segmentation_images};
use proptest::prelude::*;
use rand_chacha::ChaCha8Rng;
use rand_core::{Rng, SeedableRng};
use std::path::Path;

/// Recall of wide wood, precision, intersection over union, pixel by pixel.
fn by_definition(strokes: &[Stroke], image: &ColorImage, tolerance: f64) -> [f64; 3] {
    let centre = |k: usize| {
        let (u, v) = (k % image.width, k / image.width);
        [u as f64 + 0.5, v as f64 + 0.5]
    };
    let edge = |place: [f64; 2]| {
        let of_pair = |pair: &[StrokePoint]| {
            let piece = Stroke::new(StrokeClass::Wood, pair.to_vec());
            let (distance, half_width) = piece.nearest(place);
            distance - half_width
        };
        let pairs = strokes.iter().flat_map(|stroke| stroke.points.windows(2));
        pairs.map(of_pair).fold(f64::INFINITY, f64::min)
    };
    let is_marked = |k: usize| image.pixels[k][0] >= 128;
    let (mut marked, mut near, mut common, mut wood) = (0.0, 0.0, 0.0, 0.0);
    for k in 0..image.pixels.len() {
        let [is_marked, edge] = [f64::from(is_marked(k)), edge(centre(k))];
        let [is_near, is_wood] = [tolerance, 0.0].map(|limit| f64::from(edge <= limit));
        marked += is_marked;
        near += is_marked * is_near;
        common += is_marked * is_wood;
        wood += is_wood;
    }
    let (mut found, mut length) = (0.0, 0.0);
    for sample in strokes.iter().flat_map(Stroke::samples) {
        let (x, y) = (sample.point.x, sample.point.y);
        let inside = x >= 0.0 && x <= image.width as f64 && y >= 0.0 && y <= image.height as f64;
        if !inside || 2.0 * sample.point.half_width < 4.0 {
            continue;
        }
        let finds = |k: usize| {
            let [u, v] = centre(k);
            let holds = (u - x).abs() <= 0.5 && (v - y).abs() <= 0.5;
            is_marked(k) && (holds || (u - x).hypot(v - y) <= tolerance)
        };
        length += sample.length;
        found += sample.length * f64::from((0..image.pixels.len()).any(finds));
    }
    [
        found / length,
        near / marked,
        common / (marked + wood - common),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn any_strokes_and_marks_are_measured_as_defined(
        seed in 0..1_000_000_u64,
        share in 0.005..0.3_f64,
        tolerance in prop_oneof![Just(0.0), Just(3.0), 0.1..6.0_f64],
    ) {
        let size = [36, 28];
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let mut unit = || f64::from(rng.next_u32()) / f64::from(u32::MAX);
        let mut image = painted(size, &[]);
        for pixel in &mut image.pixels {
            pixel[0] = if unit() < share { 200 } else { 60 };
        }
        let mut text = "image a.png\n".to_owned();
        for _ in 0..3 {
            text += "wood";
            for _ in 0..3 {
                let (x, y) = (36.0 * unit(), 28.0 * unit());
                let point = format!(" {x},{y},{}", 1.0 + 3.0 * unit());
                text += &point;
            }
            text += "\n";
        }
        let dir = tempfile::tempdir().unwrap();
        image.write(dir.path().join("a.png")).unwrap();
        let images = segmentation_images(dir.path(), read(&text), Path::new(STROKES)).unwrap();
        let segmenter = ByColor::new(Channel::Red);
        let mut options = OPTIONS;
        options.tolerance_px = tolerance;
        let sources = [source(&segmenter)];
        let evaluation =
            evaluate_segmentation("random", &images, &[], &sources, &options, &|| {}).unwrap();
        let result = &evaluation.results[0];
        let expected = by_definition(&images[0].strokes().unwrap().strokes, &image, tolerance);
        let figures = [result.recall_wide, result.precision, result.iou];
        for (figure, expected) in figures.iter().zip(expected) {
            match figure {
                Some(figure) => prop_assert!((figure.value - expected).abs() < 1e-9, "{figure:?}, not {expected}"),
                None => prop_assert!(expected.is_nan(), "absent, not {expected}"),
            }
        }
    }
}
