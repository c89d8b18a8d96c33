use crate::{error::NetworkError, tiling_choice::TilingChoice};
use pomona_cloud::PixelWindow;

/// Largest reduction of a tile by default, in pixels of the image for each pixel of the network's input along a side.
/// An image that needs more is tiled. At 1.3, an apple keeps three quarters of its pixels along a side, and the tiles
/// are hardly more than half as many as at 1.
const LARGEST_REDUCTION: f64 = 1.3;

/// Pixels of the image that neighbouring tiles share by default: an apple's size in a colour image taken at arm's
/// length. What is smaller lies whole in one of the tiles.
const DEFAULT_OVERLAP_PX: usize = 80;

/// How images are tiled for a network.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct TilingOptions {
    /// Which windows are run.
    pub choice: TilingChoice,
    /// Longest side of a tile in pixels of the image; 1.3 times the input's longer side where absent.
    pub tile: Option<usize>,
    /// Pixels of the image that neighbouring tiles share, 80 by default.
    pub overlap: usize,
    /// Whether an image that is tiled automatically is also run as a whole, true by default.
    pub whole_pass: bool,
}

impl Default for TilingOptions {
    fn default() -> Self {
        Self {
            choice: TilingChoice::Automatic,
            tile: None,
            overlap: DEFAULT_OVERLAP_PX,
            whole_pass: true,
        }
    }
}

/// The tiling of images for a network's input.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tiling {
    options: TilingOptions,
    /// Longest width and height of a tile in pixels of the image.
    longest: [usize; 2],
    /// Width and height of the network's input.
    input: [usize; 2],
}

impl Tiling {
    /// For an input of `[width, height]` pixels.
    ///
    /// # Errors
    ///
    /// [`NetworkError::TileGrid`] for a grid without tiles, or with more columns or rows than
    /// [`TilingChoice::LARGEST_GRID`].
    pub fn new(options: &TilingOptions, input: [usize; 2]) -> Result<Self, NetworkError> {
        let sides = 1..=TilingChoice::LARGEST_GRID;
        if let TilingChoice::Grid { columns, rows } = options.choice
            && !(sides.contains(&columns) && sides.contains(&rows))
        {
            return Err(NetworkError::TileGrid { columns, rows });
        }
        let side = input[0].max(input[1]) as f64;
        let tile = options
            .tile
            .map_or(side * LARGEST_REDUCTION, |tile| tile as f64);
        let longest = input.map(|length| ((tile * length as f64 / side) as usize).max(1));
        Ok(Self {
            options: *options,
            longest,
            input,
        })
    }

    /// Pixels of the image that neighbouring tiles share at least.
    pub fn overlap(&self) -> usize {
        self.options.overlap
    }

    /// The windows of an image of `[width, height]` pixels; together they hold every pixel.
    ///
    /// They are the tiles row by row, and then, with [`TilingOptions::whole_pass`], the whole image, in which large
    /// close things are seen uncut; or the whole image alone.
    pub fn windows(&self, image: [usize; 2]) -> Vec<PixelWindow> {
        let whole = PixelWindow::full(image[0], image[1]);
        let (counts, overlaps, whole_pass) = match self.options.choice {
            TilingChoice::Whole => return vec![whole],
            TilingChoice::Grid { columns, rows } => {
                ([columns, rows], [self.options.overlap; 2], false)
            }
            TilingChoice::Automatic => {
                let overlaps = self
                    .longest
                    .map(|longest| self.options.overlap.min(longest / 2));
                let count = |k: usize| count(image[k], self.longest[k], overlaps[k]);
                ([count(0), count(1)], overlaps, self.options.whole_pass)
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

    fn options(choice: TilingChoice) -> TilingOptions {
        TilingOptions {
            choice,
            ..TilingOptions::default()
        }
    }

    fn tiling(choice: TilingChoice, input: [usize; 2]) -> Tiling {
        Tiling::new(&options(choice), input).unwrap()
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
            size in (1_usize..=DEFAULT_OVERLAP_PX, 1_usize..=DEFAULT_OVERLAP_PX),
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
        let native = TilingOptions {
            tile: Some(416),
            whole_pass: false,
            ..TilingOptions::default()
        };
        let native = Tiling::new(&native, [416, 416]).unwrap();
        assert_eq!(native.windows([1920, 1080]).len(), 6 * 3);
    }

    #[test]
    fn a_grid_has_tiles() {
        for (columns, rows) in [(0, 1), (1, 0), (0, 0), (65, 1), (1, usize::MAX)] {
            let choice = TilingChoice::Grid { columns, rows };
            let error = Tiling::new(&options(choice), [416, 416]).unwrap_err();
            assert!(error.to_string().starts_with("tiling = "), "{error}");
        }
    }
}
