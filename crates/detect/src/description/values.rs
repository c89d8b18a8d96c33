//! Values of a detector's description that make no sense for any model: each function gives the fault of one key, if it
//! has one. What describes any network's image is checked by `pomona-network`.

use pomona_network::{LARGEST_INPUT_SIDE, Malformed, description::refuse};

pub(super) fn strides(strides: &[usize]) -> Option<Malformed> {
    let rising = strides.is_sorted_by(|a, b| a < b);
    let is_side = |pixels: &usize| (1..=LARGEST_INPUT_SIDE).contains(pixels);
    let bad = strides.is_empty() || !rising || !strides.iter().all(is_side);
    let remedy = "give pixels per cell, from the finest grid, such as [8, 16, 32]";
    refuse(bad, "strides", "not rising", remedy)
}

pub(super) fn anchors(anchors: &[[f32; 2]]) -> Option<Malformed> {
    let is_positive = |x: &f32| x.is_finite() && *x > 0.0;
    let bad = anchors.is_empty() || !anchors.iter().flatten().all(is_positive);
    let remedy = "give [width, height] in pixels of each anchor";
    refuse(bad, "anchors", "none, or one without area", remedy)
}
