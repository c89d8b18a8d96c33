use super::distance::squared_distances;
use crate::strokes::{PathSample, StrokePoint};

/// Points on the centre lines of the regions of a mask of `[width, height]` pixels, with half widths, in pixels.
///
/// The mask is thinned to lines one pixel wide. Each pixel of them stands for half of the way to each of its
/// neighbours on them, and for one pixel at least. What the border cuts goes on beyond it as in a mirror, so
/// that lines run up to the border. Half of the width is the distance from the middle of the region to its edge.
pub(crate) fn center_line(mask: &[bool], size: [usize; 2]) -> Vec<PathSample> {
    let [width, height] = size;
    let line = thinned(mask, size);
    let half_widths = HalfWidths::of(mask, size);
    let is_on = |u: usize, v: usize, [du, dv]: [i32; 2]| {
        let at = |x: usize, d: i32| x.checked_add_signed(d as isize);
        let (u, v) = (at(u, du), at(v, dv));
        u.zip(v)
            .is_some_and(|(u, v)| u < width && v < height && line[v * width + u])
    };
    let sample = |k: usize| {
        let (u, v) = (k % width, k / width);
        let mut length = 0.0;
        for [du, dv] in AROUND {
            if !is_on(u, v, [du, dv]) {
                continue;
            }
            if du == 0 || dv == 0 {
                length += 0.5;
            } else if !is_on(u, v, [du, 0]) && !is_on(u, v, [0, dv]) {
                // A corner is no short cut.
                length += 0.5 * std::f64::consts::SQRT_2;
            }
        }
        PathSample {
            point: StrokePoint {
                x: u as f64 + 0.5,
                y: v as f64 + 0.5,
                half_width: half_widths.at(u, v),
            },
            length: f64::max(length, 1.0),
        }
    };
    (0..line.len()).filter(|k| line[*k]).map(sample).collect()
}

/// The neighbours of a pixel, to the right and down, clockwise from the one above.
const AROUND: [[i32; 2]; 8] = [
    [0, -1],
    [1, -1],
    [1, 0],
    [1, 1],
    [0, 1],
    [-1, 1],
    [-1, 0],
    [-1, -1],
];

/// Numbers in [`AROUND`] of the neighbours above, right, below and left.
const UP: usize = 0;
const RIGHT: usize = 2;
const DOWN: usize = 4;
const LEFT: usize = 6;

/// Of which neighbours one at least has to be missing on each side, in the two passes in turns.
const OPEN_SIDES: [[[usize; 3]; 2]; 2] = [
    [[UP, RIGHT, DOWN], [RIGHT, DOWN, LEFT]],
    [[UP, RIGHT, LEFT], [UP, DOWN, LEFT]],
];

/// The lines that are left when pixels at the edges of the mask's regions are taken away, pass after pass, without
/// parting what hangs together.
///
/// Zhang and Suen 1984, "A Fast Parallel Algorithm for Thinning Digital Patterns", doi 10.1145/357994.358023. A
/// square of 2 × 2 pixels leaves nothing. Of the stairs that are left, the corners go.
fn thinned(mask: &[bool], [width, height]: [usize; 2]) -> Vec<bool> {
    let mut line = mask.to_vec();
    let mut left: Vec<usize> = (0..line.len()).filter(|k| line[*k]).collect();
    let mirrored = |x: usize, d: i32, size: usize| {
        let beyond = x as i64 + i64::from(d);
        let last = size as i64 - 1;
        let inside = if beyond > last {
            2 * last - beyond
        } else {
            beyond
        };
        (inside.unsigned_abs() as usize).min(size - 1)
    };
    let around = |line: &[bool], k: usize| {
        AROUND.map(|[du, dv]| {
            let u = mirrored(k % width, du, width);
            let v = mirrored(k / width, dv, height);
            line[v * width + u]
        })
    };
    let without_stairs = |mut line: Vec<bool>, left: Vec<usize>| {
        for k in left {
            line[k] = !is_stair(around(&line, k));
        }
        line
    };
    loop {
        let before = left.len();
        for sides in OPEN_SIDES {
            let gone: Vec<usize> = left
                .iter()
                .copied()
                .filter(|k| may_go(around(&line, *k), sides))
                .collect();
            for k in gone {
                line[k] = false;
            }
            left.retain(|k| line[*k]);
        }
        if left.len() == before {
            return without_stairs(line, left);
        }
    }
}

/// Whether a pixel with these neighbours is a corner that its neighbours pass without it.
fn is_stair(around: [bool; 8]) -> bool {
    let at = |k: usize| around[k % around.len()];
    let sides = [UP, RIGHT, DOWN, LEFT];
    let is_corner = sides.iter().any(|k| at(*k) && at(k + 2));
    let parts = sides
        .iter()
        .filter(|k| !at(**k) && (at(*k + 1) || at(*k + 2)))
        .count();
    is_corner && parts == 1
}

/// Whether a pixel with these neighbours is at an edge, and neither an end nor a link.
fn may_go(around: [bool; 8], open_sides: [[usize; 3]; 2]) -> bool {
    let neighbours = around.iter().filter(|on| **on).count();
    let runs = (0..around.len())
        .filter(|k| !around[*k] && around[(k + 1) % around.len()])
        .count();
    let is_open = |side: &[usize; 3]| side.iter().any(|number| !around[*number]);
    (2..=6).contains(&neighbours) && runs == 1 && open_sides.iter().all(is_open)
}

