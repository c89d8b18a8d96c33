//! The wood that shows, as the strokes that a person would draw along it.

use crate::raycast::Raycast;
use crate::scene::VisibleWood;
use crate::world::{Bark, Shape, World};
use nalgebra::Point3;
use pomona_cloud::Camera;
use std::ops::Range;

/// Shortest stretch that a person would draw, pixels.
const LEAST_LENGTH_PX: f64 = 6.0;

/// Least half width of wood that a person would draw, pixels.
const LEAST_HALF_WIDTH_PX: f64 = 1.0;

/// Places along a piece and across it at which it is looked at.
const LOOKS: [f64; 3] = [-0.6, 0.0, 0.6];

/// The stretches of limbs of wood that show, in order of the world's limbs.
pub(crate) fn visible_wood(world: &World, camera: &Camera, cast: &Raycast) -> Vec<VisibleWood> {
    let mut seen = Vec::new();
    for limb in limbs(world) {
        let mut stretch: Vec<[f64; 3]> = Vec::new();
        let mut depths = Vec::new();
        for index in limb.clone() {
            let Shape::Limb(piece, _) = &world.parts[index].shape else {
                continue;
            };
            let image = |point: &Point3<f64>, radius: f64| {
                let (u, v) = camera.project(point)?;
                Some([u + 0.5, v + 0.5, camera.fx * radius / point.z])
            };
            let ends = (
                image(&piece.start, piece.start_radius),
                image(&piece.end, piece.end_radius),
            );
            let (Some(start), Some(end)) = ends else {
                finish(&mut stretch, &mut depths, &mut seen);
                continue;
            };
            if start[2] < LEAST_HALF_WIDTH_PX || !shows(cast, &limb, start, end) {
                finish(&mut stretch, &mut depths, &mut seen);
                continue;
            }
            if stretch.is_empty() {
                stretch.push(start);
            }
            stretch.push(end);
            depths.push(f64::midpoint(piece.start.z, piece.end.z));
        }
        finish(&mut stretch, &mut depths, &mut seen);
    }
    seen
}

/// The parts of each limb of wood: pieces that go on from one another.
fn limbs(world: &World) -> Vec<Range<usize>> {
    let mut limbs: Vec<Range<usize>> = Vec::new();
    let mut tip = None;
    for (index, part) in world.parts.iter().enumerate() {
        let Shape::Limb(piece, Bark::Wood) = &part.shape else {
            tip = None;
            continue;
        };
        match limbs.last_mut() {
            Some(limb) if tip == Some(piece.start) => limb.end = index + 1,
            _ => limbs.push(index..index + 1),
        }
        tip = Some(piece.end);
    }
    limbs
}

/// Whether at least half of the places looked at on a piece show its limb.
fn shows(cast: &Raycast, limb: &Range<usize>, start: [f64; 3], end: [f64; 3]) -> bool {
    let (dx, dy) = (end[0] - start[0], end[1] - start[1]);
    let length = dx.hypot(dy).max(1e-9);
    let (mut seen, mut all) = (0, 0);
    for along in LOOKS {
        let t = 0.5 + 0.5 * along;
        let mix = |i: usize| start[i] + t * (end[i] - start[i]);
        for across in LOOKS {
            let off = across * mix(2);
            let (x, y) = (mix(0) - off * dy / length, mix(1) + off * dx / length);
            all += 1;
            if x < 0.0 || y < 0.0 || x >= cast.width as f64 || y >= cast.height as f64 {
                continue;
            }
            let part = cast.part[y as usize * cast.width + x as usize] as usize;
            seen += usize::from(limb.contains(&part));
        }
    }
    2 * seen >= all
}

fn finish(stretch: &mut Vec<[f64; 3]>, depths: &mut Vec<f64>, seen: &mut Vec<VisibleWood>) {
    let points = std::mem::take(stretch);
    let depths = std::mem::take(depths);
    let length: f64 = points
        .windows(2)
        .map(|pair| (pair[1][0] - pair[0][0]).hypot(pair[1][1] - pair[0][1]))
        .sum();
    if length >= LEAST_LENGTH_PX {
        seen.push(VisibleWood {
            points,
            depth_m: depths.iter().sum::<f64>() / depths.len() as f64,
        });
    }
}
