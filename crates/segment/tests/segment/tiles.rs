//! Tiles, windows and scales change nothing of what is seen.

use crate::fake_network::redness;
use pomona_cloud::{ColorImage, PixelWindow};
use pomona_segment::{OnnxSegmenter, Role, SegmentDescription, Segmenter, TilingChoice, UNSEEN};
use proptest::prelude::*;

fn description(text: &str) -> SegmentDescription {
    let text = format!("classes = ['leaf', 'branch']\nactivation = 'none'\nfill = 0\n{text}");
    SegmentDescription::parse(&text, "m.toml").unwrap()
}

/// An image whose red changes slowly and differs from pixel to pixel.
fn image(width: usize, height: usize) -> ColorImage {
    let mut image = ColorImage::filled(width, height, [0; 3]);
    for (k, pixel) in image.pixels.iter_mut().enumerate() {
        let (u, v) = (k % width, k / width);
        pixel[0] = ((3 * u + 2 * v) % 256) as u8;
    }
    image
}

fn segmenter(shrink: usize) -> OnnxSegmenter {
    let description = description("tile = 32\ntile_overlap = 8");
    OnnxSegmenter::new(
        Box::new(redness([32, 32], shrink)),
        "redness",
        &description,
        TilingChoice::Automatic,
    )
    .unwrap()
}

proptest! {
    #[test]
    fn every_pixel_is_seen_as_it_is(width in 32_usize..150, height in 32_usize..150) {
        let image = image(width, height);
        let seen = segmenter(1).segment(&image).unwrap();
        prop_assert_eq!((seen.width(), seen.height()), (width, height));
        for (k, pixel) in image.pixels.iter().enumerate() {
            let p = seen.probability(Role::Wood, k % width, k / width).unwrap();
            prop_assert!((p - f32::from(pixel[0]) / 255.0).abs() < 1e-5);
        }
    }

    #[test]
    fn a_window_shows_what_the_whole_image_shows(
        x in 0_usize..100, y in 0_usize..60, width in 1_usize..60, height in 1_usize..60,
    ) {
        let image = image(160, 120);
        let segmenter = segmenter(2);
        let window = PixelWindow { x0: x, y0: y, x1: x + width, y1: y + height };
        let part = segmenter.segment_windows(&image, &[window]).unwrap();
        let whole = segmenter.segment(&image).unwrap();
        for v in y..y + height {
            for u in x..x + width {
                let p = part.probability(Role::Wood, u, v);
                prop_assert!(p.is_some() && p == whole.probability(Role::Wood, u, v));
            }
        }
        prop_assert!(whole.seen_share() == 1.0);
    }
}

#[test]
fn only_the_tiles_about_the_windows_are_run() {
    let image = image(320, 240);
    let window = PixelWindow {
        x0: 10,
        y0: 10,
        x1: 14,
        y1: 14,
    };
    let seen = segmenter(1).segment_windows(&image, &[window]).unwrap();
    assert!(seen.seen_share() < 0.05, "{}", seen.seen_share());
    assert_eq!(seen.likeliest()[0], 0);
    assert_eq!(seen.likeliest()[320 * 240 - 1], UNSEEN);
    let none = segmenter(1).segment_windows(&image, &[]).unwrap();
    assert_eq!(none.seen_share(), 0.0);
}

#[test]
fn a_coarse_output_is_interpolated() {
    // A bright half: the edge is where it is in the image, to within a cell of the output.
    let mut image = ColorImage::filled(64, 32, [0; 3]);
    for row in image.pixels.chunks_exact_mut(64) {
        row[28..].fill([255, 0, 0]);
    }
    let seen = segmenter(4).segment(&image).unwrap();
    for v in 0..32 {
        let wood = |u| seen.probability(Role::Wood, u, v).unwrap();
        assert!(wood(25) < 0.01 && wood(30) > 0.99 && wood(27) < 0.5 && wood(28) > 0.5);
    }
}

#[test]
fn an_image_smaller_than_the_input_is_padded() {
    let small = image(20, 9);
    let seen = segmenter(1).segment(&small).unwrap();
    assert_eq!(
        (seen.width(), seen.height(), seen.seen_share()),
        (20, 9, 1.0)
    );
}

#[test]
fn threads_change_nothing() {
    let image = image(200, 150);
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        pool.build()
            .unwrap()
            .install(|| segmenter(2).segment(&image).unwrap())
    };
    assert_eq!(on(1), on(4));
}
