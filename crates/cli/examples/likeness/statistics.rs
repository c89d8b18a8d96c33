//! What frames are like about their boxed apples.

use crate::source::Source;
use pomona_cloud::{Frame, PixelBox, PixelWindow};
use pomona_evaluate::RealFrame;
use pomona_segment::{Role, Segmenter};
use pomona_statistics::inverse_cdf;
use std::error::Error;

/// Radii about an apple within which it is looked at: the shell in which methods look for the branch.
const REACH_RADII: f64 = 3.0;

/// Least difference of neighbouring readings that is a jump, metres.
const JUMP_M: f64 = 0.015;

/// Grey value from which a pixel is bright background rather than a leaf.
const BRIGHT: f64 = 190.0;

/// Probability from which the segmenter's wood counts as found.
const FOUND: f32 = 0.5;

/// Readings farther behind an apple's rim than the surface of a sphere are smeared where they are between the two
/// sides: depth of the rim's band, radii.
const RIM_RADII: (f64, f64) = (0.7, 1.5);

/// Sums over all apples of a source.
#[derive(Default)]
struct Sums {
    near: usize,
    read: usize,
    pairs: usize,
    jumps: usize,
    wood: usize,
    wood_read: usize,
    fruit: usize,
    leaf: usize,
    bright: usize,
    told_wood: usize,
    told_right: usize,
    found_wood: usize,
    widths: Vec<f64>,
    smears: Vec<f64>,
    box_radii: Vec<f64>,
    box_read: usize,
    box_pixels: usize,
}

/// The rows of the table.
pub(crate) fn rows(
    source: &Source,
    segmenter: &dyn Segmenter,
) -> Result<Vec<(String, String)>, Box<dyn Error>> {
    let mut sums = Sums::default();
    let (mut pixels, mut readings, mut apples) = (0, 0, 0);
    for frame in &source.frames {
        pixels += frame.frame.depth.readings.len();
        readings += frame.frame.depth.reading_count();
        let windows: Vec<PixelWindow> = source
            .boxes(frame)
            .map(|b| window(b, &frame.frame))
            .collect();
        if windows.is_empty() {
            continue;
        }
        apples += windows.len();
        let seen = segmenter.segment_windows(&frame.frame.color, &windows)?;
        let (wood, fruit) = (seen.role(Role::Wood), seen.role(Role::Fruit));
        let drawn = drawn(frame);
        for bounds in source.boxes(frame) {
            sums.add(&frame.frame, bounds, (&wood, &fruit), &drawn);
        }
    }
    let share =
        |part: usize, all: usize| format!("{:.1} %", 100.0 * part as f64 / all.max(1) as f64);
    let near = sums.near;
    let row = |name: &str, value: String| (name.to_owned(), value);
    Ok(vec![
        row(
            "frames, apples",
            format!("{}, {apples}", source.frames.len()),
        ),
        row("pixels with a reading, frame", share(readings, pixels)),
        row("the same within 3 r of apples", share(sums.read, near)),
        row(
            "the same on the middle of apples",
            share(sums.box_read, sums.box_pixels),
        ),
        row(
            "neighbouring readings that jump by 15 mm, within 3 r",
            share(sums.jumps, sums.pairs),
        ),
        row("wood within 3 r", share(sums.wood, near)),
        row("fruit within 3 r", share(sums.fruit, near)),
        row(
            "leaves and dark background within 3 r",
            share(sums.leaf, near),
        ),
        row("bright background within 3 r", share(sums.bright, near)),
        row(
            "pixels of wood with a reading",
            share(sums.wood_read, sums.wood),
        ),
        row(
            "width of wood, pixels: median (quartiles)",
            quartiles(&mut sums.widths),
        ),
        row(
            "box radius, pixels: median (quartiles)",
            quartiles(&mut sums.box_radii),
        ),
        row(
            "smear at the rim of apples, pixels: median (quartiles)",
            quartiles(&mut sums.smears),
        ),
        row(
            "recall of wood by the built-in segmenter",
            share(sums.found_wood, sums.wood),
        ),
        row("precision of it", share(sums.told_right, sums.told_wood)),
    ])
}

fn quartiles(values: &mut [f64]) -> String {
    let mut at = |share: f64| inverse_cdf(values, share).unwrap_or(f64::NAN);
    let (low, middle, high) = (at(0.25), at(0.5), at(0.75));
    format!("{middle:.1} ({low:.1}–{high:.1})")
}

fn radius(bounds: &PixelBox) -> f64 {
    0.25 * (bounds.x_max - bounds.x_min + bounds.y_max - bounds.y_min)
}

fn middle(bounds: &PixelBox) -> (f64, f64) {
    (
        0.5 * (bounds.x_min + bounds.x_max),
        0.5 * (bounds.y_min + bounds.y_max),
    )
}

