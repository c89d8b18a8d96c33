//! Draws scenes of a suite on one sheet: colour with the truth on it, depth beside it.
//!
//! `cargo run -p pomona-scenes --example contact_sheet SUITE OUT.png [SCENES] [TILE_WIDTH]`
//!
//! Boxes are blue, the nearest branch's tangent green, the picking direction red.

use pomona_cloud::{ColorImage, DepthImage, Frame};
use pomona_scenes::{AppleTruth, Case, Scene, Suite};
use pomona_statistics::inverse_cdf;
use std::error::Error;
use std::time::Instant;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [suite, out, rest @ ..] = arguments.as_slice() else {
        return Err("usage: contact_sheet SUITE OUT.png [SCENES] [TILE_WIDTH]".into());
    };
    let suite = Suite::named(suite)?;
    let count = rest.first().map_or(Ok(12), |n| n.parse())?;
    let tile_width: usize = rest.get(1).map_or(Ok(320), |n| n.parse())?;

    let cases: Vec<Case> = suite.cases().collect();
    let count = cases.len().min(count).max(1);
    let chosen = (0..count).map(|i| &cases[i * cases.len() / count]);
    let mut tiles = Vec::new();
    for case in chosen {
        let start = Instant::now();
        let scene = case.scene();
        let elapsed = start.elapsed();
        println!(
            "{:<28} {:>7.1} ms  {}",
            case.name,
            elapsed.as_secs_f64() * 1e3,
            summary(&scene)
        );
        tiles.push(tile(&scene, tile_width));
    }
    let columns = (1..=tiles.len())
        .find(|c| c * c * 2 >= tiles.len())
        .unwrap_or(1);
    sheet(&tiles, columns).write(out)?;
    Ok(())
}

fn summary(scene: &Scene) -> String {
    let apple = scene.truth.apples.iter().find(|a| a.target == Some(true));
    let Some(apple) = apple.or(scene.truth.apples.first()) else {
        return "no apple".into();
    };
    let branch = apple.branch.as_ref();
    format!(
        "{} apples; first r {:.1} mm at {:.2} m, visible {:.0} %, branch r {:.1} mm, {:.0} mm and {} px of it visible",
        scene.truth.apples.len(),
        apple.radius * 1e3,
        apple.center[2],
        100.0 * apple.visible_share.unwrap_or(f64::NAN),
        branch.map_or(f64::NAN, |b| b.radius * 1e3),
        1e3 * branch.and_then(|b| b.visible_length).unwrap_or(f64::NAN),
        branch.and_then(|b| b.visible_pixels).unwrap_or(0),
    )
}

/// Colour and depth side by side, each `width` wide.
fn tile(scene: &Scene, width: usize) -> ColorImage {
    let frame = &scene.frame;
    let mut color = frame.color.clone();
    for apple in &scene.truth.apples {
        annotate(&mut color, frame, apple);
    }
    let depth = colored_depth(&frame.depth, frame.camera.depth_scale);
    let factor = (color.width / width).max(1);
    let (left, right) = (shrunk(&color, factor), shrunk(&depth, factor));
    let rows = left
        .pixels
        .chunks(left.width)
        .zip(right.pixels.chunks(right.width));
    let pixels = rows.flat_map(|(a, b)| a.iter().chain(b).copied()).collect();
    ColorImage {
        width: 2 * left.width,
        height: left.height,
        pixels,
    }
}

fn annotate(image: &mut ColorImage, frame: &Frame, apple: &AppleTruth) {
    let b = &apple.bounds;
    let corners = [
        (b.x_min, b.y_min),
        (b.x_max, b.y_min),
        (b.x_max, b.y_max),
        (b.x_min, b.y_max),
    ];
    for i in 0..4 {
        stroke(image, corners[i], corners[(i + 1) % 4], [40, 90, 255]);
    }
    let project = |p: [f64; 3]| {
        let camera = &frame.camera;
        (
            p[0] / p[2] * camera.fx + camera.cx,
            p[1] / p[2] * camera.fy + camera.cy,
        )
    };
    let along = |p: [f64; 3], d: [f64; 3], t: f64| std::array::from_fn(|i| p[i] + d[i] * t);
    if let Some(branch) = &apple.branch {
        let [a, b] = [-0.05, 0.05].map(|t| project(along(branch.point, branch.direction, t)));
        stroke(image, a, b, [0, 220, 90]);
        stroke(
            image,
            project(apple.center),
            project(branch.point),
            [255, 30, 30],
        );
    }
}

fn stroke(image: &mut ColorImage, a: (f64, f64), b: (f64, f64), color: [u8; 3]) {
    let steps = (b.0 - a.0).abs().max((b.1 - a.1).abs()).ceil().max(1.0);
    for i in 0..=steps as usize {
        let t = i as f64 / steps;
        let (x, y) = (a.0 + (b.0 - a.0) * t, a.1 + (b.1 - a.1) * t);
        for (dx, dy) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)] {
            let (x, y) = (x + dx, y + dy);
            if x >= 0.0 && y >= 0.0 && x < image.width as f64 && y < image.height as f64 {
                let index = y as usize * image.width + x as usize;
                image.pixels[index] = color;
            }
        }
    }
}

/// Near is light, far dark, no reading blue; the scale runs over the middle 98 % of the readings.
fn colored_depth(depth: &DepthImage, scale: f64) -> ColorImage {
    let mut readings: Vec<u16> = depth.readings.iter().copied().filter(|&r| r > 0).collect();
    let mut quantile = |q: f64| inverse_cdf(&mut readings, q).unwrap_or(1);
    let (near, far) = (
        f64::from(quantile(0.01)) * scale,
        f64::from(quantile(0.99)) * scale,
    );
    let shade = |r: &u16| {
        let t = (f64::from(*r) * scale - near) / (far - near).max(1e-3);
        let v = (245.0 - 215.0 * t.clamp(0.0, 1.0)) as u8;
        if *r == 0 { [10, 10, 90] } else { [v, v, v] }
    };
    let pixels = depth.readings.iter().map(shade).collect();
    ColorImage {
        width: depth.width,
        height: depth.height,
        pixels,
    }
}

fn shrunk(image: &ColorImage, factor: usize) -> ColorImage {
    let (width, height) = (image.width / factor, image.height / factor);
    let mut pixels = Vec::with_capacity(width * height);
    for y in 0..height {
        for x in 0..width {
            let mut sum = [0usize; 3];
            for dy in 0..factor {
                for dx in 0..factor {
                    let p = image.pixels[(y * factor + dy) * image.width + x * factor + dx];
                    for (s, c) in sum.iter_mut().zip(p) {
                        *s += usize::from(c);
                    }
                }
            }
            pixels.push(sum.map(|s| (s / (factor * factor)) as u8));
        }
    }
    ColorImage {
        width,
        height,
        pixels,
    }
}

fn sheet(tiles: &[ColorImage], columns: usize) -> ColorImage {
    let (w, h) = tiles.first().map_or((1, 1), |t| (t.width, t.height));
    let rows = tiles.len().div_ceil(columns);
    let (width, height) = (columns * (w + 4), rows * (h + 4));
    let mut image = ColorImage {
        width,
        height,
        pixels: vec![[255; 3]; width * height],
    };
    for (i, tile) in tiles.iter().enumerate() {
        let (x, y) = ((i % columns) * (w + 4), (i / columns) * (h + 4));
        for (dy, row) in tile.pixels.chunks(tile.width).enumerate() {
            let start = (y + dy) * width + x;
            image.pixels[start..start + tile.width].copy_from_slice(row);
        }
    }
    image
}