/// How far the middle of a region is from its edge.
///
/// On a grid twice as fine, since the middle of wood of an even width lies between two pixels.
struct HalfWidths {
    /// Squared distances from the squares of pixels beside the mask, in half pixels.
    squared: Vec<f64>,
    /// Columns and rows of the fine grid; those of even numbers are the pixels' centres.
    size: [usize; 2],
}

impl HalfWidths {
    fn of(mask: &[bool], [width, height]: [usize; 2]) -> Self {
        let size = [width, height].map(|side| (2 * side).saturating_sub(1));
        // Between two pixels lies what belongs to the squares of both.
        let pixels = |x: usize| x / 2..=x.div_ceil(2);
        let is_beside = |k: usize| {
            let (u, v) = (k % size[0], k / size[0]);
            pixels(v).any(|v| pixels(u).any(|u| !mask[v * width + u]))
        };
        Self {
            squared: squared_distances(size, is_beside),
            size,
        }
    }

    /// The half width at a pixel of the centre line; infinite where the mask has no edge.
    fn at(&self, u: usize, v: usize) -> f64 {
        let [width, height] = self.size;
        let near = |x: usize, size: usize| (2 * x).saturating_sub(1)..(2 * x + 2).min(size);
        let squared = near(v, height)
            .flat_map(|v| near(u, width).map(move |u| self.squared[v * width + u]))
            .fold(0.0, f64::max);
        squared.sqrt() / 2.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const SIZE: [usize; 2] = [80, 60];

    /// The pixels whose centres are within `half_width` of the straight line between two points.
    fn band([x0, y0]: [f64; 2], [x1, y1]: [f64; 2], half_width: f64) -> Vec<bool> {
        let (dx, dy) = (x1 - x0, y1 - y0);
        let is_in = |k: usize| {
            let (x, y) = ((k % SIZE[0]) as f64 + 0.5, (k / SIZE[0]) as f64 + 0.5);
            let along = ((x - x0) * dx + (y - y0) * dy) / (dx * dx + dy * dy);
            let t = along.clamp(0.0, 1.0);
            (x0 + t * dx - x).hypot(y0 + t * dy - y) <= half_width
        };
        (0..SIZE[0] * SIZE[1]).map(is_in).collect()
    }

    fn length(line: &[PathSample]) -> f64 {
        line.iter().map(|sample| sample.length).sum()
    }

    #[test]
    fn a_band_across_the_image_has_its_length_and_width() {
        for (rows, width) in [
            (30..31, 1.0),
            (30..32, 2.0),
            (30..33, 3.0),
            (30..34, 4.0),
            (20..37, 17.0),
        ] {
            let mut mask = vec![false; SIZE[0] * SIZE[1]];
            for v in rows.clone() {
                mask[v * SIZE[0]..(v + 1) * SIZE[0]].fill(true);
            }
            let line = center_line(&mask, SIZE);
            assert_eq!(length(&line), SIZE[0] as f64, "{rows:?}");
            for sample in &line {
                assert!(
                    (2.0 * sample.point.half_width - width).abs() < 1e-9,
                    "{sample:?}"
                );
                let middle = (rows.start + rows.end) as f64 / 2.0;
                assert!((sample.point.y - middle).abs() <= 0.5, "{sample:?}");
            }
        }
    }

    #[test]
    fn what_lies_along_the_border_stays() {
        for rows in [0..1, 0..2, 0..5, 59..60, 57..60] {
            let mut mask = vec![false; SIZE[0] * SIZE[1]];
            for v in rows.clone() {
                mask[v * SIZE[0]..(v + 1) * SIZE[0]].fill(true);
            }
            let line = center_line(&mask, SIZE);
            assert_eq!(length(&line), SIZE[0] as f64, "{rows:?}");
        }
    }

    #[test]
    fn nothing_has_no_line_and_everything_has_no_edge() {
        assert!(center_line(&[false; 12], [4, 3]).is_empty());
        for sample in center_line(&[true; 12], [4, 3]) {
            assert_eq!(sample.point.half_width, f64::INFINITY);
        }
        let dot = center_line(&[true], [1, 1]);
        assert_eq!((dot.len(), dot[0].length), (1, 1.0));
        assert!(center_line(&[], [0, 0]).is_empty());
    }

    proptest! {
        #[test]
        fn a_slanting_band_is_as_long_and_as_wide_as_it_was_drawn(
            y0 in 15.0..45.0, y1 in 15.0..45.0, half_width in 1.0..7.0,
        ) {
            let (start, end) = ([15.0, y0], [65.0, y1]);
            let line = center_line(&band(start, end, half_width), SIZE);
            let drawn = f64::hypot(50.0, y1 - y0);
            // Steps of 45° make a line longer by 8 % at most; round ends make it shorter.
            let found = length(&line);
            prop_assert!(found <= 1.09 * drawn + 2.0 * half_width + 2.0, "{} of {}", found, drawn);
            prop_assert!(found >= 0.97 * drawn - 2.0 * half_width, "{} of {}", found, drawn);
            let mut widths: Vec<f64> = line.iter().map(|s| s.point.half_width).collect();
            widths.sort_by(f64::total_cmp);
            let middle = widths[widths.len() / 2];
            prop_assert!((middle - half_width).abs() <= 0.6, "{} of {}", middle, half_width);
        }
    }
}
