//! Probabilities of overlapping tiles, averaged so that no seam shows.

use crate::{classes::Classes, segmentation::Segmentation};
use pomona_cloud::PixelWindow;
use rayon::prelude::*;
use std::ops::Range;

/// Weight of a pixel at the very edge of a tile, where the network sees half of its surroundings.
const LEAST_WEIGHT: f32 = 0.01;

/// The probabilities that one tile gives its pixels: one plane of the window's size for each class.
pub(crate) struct Tile {
    pub(crate) window: PixelWindow,
    pub(crate) planes: Vec<Vec<f32>>,
}

impl Tile {
    /// Calls `visit` for each of its rows in an image of `[width, height]` pixels, with the row's pixels in the image and
    /// in the tile, and the weights along it.
    fn for_rows(
        &self,
        [width, height]: [usize; 2],
        overlap: usize,
        mut visit: impl FnMut(Range<usize>, Range<usize>, &[f32], f32),
    ) {
        let window = self.window;
        let across = ramp(window.x0, window.x1, width, overlap);
        let down = ramp(window.y0, window.y1, height, overlap);
        for (v, down) in (window.y0..window.y1).zip(down) {
            let here = v * width + window.x0..v * width + window.x1;
            let there = (v - window.y0) * window.width()..(v - window.y0 + 1) * window.width();
            visit(here, there, &across, down);
        }
    }
}

/// The weighted mean of the tiles at each pixel; unseen where none is.
///
/// A tile's weight rises linearly from its edges over `overlap` pixels, except at the image's own edges: what lies in
/// one tile only is that tile's, and where two overlap one fades into the other.
pub(crate) fn blend(
    [width, height]: [usize; 2],
    classes: Classes,
    tiles: &[Tile],
    overlap: usize,
) -> Segmentation {
    let size = [width, height];
    let mut weights = vec![0.0_f32; width * height];
    for tile in tiles {
        tile.for_rows(size, overlap, |here, _, across, down| {
            for (weight, across) in weights[here].iter_mut().zip(across) {
                *weight += across * down;
            }
        });
    }
    let plane = |class: usize| {
        let mut plane = vec![0.0_f32; width * height];
        for tile in tiles {
            tile.for_rows(size, overlap, |here, there, across, down| {
                let pixels = plane[here].iter_mut().zip(&tile.planes[class][there]);
                for ((sum, p), across) in pixels.zip(across) {
                    *sum += across * down * p;
                }
            });
        }
        // Of a pixel that no tile holds, 0/0 makes NaN: unseen.
        for (sum, weight) in plane.iter_mut().zip(&weights) {
            *sum /= weight;
        }
        plane
    };
    let planes = (0..classes.len()).into_par_iter().map(plane).collect();
    Segmentation::of_probabilities(size, classes, planes)
}

/// The weights along one side of a tile from `start` to `end` in an image of `size` pixels.
fn ramp(start: usize, end: usize, size: usize, overlap: usize) -> Vec<f32> {
    let rise =
        |pixels: usize| ((pixels as f32 + 0.5) / overlap.max(1) as f32).clamp(LEAST_WEIGHT, 1.0);
    (start..end)
        .map(|k| {
            let first = if start == 0 { 1.0 } else { rise(k - start) };
            let last = if end == size { 1.0 } else { rise(end - 1 - k) };
            first.min(last)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::classes::Role;

    fn tile(x0: usize, x1: usize, p: f32) -> Tile {
        let window = PixelWindow {
            x0,
            y0: 0,
            x1,
            y1: 1,
        };
        let count = x1 - x0;
        Tile {
            window,
            planes: vec![vec![1.0 - p; count], vec![p; count]],
        }
    }

    #[test]
    fn one_tile_fades_into_the_next() {
        let classes = Classes::by_names(["rest", "wood"]).unwrap();
        let tiles = vec![tile(0, 8, 0.0), tile(4, 12, 1.0)];
        let seen = blend([14, 1], classes, &tiles, 4);
        let wood = seen.role(Role::Wood);
        assert_eq!(&wood[..4], &[0.0; 4]);
        assert_eq!(&wood[8..12], &[1.0; 4]);
        assert!(wood[3..9].is_sorted(), "{wood:?}");
        assert!(
            (wood[5] + wood[6] - 1.0).abs() < 1e-6,
            "as much of one as of the other in the middle"
        );
        assert!(wood[12].is_nan() && wood[13].is_nan());
    }

    #[test]
    fn tiles_that_agree_are_not_changed() {
        let classes = Classes::by_names(["rest", "wood"]).unwrap();
        let tiles = vec![tile(0, 8, 0.25), tile(3, 9, 0.25), tile(5, 12, 0.25)];
        let seen = blend([12, 1], classes, &tiles, 4);
        assert!(
            seen.role(Role::Wood)
                .iter()
                .all(|p| (p - 0.25).abs() < 1e-6)
        );
    }
}
