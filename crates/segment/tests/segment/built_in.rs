//! The built-in model, in both backends.

use pomona_cloud::{ColorImage, PixelWindow};
use pomona_segment::{Role, RuntimeChoice, Segmenter, SegmenterOptions};

fn open(runtime: &RuntimeChoice) -> Option<Box<dyn Segmenter>> {
    let mut options = SegmenterOptions::default();
    options.runtime = runtime.clone();
    match options.open() {
        Ok(segmenter) => Some(segmenter),
        Err(error) if *runtime == RuntimeChoice::OnnxRuntime => {
            eprintln!("skipped: {error}");
            None
        }
        Err(error) => panic!("{error}"),
    }
}

/// Brown branches before green leaves and a pale sky, drawn with a fixed pattern.
fn drawn(width: usize, height: usize) -> ColorImage {
    let mut image = ColorImage::filled(width, height, [150, 170, 190]);
    for (k, pixel) in image.pixels.iter_mut().enumerate() {
        let (u, v) = ((k % width) as f64, (k / width) as f64);
        let wave = (0.11 * u).sin() + (0.07 * v + 0.03 * u).cos();
        let noise = ((k * 7919) % 23) as u8;
        if wave > 0.2 {
            *pixel = [50 + noise, 90 + noise, 40];
        }
        let branch = (u - 0.4 * v - 40.0 * (v * 0.01).sin()).rem_euclid(170.0);
        if branch < 12.0 {
            let light = 1.0 - ((branch - 6.0) / 9.0).powi(2);
            *pixel = [110.0, 88.0, 70.0].map(|c| (c * light) as u8 + noise);
        }
    }
    image
}

#[test]
fn both_backends_give_the_same_probabilities() {
    let image = drawn(500, 430);
    let embedded = open(&RuntimeChoice::Embedded).unwrap();
    let Some(onnxruntime) = open(&RuntimeChoice::OnnxRuntime) else {
        return;
    };
    let (a, b) = (
        embedded.segment(&image).unwrap(),
        onnxruntime.segment(&image).unwrap(),
    );
    for class in 0..a.classes().len() {
        let planes = a.plane(class).unwrap().iter().zip(b.plane(class).unwrap());
        let most = planes.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(most <= 1e-3, "class {class}: {most}");
    }
}

#[test]
fn its_classes_are_those_of_the_orchard() {
    let segmenter = open(&RuntimeChoice::Embedded).unwrap();
    let names = ["rest", "wood", "peduncle", "fruit", "post"];
    assert_eq!(segmenter.classes().names(), names);
    for role in Role::ALL {
        assert_eq!(segmenter.classes().of(role).count(), 1, "{role:?}");
    }
    assert!(segmenter.report().notes.is_empty());
}

#[test]
fn a_part_of_the_image_shows_what_the_whole_shows() {
    let image = drawn(900, 500);
    let segmenter = open(&RuntimeChoice::Embedded).unwrap();
    let window = PixelWindow {
        x0: 20,
        y0: 30,
        x1: 120,
        y1: 110,
    };
    let part = segmenter.segment_windows(&image, &[window]).unwrap();
    assert!(part.seen_share() < 0.5);
    let whole = segmenter.segment(&image).unwrap();
    for v in window.y0..window.y1 {
        for u in window.x0..window.x1 {
            assert_eq!(
                part.probability(Role::Wood, u, v),
                whole.probability(Role::Wood, u, v)
            );
        }
    }
}

/// The mean difference of the probabilities of wood in the pixels that `counts` takes.
fn mean_difference(a: &[f32], b: &[f32], counts: impl Fn(usize) -> bool) -> f64 {
    let (mut sum, mut pixels) = (0.0, 0.0);
    for (k, (a, b)) in a.iter().zip(b).enumerate().filter(|(k, _)| counts(*k)) {
        assert!(a.is_finite() && b.is_finite(), "{k} is seen");
        sum += f64::from((a - b).abs());
        pixels += 1.0;
    }
    sum / pixels
}

