//! Small places of a large image, several of them in one run of the network.

use crate::fake_network::redness;
use pomona_cloud::{ColorImage, PixelWindow};
use pomona_segment::{OnnxSegmenter, Role, SegmentDescription, Segmenter, TilingChoice};
use proptest::prelude::*;

const SIDE: usize = 96;

fn segmenter(tile: usize, choice: TilingChoice) -> OnnxSegmenter {
    let text = format!(
        "classes = ['leaf', 'branch']\nactivation = 'none'\ntile = {tile}\ntile_overlap = 8"
    );
    let description = SegmentDescription::parse(&text, "m.toml").unwrap();
    let network = Box::new(redness([SIDE, SIDE], 1));
    OnnxSegmenter::new(network, "redness", &description, choice).unwrap()
}

fn image(width: usize, height: usize) -> ColorImage {
    let mut image = ColorImage::filled(width, height, [0; 3]);
    for (k, pixel) in image.pixels.iter_mut().enumerate() {
        pixel[0] = ((3 * (k % width) + 2 * (k / width)) % 256) as u8;
    }
    image
}

fn place(x0: usize, y0: usize, width: usize, height: usize) -> PixelWindow {
    PixelWindow {
        x0,
        y0,
        x1: x0 + width,
        y1: y0 + height,
    }
}

fn places() -> impl Strategy<Value = Vec<PixelWindow>> {
    let place = (0_usize..300, 0_usize..200, 1_usize..60, 1_usize..60).prop_map(
        |(x0, y0, width, height)| place(x0, y0, width.min(320 - x0), height.min(240 - y0)),
    );
    proptest::collection::vec(place, 0..7)
}

proptest! {
    #[test]
    fn every_place_is_seen_where_it_is_and_in_no_more_runs(places in places()) {
        let image = image(320, 240);
        let segmenter = segmenter(SIDE, TilingChoice::Automatic);
        let size = [image.width, image.height];
        prop_assert!(
            segmenter.runs_for_places(size, &places) <= segmenter.runs_for_windows(size, &places)
        );
        let seen = segmenter.segment_places(&image, &places).unwrap();
        prop_assert_eq!((seen.width(), seen.height()), (320, 240));
        for place in &places {
            for v in place.y0..place.y1 {
                for u in place.x0..place.x1 {
                    let p = seen.probability(Role::Wood, u, v).unwrap();
                    let red = image.pixels[v * image.width + u][0];
                    prop_assert!((p - f32::from(red) / 255.0).abs() < 1e-5);
                }
            }
        }
    }
}

#[test]
fn small_places_in_all_corners_are_one_run() {
    let image = image(320, 240);
    let size = [image.width, image.height];
    let places = [
        place(0, 0, 8, 8),
        place(312, 0, 8, 8),
        place(0, 232, 8, 8),
        place(312, 232, 8, 8),
    ];
    let segmenter = segmenter(SIDE, TilingChoice::Automatic);
    assert_eq!(segmenter.runs_for_windows(size, &places), 4);
    assert_eq!(segmenter.runs_for_places(size, &places), 1);
    let seen = segmenter.segment_places(&image, &places).unwrap();
    assert!(seen.seen_share() < 0.1, "{}", seen.seen_share());
    let none = segmenter.segment_places(&image, &[]).unwrap();
    assert_eq!(none.seen_share(), 0.0);
}

#[test]
fn nothing_is_put_beside_anything_else_where_tiles_are_scaled_or_chosen() {
    let image = image(320, 240);
    let size = [image.width, image.height];
    let places = [place(0, 0, 8, 8), place(312, 232, 8, 8)];
    let grid = TilingChoice::Grid {
        columns: 4,
        rows: 3,
    };
    for segmenter in [
        segmenter(SIDE / 2, TilingChoice::Automatic),
        segmenter(SIDE, grid),
        segmenter(SIDE, TilingChoice::Whole),
    ] {
        let runs = segmenter.runs_for_windows(size, &places);
        assert_eq!(segmenter.runs_for_places(size, &places), runs);
        let exact = segmenter.segment_windows(&image, &places).unwrap();
        let seen = segmenter.segment_places(&image, &places).unwrap();
        assert_eq!(seen.likeliest(), exact.likeliest());
    }
}

#[test]
fn threads_change_nothing() {
    let image = image(320, 240);
    let places: Vec<PixelWindow> = (0..9).map(|k| place(30 * k, 24 * k, 40, 30)).collect();
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let segmenter = segmenter(SIDE, TilingChoice::Automatic);
        let seen = pool
            .build()
            .unwrap()
            .install(|| segmenter.segment_places(&image, &places).unwrap());
        let bits = |p: f32| p.to_bits();
        seen.role(Role::Wood)
            .into_iter()
            .map(bits)
            .collect::<Vec<_>>()
    };
    assert_eq!(on(1), on(4));
}

#[test]
fn a_place_outside_of_the_image_is_refused() {
    let refused = segmenter(SIDE, TilingChoice::Automatic)
        .segment_places(&image(320, 240), &[place(310, 0, 11, 5)])
        .unwrap_err();
    assert!(refused.to_string().contains("320"), "{refused}");
}
