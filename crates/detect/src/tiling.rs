use crate::{DetectError, ModelDescription, TilingChoice};
use pomona_cloud::PixelWindow;

/// How much of the image a network's input may hold, along a side, relative to one that is not scaled. Beyond it an
/// image is tiled, and up to it a tile may be scaled down: a quarter fewer pixels along a side still show an apple,
/// and nearly halve the number of tiles.
const LARGEST_REDUCTION: f64 = 1.3;

/// Pixels that neighbouring tiles share, unless told otherwise: an apple's size in a colour image of an arm's
/// reach. What is smaller lies whole in one of the tiles.
const OVERLAP: usize = 80;

/// Most columns or rows that a caller can ask for.
const LARGEST_GRID: usize = 64;

/// How images are cut for a network.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tiling {
    choice: TilingChoice,
    /// Longest width and height of a tile in pixels of the image.
    longest: [usize; 2],
    /// Width and height of the network's input.
    input: [usize; 2],
    overlap: usize,
    whole_pass: bool,
}

impl Tiling {
    /// For an input of `[width, height]` pixels.
    ///
    /// # Errors
    ///
    /// [`DetectError::Setting`] for a grid without tiles, or with too many.
    pub(crate) fn new(
        choice: TilingChoice,
        input: [usize; 2],
        description: &ModelDescription,
    ) -> Result<Self, DetectError> {
        let sides = 1..=LARGEST_GRID;
        if let TilingChoice::Grid { columns, rows } = choice
            && !(sides.contains(&columns) && sides.contains(&rows))
        {
            return Err(DetectError::Setting {
                setting: "tiling",
                value: format!("{columns}x{rows}"),
                problem: "not a grid of tiles".to_owned(),
                remedy: format!("give 1 to {LARGEST_GRID} columns and rows"),
            });
        }
        let side = input[0].max(input[1]) as f64;
        let tile = description
            .tile
            .map_or(side * LARGEST_REDUCTION, |tile| tile as f64);
        let longest = input.map(|length| ((tile * length as f64 / side) as usize).max(1));
        Ok(Self {
            choice,
            longest,
            input,
            overlap: description.tile_overlap.unwrap_or(OVERLAP),
            whole_pass: description.whole_pass.unwrap_or(true),
        })
    }

    /// Longer side in pixels of the image below which a box in the pass over the whole image says nothing: half of
    /// what the tiles share. One of the tiles shows what is so small whole, and larger.
    pub(crate) fn smallest_in_whole_pass(&self) -> f64 {
        self.overlap as f64 / 2.0
    }

    /// The windows of an image of `[width, height]` pixels to look at; together they hold every pixel.
    ///
    /// Several ones are the tiles row by row, and then, where wanted, the whole image, in which large close
    /// apples are seen uncut.
    pub(crate) fn windows(&self, image: [usize; 2]) -> Vec<PixelWindow> {
        let whole = PixelWindow::full(image[0], image[1]);
        let (counts, overlaps, whole_pass) = match self.choice {
            TilingChoice::Whole => return vec![whole],
            TilingChoice::Grid { columns, rows } => ([columns, rows], [self.overlap; 2], false),
            TilingChoice::Automatic => {
                let overlaps = self.longest.map(|longest| self.overlap.min(longest / 2));
                let count = |k: usize| count(image[k], self.longest[k], overlaps[k]);
                ([count(0), count(1)], overlaps, self.whole_pass)
            }
        };
        if counts == [1, 1] {
            return vec![whole];
        }
        let least = [0, 1].map(|k| least_length(image[k], counts[k], overlaps[k]));
        // What the input has room for costs nothing: up to the image's own resolution, and beyond it the shorter
        // side at the longer one's scale.
        let reduction = |k: usize| least[k] as f64 / self.input[k] as f64;
        let native = (self.longest[0] as f64 / self.input[0] as f64).min(1.0);
        let shrink = reduction(0).max(reduction(1)).max(native);
        let lengths = [0, 1].map(|k| {
            let room = (self.input[k] as f64 * shrink).round() as usize;
            least[k].max(room).min(image[k])
        });
        let start = |k: usize, i: usize| i * (image[k] - lengths[k]) / (counts[k] - 1).max(1);
        let mut windows = Vec::with_capacity(counts[0] * counts[1] + 1);
        for j in 0..counts[1] {
            for i in 0..counts[0] {
                let (x0, y0) = (start(0, i), start(1, j));
                let window = PixelWindow {
                    x0,
                    y0,
                    x1: x0 + lengths[0],
                    y1: y0 + lengths[1],
                };
                windows.push(window);
            }
        }
        // A grid finer than the image repeats itself.
        windows.dedup();
        if whole_pass {
            windows.push(whole);
        }
        windows
    }
}