/// Most that probabilities may differ in the mean by where the network's input begins.
const SEAM: f64 = 0.02;

#[test]
fn no_seam_shows_between_tiles() {
    // Two tiles, and one window over the seam between them.
    const SIDE: usize = 416;
    let image = drawn(700, SIDE);
    let segmenter = open(&RuntimeChoice::Embedded).unwrap();
    let tiled = segmenter.segment(&image).unwrap().role(Role::Wood);
    let first = (image.width - SIDE) / 2;
    let mut middle = ColorImage::filled(SIDE, SIDE, [0; 3]);
    for (v, row) in middle.pixels.chunks_exact_mut(SIDE).enumerate() {
        row.copy_from_slice(&image.pixels[v * image.width + first..][..SIDE]);
    }
    let seen = segmenter.segment(&middle).unwrap().role(Role::Wood);
    let mut reference = vec![f32::NAN; tiled.len()];
    for (v, row) in seen.chunks_exact(SIDE).enumerate() {
        reference[v * image.width + first..][..SIDE].copy_from_slice(row);
    }
    // A quarter of the window on either side of its middle, where the tiles overlap.
    let near = |k: usize| (k % image.width).abs_diff(image.width / 2) <= SIDE / 4;
    let mean = mean_difference(&tiled, &reference, near);
    assert!(mean <= SEAM, "{mean}");
}

#[test]
fn places_side_by_side_are_seen_as_they_are_in_the_image() {
    let image = drawn(900, 500);
    let segmenter = open(&RuntimeChoice::Embedded).unwrap();
    let place = |x0: usize, y0: usize| PixelWindow {
        x0,
        y0,
        x1: x0 + 100,
        y1: y0 + 100,
    };
    let places = [place(0, 0), place(420, 180), place(760, 390)];
    let seen = segmenter.segment_places(&image, &places).unwrap();
    assert!(seen.seen_share() < 0.15, "{}", seen.seen_share());
    let whole = segmenter.segment(&image).unwrap();
    let asked = |k: usize| {
        let (u, v) = (k % image.width, k / image.width);
        let holds = |p: &PixelWindow| (p.x0..p.x1).contains(&u) && (p.y0..p.y1).contains(&v);
        places.iter().any(holds)
    };
    let mean = mean_difference(&seen.role(Role::Wood), &whole.role(Role::Wood), asked);
    assert!(mean <= SEAM, "{mean}");
}

#[test]
fn several_zooms_give_their_mean() {
    let at = |zooms: &[f64]| {
        let mut options = SegmenterOptions::default();
        options.runtime = RuntimeChoice::Embedded;
        options.zooms = zooms.to_vec();
        options.open().unwrap()
    };
    let image = drawn(260, 230);
    let window = PixelWindow {
        x0: 40,
        y0: 30,
        x1: 70,
        y1: 55,
    };
    let seen = |zooms: &[f64]| at(zooms).segment_windows(&image, &[window]).unwrap();
    let (one, two, both) = (seen(&[]), seen(&[2.0]), seen(&[1.0, 2.0]));
    let mut difference: f32 = 0.0;
    for (u, v) in [(40, 30), (52, 41), (69, 54)] {
        let wood =
            |seen: &pomona_segment::Segmentation| seen.probability(Role::Wood, u, v).unwrap();
        assert!((0.5 * (wood(&one) + wood(&two)) - wood(&both)).abs() < 1e-5);
        difference = difference.max((wood(&one) - wood(&two)).abs());
    }
    assert!(difference > 1e-4, "two zooms see the same: {difference}");
    assert_eq!(both.probability(Role::Wood, 39, 30), None);
}

#[test]
fn zooms_that_make_no_sense_are_refused() {
    for zoom in [0.0, -1.0, f64::NAN, 1e9] {
        let mut options = SegmenterOptions::default();
        options.zooms = vec![zoom];
        let Err(error) = options.open().map(|_| ()) else {
            panic!("{zoom}");
        };
        assert!(error.to_string().contains("from 0.1 to 8"), "{error}");
    }
}
