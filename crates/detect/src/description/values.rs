//! Values of a description that make no sense for any model: each function gives the fault of one key, if it has one.

use pomona_network::{LARGEST_INPUT_SIDE, Malformed};

/// Shortest side of a tile in pixels of the image: the coarsest grid of these networks has one cell in it.
const SMALLEST_TILE: usize = 32;

fn refuse(bad: bool, key: &str, problem: &str, remedy: &str) -> Option<Malformed> {
    bad.then(|| Malformed::new(format!("`{key}`"), problem, remedy))
}

pub(super) fn class_names(names: &[String]) -> Option<Malformed> {
    let twice = (1..names.len()).find(|&k| names[..k].contains(&names[k]));
    let problem = match twice {
        Some(k) => format!("`{}` is given twice", names[k]),
        None => "the list is empty".to_owned(),
    };
    let bad = names.is_empty() || twice.is_some();
    refuse(bad, "classes", &problem, "give each class its own name")
}

pub(super) fn input_size(size: [usize; 2]) -> Option<Malformed> {
    let bad = size.iter().any(|side| !is_side(*side));
    let remedy = format!("give width and height from 1 to {LARGEST_INPUT_SIDE} pixels");
    refuse(bad, "input_size", "not a size of an image", &remedy)
}

pub(super) fn strides(strides: &[usize]) -> Option<Malformed> {
    let rising = strides.is_sorted_by(|a, b| a < b);
    let bad = strides.is_empty() || !rising || strides.iter().any(|stride| !is_side(*stride));
    let remedy = "give pixels per cell, from the finest grid, such as [8, 16, 32]";
    refuse(bad, "strides", "not rising", remedy)
}

pub(super) fn anchors(anchors: &[[f32; 2]]) -> Option<Malformed> {
    let bad = anchors.is_empty() || !anchors.iter().flatten().all(|side| is_positive(*side));
    let remedy = "give [width, height] in pixels of each anchor";
    refuse(bad, "anchors", "none, or one without area", remedy)
}

pub(super) fn scale(scale: f32) -> Option<Malformed> {
    let remedy = "give 1, or 0.003921569 for 1/255";
    refuse(!is_positive(scale), "scale", "not above 0", remedy)
}

pub(super) fn mean(mean: [f32; 3]) -> Option<Malformed> {
    let bad = !mean.iter().all(|x| x.is_finite());
    refuse(bad, "mean", "not finite", "give three numbers")
}

pub(super) fn std(std: [f32; 3]) -> Option<Malformed> {
    let bad = !std.into_iter().all(is_positive);
    refuse(bad, "std", "not above 0", "give three numbers above 0")
}

pub(super) fn threshold(threshold: f64) -> Option<Malformed> {
    let remedy = "give a score from 0 to 1";
    refuse(!is_share(threshold), "threshold", "outside 0 to 1", remedy)
}

pub(super) fn nms_iou(iou: f64) -> Option<Malformed> {
    let remedy = "give an IoU from 0 to 1";
    refuse(!is_share(iou), "nms_iou", "outside 0 to 1", remedy)
}

pub(super) fn tile(tile: usize) -> Option<Malformed> {
    let problem = format!("below {SMALLEST_TILE} pixels");
    let remedy = "give the longest side of a tile in pixels";
    refuse(tile < SMALLEST_TILE, "tile", &problem, remedy)
}

pub(super) fn tile_overlap(tile: usize, overlap: usize) -> Option<Malformed> {
    let remedy = "give at most half of `tile`";
    let problem = "more than half a tile";
    refuse(overlap > tile / 2, "tile_overlap", problem, remedy)
}

fn is_side(pixels: usize) -> bool {
    (1..=LARGEST_INPUT_SIDE).contains(&pixels)
}

fn is_positive(x: f32) -> bool {
    x.is_finite() && x > 0.0
}

fn is_share(x: f64) -> bool {
    (0.0..=1.0).contains(&x)
}
