//! Apples that the colour misses: spheres among the readings outside of the boxes.

use super::appearance::{Palette, Shade, same_size};
use super::candidate::{Candidate, SEED};
use super::look::Looker;
use super::mark::Mark;
use super::record::FoundBy;
use super::samples::Samples;
use crate::seed::apple_rng;
use pomona_cloud::{Frame, PixelBox};
use pomona_geometry::Sphere;
use rayon::prelude::*;

/// Way between the places that are tried, as a share of a middling apple's radius.
const STEP: f64 = 0.6;

/// Half the side of the box that is tried first, in radii of a middling apple.
const REACH: f64 = 1.1;

/// Of eight readings around a place, those that must lie behind it for a surface to bulge.
const BULGE: usize = 6;

/// Least curvature in every direction of what is taken for an apple without anybody having seen one there.
const ROUND: f64 = 0.6;

/// Least share of its pixels that must have the colour of the frame's other apples, where that is known.
const COLORED: f64 = 0.4;

/// Draws of the search are numbered from here on, apart from those of the boxes.
const FIRST_DRAW: usize = 1 << 32;

/// Looks for apples outside of the boxes of `known`.
///
/// Places on a grid, as wide apart as apples are at the depth that is read there, are tried where the surface bulges
/// towards the camera: a box about each is judged as a detector's is, moved onto the outline of the sphere that it shows, and
/// judged again. What stays must be round in every direction, fill its outline, and have the
/// colour of the frame's own apples. Connected pieces of the depth image would be fewer places to try, but
/// fruit hangs among leaves that touch it.
pub(super) fn search(frame: &Frame, looker: &Looker<'_>, known: &[Candidate]) -> Vec<Candidate> {
    let shade = shade(frame, looker, known);
    let taken: Vec<Sphere> = known
        .iter()
        .filter(|c| !c.look.mark.refuses())
        .filter_map(|c| c.look.sphere)
        .collect();
    let mut found: Vec<Candidate> = places(looker)
        .into_par_iter()
        .enumerate()
        .map_init(Samples::default, |samples, (i, place)| {
            let mut rng = apple_rng(SEED, &frame.id, FIRST_DRAW + i);
            let mut look = looker.look(&place, &mut rng, samples);
            let mut bounds = place;
            for _ in 0..2 {
                bounds = outline(&look.sphere?, looker)?;
                look = looker.look(&bounds, &mut rng, samples);
            }
            let sphere = look.sphere.filter(|_| look.mark == Mark::Plausible)?;
            let free = taken.iter().all(|other| {
                (other.center - sphere.center).norm() > sphere.radius.max(other.radius)
            });
            let round = look.roundness.is_some_and(|r| r.least >= ROUND);
            let coverage = look.tally.coverage();
            if !(free && round && coverage >= looker.config.search_coverage) {
                return None;
            }
            let colored = shade.is_none_or(|shade| {
                shade.share(&frame.color, surface(samples, &sphere, looker)) >= COLORED
            });
            bounds.score = coverage.min(1.0);
            colored.then(|| Candidate::new(bounds, FoundBy::Depth, look))
        })
        .flatten()
        .collect();
    // Best first; the order of the places decides between equals.
    found.sort_by(|a, b| b.bounds.score.total_cmp(&a.bounds.score));
    let mut apart: Vec<Candidate> = Vec::new();
    for candidate in found {
        let Some(sphere) = candidate.look.sphere else {
            continue;
        };
        let distinct = apart
            .iter()
            .filter_map(|c| c.look.sphere)
            .all(|other| (other.center - sphere.center).norm() > sphere.radius.max(other.radius));
        if distinct {
            apart.push(candidate);
        }
    }
    for (i, candidate) in apart.iter_mut().enumerate() {
        candidate.bounds.name = format!("d{i}");
    }
    apart
}

/// The colour of the plausible ones of `known`; `None` where they are too few to tell.
fn shade(frame: &Frame, looker: &Looker<'_>, known: &[Candidate]) -> Option<Shade> {
    if !same_size(&frame.color, &frame.depth) {
        return None;
    }
    let mut palette = Palette::default();
    let mut samples = Samples::default();
    for (i, candidate) in known.iter().enumerate() {
        let Some(sphere) = candidate.look.sphere else {
            continue;
        };
        if candidate.look.mark == Mark::Plausible {
            let mut rng = apple_rng(SEED, &frame.id, i);
            looker.look(&candidate.bounds, &mut rng, &mut samples);
            palette.learn(&frame.color, surface(&samples, &sphere, looker));
        }
    }
    palette.learnt()
}

/// Pixels of the samples that show the sphere.
fn surface<'s>(
    samples: &'s Samples,
    sphere: &'s Sphere,
    looker: &Looker<'_>,
) -> impl Iterator<Item = u32> + 's {
    let threshold = looker.threshold(sphere.center.z);
    (0..samples.len())
        .filter(move |&i| sphere.signed_distance(&samples.point(i)).abs() <= threshold)
        .map(|i| samples.pixel[i])
}

/// Boxes about the places where the depth image bulges, by the middle of an apple's size.
fn places(looker: &Looker<'_>) -> Vec<PixelBox> {
    let (depth, config) = (looker.depth, looker.config);
    let radius = 0.5 * (looker.radii.least + looker.radii.most);
    let scale = looker.projection.camera.depth_scale;
    let reading = |u: f64, v: f64| -> Option<f64> {
        let inside = u >= 0.0 && v >= 0.0;
        let reading = inside.then(|| depth.get(u.round() as usize, v.round() as usize))??;
        Some(f64::from(reading) * scale)
    };
    // The grid is as fine as the farthest apples need; nearer ones use every so manieth place of it.
    let fine = (STEP * radius / looker.projection.pixel_m(config.range_max_m))
        .floor()
        .max(2.0);
    let mut places = Vec::new();
    for (row, v) in (0..depth.height).step_by(fine as usize).enumerate() {
        for (column, u) in (0..depth.width).step_by(fine as usize).enumerate() {
            let (u, v) = (u as f64, v as f64);
            let Some(z) = reading(u, v).filter(|&z| z <= config.range_max_m) else {
                continue;
            };
            let apple = radius / looker.projection.pixel_m(z);
            let every = ((STEP * apple / fine) as usize).max(1);
            if row % every != 0 || column % every != 0 {
                continue;
            }
            let behind = (0..8).filter(|&k| {
                let (sin, cos) = (f64::from(k) * std::f64::consts::FRAC_PI_4).sin_cos();
                let ring = reading(u + 0.8 * apple * cos, v + 0.8 * apple * sin);
                ring.is_none_or(|ring| ring > z + 0.02 * radius)
            });
            if behind.count() < BULGE {
                continue;
            }
            let half = REACH * apple;
            places.push(PixelBox {
                name: String::new(),
                x_min: u - half,
                y_min: v - half,
                x_max: u + half,
                y_max: v + half,
                score: 0.0,
            });
        }
    }
    places
}

/// The box about the outline of a sphere; `None` where it lies outside of the image or about the camera.
fn outline(sphere: &Sphere, looker: &Looker<'_>) -> Option<PixelBox> {
    let (u, v) = looker.projection.project(&sphere.center)?;
    let half = sphere.radius / looker.projection.pixel_m(sphere.center.z);
    let bounds = PixelBox {
        name: String::new(),
        x_min: u - half,
        y_min: v - half,
        x_max: u + half,
        y_max: v + half,
        score: 0.0,
    };
    let (width, height) = (looker.depth.width, looker.depth.height);
    bounds.validate(width, height).is_ok().then_some(bounds)
}