/// Fewest tiles of at most `longest` pixels that cover `length` of them, neighbours sharing at least `overlap`, which
/// is below `longest` unless both are so small that one pixel more or less decides.
fn count(length: usize, longest: usize, overlap: usize) -> usize {
    if length <= longest {
        return 1;
    }
    (length - overlap).div_ceil((longest - overlap).max(1))
}

/// Shortest tile with which so many of them cover `length` pixels, neighbours sharing at least `overlap`.
fn least_length(length: usize, count: usize, overlap: usize) -> usize {
    (length + (count - 1) * overlap).div_ceil(count).min(length)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn tiling(choice: TilingChoice, input: [usize; 2]) -> Tiling {
        Tiling::new(choice, input, &ModelDescription::default()).unwrap()
    }

    fn holds(window: &PixelWindow, [x0, y0, x1, y1]: [usize; 4]) -> bool {
        window.x0 <= x0 && window.y0 <= y0 && window.x1 >= x1 && window.y1 >= y1
    }

    proptest! {
        #[test]
        fn every_pixel_is_seen_and_what_is_small_is_seen_whole(
            image in (1_usize..2500, 1_usize..2500),
            input in prop_oneof![Just([416, 416]), Just([640, 640]), Just([416, 256])],
            grid in prop::option::of((1_usize..7, 1_usize..7)),
            at in (0.0..1.0, 0.0..1.0),
            size in (1_usize..=OVERLAP, 1_usize..=OVERLAP),
        ) {
            let grid = grid.map(|(columns, rows)| TilingChoice::Grid { columns, rows });
            let tiling = tiling(grid.unwrap_or_default(), input);
            let image = [image.0, image.1];
            let mut windows = tiling.windows(image);
            for window in &windows {
                prop_assert!(window.x1 <= image[0] && window.y1 <= image[1] && !window.is_empty());
            }
            if grid.is_none() && windows.len() > 1 {
                prop_assert_eq!(windows.pop(), Some(PixelWindow::full(image[0], image[1])));
                for window in &windows {
                    prop_assert!(window.width() <= tiling.longest[0], "{window:?}");
                    prop_assert!(window.height() <= tiling.longest[1], "{window:?}");
                }
            }
            // A box of at most the overlap, anywhere: in some tile it is whole. So is each single pixel.
            let size = [size.0.min(image[0]), size.1.min(image[1])];
            let start = [at.0, at.1];
            let start = [0, 1].map(|k| (start[k] * (image[k] - size[k] + 1) as f64) as usize);
            let small = [start[0], start[1], start[0] + size[0], start[1] + size[1]];
            prop_assert!(windows.iter().any(|window| holds(window, small)), "{small:?} {windows:?}");
        }
    }

    #[test]
    fn the_shape_of_the_plan() {
        let automatic = tiling(TilingChoice::Automatic, [416, 416]);
        assert_eq!(automatic.windows([416, 416]).len(), 1);
        assert_eq!(automatic.windows([540, 300]).len(), 1);
        assert_eq!(automatic.windows([541, 300]).len(), 3);
        // Not scaled, where the tiles need not be longer than the input.
        let pair = automatic.windows([620, 400]);
        assert_eq!(
            (pair.len(), pair[0].width(), pair[0].height()),
            (3, 416, 400)
        );
        let full_hd = automatic.windows([1920, 1080]);
        assert_eq!(full_hd.len(), 4 * 3 + 1);
        assert_eq!(
            full_hd[0],
            PixelWindow {
                x0: 0,
                y0: 0,
                x1: 540,
                y1: 540
            }
        );
        assert_eq!(
            full_hd[11],
            PixelWindow {
                x0: 1380,
                y0: 540,
                x1: 1920,
                y1: 1080
            }
        );
        assert_eq!(
            tiling(TilingChoice::Whole, [416, 416])
                .windows([1920, 1080])
                .len(),
            1
        );
        let grid = TilingChoice::Grid {
            columns: 3,
            rows: 2,
        };
        assert_eq!(tiling(grid, [416, 416]).windows([1920, 1080]).len(), 6);
        let native = ModelDescription {
            tile: Some(416),
            whole_pass: Some(false),
            ..ModelDescription::default()
        };
        let native = Tiling::new(TilingChoice::Automatic, [416, 416], &native).unwrap();
        assert_eq!(native.windows([1920, 1080]).len(), 6 * 3);
    }

    #[test]
    fn a_grid_has_tiles() {
        for (columns, rows) in [(0, 1), (1, 0), (0, 0), (65, 1), (1, usize::MAX)] {
            let choice = TilingChoice::Grid { columns, rows };
            let error = Tiling::new(choice, [416, 416], &ModelDescription::default()).unwrap_err();
            assert!(error.to_string().starts_with("tiling = "), "{error}");
        }
    }
}
