//! Apples that the colour misses: spheres among the readings outside of the boxes.

use super::appearance::{Palette, Shade, same_size};
use super::candidate::{Candidate, SEED};
use super::depth_check::DepthChecker;
use super::grid_readings::GridReadings;
use super::mark::Mark;
use super::origin::FoundBy;
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
pub(super) fn search(
    frame: &Frame,
    checker: &DepthChecker<'_>,
    known: &[Candidate],
) -> Vec<Candidate> {
    let shade = shade(frame, known);
    let taken: Vec<Sphere> = known
        .iter()
        .filter(|c| !c.check.mark.refuses())
        .filter_map(|c| c.check.sphere)
        .collect();
    let mut found: Vec<Candidate> = places(checker)
        .into_par_iter()
        .enumerate()
        .map_init(GridReadings::default, |readings, (i, place)| {
            let mut rng = apple_rng(SEED, &frame.id, FIRST_DRAW + i);
            let mut check = checker.check(&place, &mut rng, readings);
            let mut bounds = place;
            for _ in 0..2 {
                bounds = outline(&check.sphere?, checker)?;
                check = checker.check(&bounds, &mut rng, readings);
            }
            let sphere = check.sphere.filter(|_| check.mark == Mark::Plausible)?;
            let free = taken.iter().all(|other| {
                (other.center - sphere.center).norm() > sphere.radius.max(other.radius)
            });
            let round = check.roundness.is_some_and(|r| r.least >= ROUND);
            let coverage = check.counts.coverage();
            if !(free && round && coverage >= checker.config.search_coverage) {
                return None;
            }
            bounds.score = coverage.min(1.0);
            let candidate = Candidate::new(bounds, FoundBy::Depth, check, checker, readings);
            let colored = |shade: Shade| {
                shade.share(&frame.color, candidate.surface.iter().copied()) >= COLORED
            };
            shade.is_none_or(colored).then_some(candidate)
        })
        .flatten()
        .collect();
    // Best first; the order of the places decides between equals.
    found.sort_by(|a, b| b.bounds.score.total_cmp(&a.bounds.score));
    let mut apart: Vec<Candidate> = Vec::new();
    for candidate in found {
        let Some(sphere) = candidate.check.sphere else {
            continue;
        };
        let distinct = apart
            .iter()
            .filter_map(|c| c.check.sphere)
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
fn shade(frame: &Frame, known: &[Candidate]) -> Option<Shade> {
    if !same_size(&frame.color, &frame.depth) {
        return None;
    }
    let mut palette = Palette::default();
    for candidate in known {
        if candidate.check.mark == Mark::Plausible && candidate.check.sphere.is_some() {
            palette.learn(&frame.color, candidate.surface.iter().copied());
        }
    }
    palette.learnt()
}

/// Boxes about the places where the depth image bulges, by the middle of an apple's size.
fn places(checker: &DepthChecker<'_>) -> Vec<PixelBox> {
    let (depth, config) = (checker.depth, checker.config);
    let radius = 0.5 * (checker.radii.least + checker.radii.most);
    let scale = checker.projection.camera.depth_scale;
    let reading = |u: f64, v: f64| -> Option<f64> {
        let inside = u >= 0.0 && v >= 0.0;
        let reading = inside.then(|| depth.get(u.round() as usize, v.round() as usize))??;
        Some(f64::from(reading) * scale)
    };
    // The grid is as fine as the farthest apples need; nearer ones use every so manieth place of it.
    let fine = (STEP * radius / checker.projection.pixel_m(config.range_max_m))
        .floor()
        .max(2.0);
    let mut places = Vec::new();
    for (row, v) in (0..depth.height).step_by(fine as usize).enumerate() {
        for (column, u) in (0..depth.width).step_by(fine as usize).enumerate() {
            let (u, v) = (u as f64, v as f64);
            let Some(z) = reading(u, v).filter(|&z| z <= config.range_max_m) else {
                continue;
            };
            let apple = radius / checker.projection.pixel_m(z);
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
fn outline(sphere: &Sphere, checker: &DepthChecker<'_>) -> Option<PixelBox> {
    let (u, v) = checker.projection.project(&sphere.center)?;
    let half = sphere.radius / checker.projection.pixel_m(sphere.center.z);
    let bounds = PixelBox {
        name: String::new(),
        x_min: u - half,
        y_min: v - half,
        x_max: u + half,
        y_max: v + half,
        score: 0.0,
    };
    let (width, height) = (checker.depth.width, checker.depth.height);
    bounds.validate(width, height).is_ok().then_some(bounds)
}
