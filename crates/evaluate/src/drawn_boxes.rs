//! Boxes drawn by seed: about apples, as a person or a detector draws them, and on what is no apple.

use pomona_cloud::{Frame, PixelBox};
use pomona_scenes::AppleTruth;
use rand_chacha::ChaCha8Rng;
use rand_core::{Rng, SeedableRng};

/// An edge of a drawn box is off by up to this share of its side.
const MOST_OFF: f64 = 0.1;

/// Sides of boxes on nothing, as shares of those of the frame's apples.
const SIZES: (f64, f64) = (0.5, 1.8);

/// Boxes on nothing are tried so often for each that is drawn.
const TRIES: usize = 20;

/// The boxes of `apples`, each edge moved by up to a tenth of its side.
pub fn boxes_about(apples: &[AppleTruth], frame: &Frame, seed: u64) -> Vec<PixelBox> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let (width, height) = size(frame);
    let drawn = apples.iter().map(|apple| {
        let b = &apple.bounds;
        let (w, h) = (b.width(), b.height());
        let mut moved = |edge: f64, side: f64, end: f64| {
            (edge + side * MOST_OFF * (2.0 * share(&mut rng) - 1.0)).clamp(0.0, end)
        };
        PixelBox {
            x_min: moved(b.x_min, w, width),
            y_min: moved(b.y_min, h, height),
            x_max: moved(b.x_max, w, width),
            y_max: moved(b.y_max, h, height),
            ..b.clone()
        }
    });
    drawn
        .filter(|b| b.validate(frame.color.width, frame.color.height).is_ok())
        .collect()
}

/// Up to `count` boxes that touch no box of `apples`, each about a pixel with a reading of depth. Their sides are 0.5 to
/// 1.8 times those of an apple of the frame. None where the frame has no apples or no readings.
pub fn boxes_on_nothing(
    apples: &[AppleTruth],
    frame: &Frame,
    count: usize,
    seed: u64,
) -> Vec<PixelBox> {
    let readings: Vec<usize> = (0..frame.depth.readings.len())
        .filter(|&i| frame.depth.readings[i] > 0)
        .collect();
    if apples.is_empty() || readings.is_empty() {
        return Vec::new();
    }
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let (width, height) = size(frame);
    let mut boxes = Vec::new();
    for _ in 0..count * TRIES {
        if boxes.len() == count {
            break;
        }
        let model = &apples[below(&mut rng, apples.len())].bounds;
        let scale = SIZES.0 + (SIZES.1 - SIZES.0) * share(&mut rng);
        let (w, h) = (scale * model.width(), scale * model.height());
        let pixel = readings[below(&mut rng, readings.len())];
        let (u, v) = (pixel % frame.depth.width, pixel / frame.depth.width);
        // The reading lies anywhere in the box.
        let x_min = u as f64 - w * share(&mut rng);
        let y_min = v as f64 - h * share(&mut rng);
        let drawn = PixelBox {
            name: boxes.len().to_string(),
            x_min,
            y_min,
            x_max: x_min + w,
            y_max: y_min + h,
            score: 1.0,
        };
        let inside = x_min >= 0.0 && y_min >= 0.0 && drawn.x_max <= width && drawn.y_max <= height;
        if inside && apples.iter().all(|apple| apart(&drawn, &apple.bounds)) {
            boxes.push(drawn);
        }
    }
    boxes
}

fn apart(a: &PixelBox, b: &PixelBox) -> bool {
    a.x_max < b.x_min || b.x_max < a.x_min || a.y_max < b.y_min || b.y_max < a.y_min
}

fn size(frame: &Frame) -> (f64, f64) {
    (frame.color.width as f64, frame.color.height as f64)
}

/// Uniform in 0..1.
fn share(rng: &mut ChaCha8Rng) -> f64 {
    f64::from(rng.next_u32()) / (f64::from(u32::MAX) + 1.0)
}

fn below(rng: &mut ChaCha8Rng, n: usize) -> usize {
    ((u64::from(rng.next_u32()) * n as u64) >> 32) as usize
}
