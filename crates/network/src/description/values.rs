//! Values of a description that make no sense for any model: each function gives the fault of one key, if it has one.

use crate::image_input::LARGEST_INPUT_SIDE;
use pomona_files::Malformed;

/// Smallest side of a tile in pixels: smaller ones would be run by the thousand.
const SMALLEST_TILE: usize = 32;

/// The fault of `key`, where `bad`.
pub fn refuse(bad: bool, key: &str, problem: &str, remedy: &str) -> Option<Malformed> {
    bad.then(|| Malformed::new(format!("`{key}`"), problem, remedy))
}

/// `classes`: some, and each with a name of its own.
pub fn class_names(names: &[String]) -> Option<Malformed> {
    let twice = (1..names.len()).find(|&k| names[..k].contains(&names[k]));
    let problem = match twice {
        Some(k) => format!("`{}` is given twice", names[k]),
        None => "the list is empty".to_owned(),
    };
    let bad = names.is_empty() || twice.is_some();
    refuse(bad, "classes", &problem, "give each class its own name")
}

/// `input_size`: from 1 to [`LARGEST_INPUT_SIDE`] pixels.
pub fn input_size(size: [usize; 2]) -> Option<Malformed> {
    let bad = size
        .iter()
        .any(|side| !(1..=LARGEST_INPUT_SIDE).contains(side));
    let remedy = format!("give width and height from 1 to {LARGEST_INPUT_SIDE} pixels");
    refuse(bad, "input_size", "not a size of an image", &remedy)
}

/// `scale`: above 0.
pub fn scale(scale: f32) -> Option<Malformed> {
    let remedy = "give 1, or 0.003921569 for 1/255";
    refuse(!is_positive(scale), "scale", "not above 0", remedy)
}

/// `mean`: finite.
pub fn mean(mean: [f32; 3]) -> Option<Malformed> {
    let bad = !mean.iter().all(|x| x.is_finite());
    refuse(bad, "mean", "not finite", "give three numbers")
}

/// `std`: above 0.
pub fn std(std: [f32; 3]) -> Option<Malformed> {
    let bad = !std.into_iter().all(is_positive);
    refuse(bad, "std", "not above 0", "give three numbers above 0")
}

/// `tile`: not so small that the tiles would be countless.
pub fn tile(tile: usize) -> Option<Malformed> {
    let problem = format!("below {SMALLEST_TILE} pixels");
    let remedy = "give the longest side of a tile in pixels";
    refuse(tile < SMALLEST_TILE, "tile", &problem, remedy)
}

/// `tile_overlap`: at most half a tile.
pub fn tile_overlap(tile: usize, overlap: usize) -> Option<Malformed> {
    let remedy = "give at most half of `tile`";
    let problem = "more than half a tile";
    refuse(overlap > tile / 2, "tile_overlap", problem, remedy)
}

/// The share `key`: from 0 to 1.
pub fn not_a_share(share: f64, key: &str, what: &str) -> Option<Malformed> {
    let bad = !(0.0..=1.0).contains(&share);
    refuse(
        bad,
        key,
        "outside 0 to 1",
        &format!("give {what} from 0 to 1"),
    )
}

fn is_positive(x: f32) -> bool {
    x.is_finite() && x > 0.0
}