fn window(bounds: &PixelBox, frame: &Frame) -> PixelWindow {
    let reach = REACH_RADII * radius(bounds);
    let (x, y) = middle(bounds);
    PixelWindow::clamped(
        x - reach,
        y - reach,
        x + reach,
        y + reach,
        frame.color.width,
        frame.color.height,
    )
}

/// For each pixel on a stroke of wood the width of the stroke there, 0 elsewhere.
fn drawn(frame: &RealFrame) -> Vec<f32> {
    let (width, height) = (frame.frame.color.width, frame.frame.color.height);
    let mut widths = vec![0.0f32; width * height];
    for stroke in frame.wood_strokes() {
        for sample in stroke.samples() {
            let point = sample.point;
            let reach = point.half_width.max(0.5);
            let range = |at: f64, size: usize| {
                let low = (at - reach).floor().max(0.0) as usize;
                let high = (at + reach).ceil().clamp(0.0, size as f64) as usize;
                low..high
            };
            for v in range(point.y, height) {
                for u in range(point.x, width) {
                    let off = (u as f64 + 0.5 - point.x).hypot(v as f64 + 0.5 - point.y);
                    if off <= reach {
                        widths[v * width + u] = (2.0 * point.half_width) as f32;
                    }
                }
            }
        }
    }
    widths
}

impl Sums {
    fn add(
        &mut self,
        frame: &Frame,
        bounds: &PixelBox,
        (wood, fruit): (&[f32], &[f32]),
        drawn: &[f32],
    ) {
        let (r, (x, y)) = (radius(bounds), middle(bounds));
        self.box_radii.push(r);
        let width = frame.color.width;
        let area = window(bounds, frame);
        let depth = |u: usize, v: usize| frame.depth.get(u, v).map(f64::from);
        let scale = frame.camera.depth_scale;
        for v in area.y0..area.y1 {
            for u in area.x0..area.x1 {
                let off = (u as f64 + 0.5 - x).hypot(v as f64 + 0.5 - y) / r;
                if off > REACH_RADII {
                    continue;
                }
                let pixel = v * width + u;
                self.near += 1;
                let own = depth(u, v);
                self.read += usize::from(own.is_some());
                if off < 0.7 {
                    self.box_pixels += 1;
                    self.box_read += usize::from(own.is_some());
                }
                for next in [depth(u + 1, v), depth(u, v + 1)] {
                    if let (Some(own), Some(next)) = (own, next) {
                        self.pairs += 1;
                        self.jumps += usize::from((own - next).abs() * scale > JUMP_M);
                    }
                }
                let is_wood = drawn[pixel] > 0.0;
                let told = wood[pixel] >= FOUND;
                self.told_wood += usize::from(told);
                self.told_right += usize::from(told && is_wood);
                let grey = frame.color.pixels[pixel].map(f64::from).iter().sum::<f64>() / 3.0;
                if is_wood {
                    self.wood += 1;
                    self.wood_read += usize::from(own.is_some());
                    self.found_wood += usize::from(told);
                    self.widths.push(f64::from(drawn[pixel]));
                } else if fruit[pixel] >= FOUND {
                    self.fruit += 1;
                } else if grey >= BRIGHT {
                    self.bright += 1;
                } else {
                    self.leaf += 1;
                }
            }
        }
        self.smears.extend(smears(frame, bounds));
    }
}

/// Lengths in pixels over which depth goes from an apple's own to what lies behind, along rays from its middle: readings
/// without a gap whose depth is between 10 and 90 % of the way. Rays without such a way are left out.
fn smears(frame: &Frame, bounds: &PixelBox) -> Vec<f64> {
    let (r, (x, y)) = (radius(bounds), middle(bounds));
    let scale = frame.camera.depth_scale;
    let mut smears = Vec::new();
    for turn in 0..24 {
        let (sin, cos) = (f64::from(turn) * std::f64::consts::TAU / 24.0).sin_cos();
        let along: Vec<Option<f64>> = ((RIM_RADII.0 * r) as usize..=(RIM_RADII.1 * r) as usize)
            .map(|step| {
                let (u, v) = (x + cos * step as f64, y + sin * step as f64);
                let inside = u >= 0.0 && v >= 0.0;
                let reading = inside
                    .then(|| frame.depth.get(u as usize, v as usize))
                    .flatten();
                reading.map(|reading| f64::from(reading) * scale)
            })
            .collect();
        for run in along.split(Option::is_none) {
            let depths: Vec<f64> = run.iter().flatten().copied().collect();
            let (Some(first), Some(last)) = (depths.first(), depths.last()) else {
                continue;
            };
            // The rim's own surface falls back by up to a radius; a way to the background is longer.
            if last - first < 0.03 {
                continue;
            }
            let between = depths.iter().filter(|&&z| {
                let way = (z - first) / (last - first);
                way > 0.1 && way < 0.9
            });
            smears.push(between.count() as f64);
        }
    }
    smears
}
