//! Small places of a large image, side by side in few inputs of a network.

use crate::blend::Tile;
use pomona_cloud::{ColorImage, PixelWindow};
use rayon::prelude::*;
use std::cmp::Reverse;

/// Side in pixels of the cells in which places are counted.
const CELL: usize = 16;

/// Pixels around a piece that the network sees and whose answers are dropped: beyond them it sees another piece.
const CONTEXT: usize = 8;

/// Pixels around a piece over which neighbouring pieces fade into each other.
const FADE: usize = 8;

/// Pixels around a piece that lie in the input with it.
const MARGIN: usize = CONTEXT + FADE;

/// One piece of the image and where it lies.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Piece {
    /// What it is of the image, without its margin.
    window: PixelWindow,
    /// The number of its sheet.
    sheet: usize,
    /// Where its margin begins in that.
    at: [usize; 2],
}

/// Pieces of an image that together hold what is asked about, side by side on sheets of the input's size.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Collage {
    image: [usize; 2],
    input: [usize; 2],
    pieces: Vec<Piece>,
    sheets: usize,
}

impl Collage {
    /// The collage of the places of an image of `[width, height]` pixels for inputs of that size; `None` where the input
    /// has no room for a piece and its margin.
    pub(crate) fn new(
        image: [usize; 2],
        places: &[PixelWindow],
        input: [usize; 2],
    ) -> Option<Self> {
        let most = input.map(|side| side.saturating_sub(2 * MARGIN) / CELL);
        if most.contains(&0) {
            return None;
        }
        let mut windows = Cells::of(image, places).pieces(most);
        // High ones first, so that those beside each other are alike.
        windows.sort_by_key(|w| Reverse((w.height(), w.width())));
        let mut shelves: Vec<Shelf> = Vec::new();
        let mut sheets = Vec::new();
        let pieces = windows
            .into_iter()
            .map(|window| {
                let size = [window.width() + 2 * MARGIN, window.height() + 2 * MARGIN];
                let (sheet, at) = place(size, input, &mut shelves, &mut sheets);
                Piece { window, sheet, at }
            })
            .collect();
        Some(Self {
            image,
            input,
            pieces,
            sheets: sheets.len(),
        })
    }

    /// How many inputs it fills.
    pub(crate) fn sheets(&self) -> usize {
        self.sheets
    }

    /// The sheets, one below the other, of an image; `fill` is the grey between and around the pieces.
    pub(crate) fn image(&self, image: &ColorImage, fill: u8) -> ColorImage {
        let [width, height] = self.input;
        let mut sheets = ColorImage::filled(width, height * self.sheets, [fill; 3]);
        for piece in &self.pieces {
            let shown = grown(piece.window, MARGIN, self.image);
            // At the border of the image, part of the margin stays grey.
            let x = piece.at[0] + MARGIN - (piece.window.x0 - shown.x0);
            let y = piece.at[1] + MARGIN - (piece.window.y0 - shown.y0);
            for v in shown.y0..shown.y1 {
                let to = (piece.sheet * height + y + v - shown.y0) * width + x;
                let from = v * image.width + shown.x0;
                sheets.pixels[to..to + shown.width()]
                    .copy_from_slice(&image.pixels[from..from + shown.width()]);
            }
        }
        sheets
    }

    /// The windows of the sheets in [`Collage::image`].
    pub(crate) fn windows(&self) -> Vec<PixelWindow> {
        let [width, height] = self.input;
        let window = |sheet: usize| PixelWindow {
            x0: 0,
            y0: sheet * height,
            x1: width,
            y1: (sheet + 1) * height,
        };
        (0..self.sheets).map(window).collect()
    }

    /// The pieces as tiles of the image, cut out of the tiles of the sheets.
    pub(crate) fn tiles(&self, sheets: &[Tile]) -> Vec<Tile> {
        let cut = |piece: &Piece| {
            let window = grown(piece.window, FADE, self.image);
            let x = piece.at[0] + MARGIN - (piece.window.x0 - window.x0);
            let y = piece.at[1] + MARGIN - (piece.window.y0 - window.y0);
            let cut = |plane: &Vec<f32>| {
                let row = |v: usize| &plane[(y + v) * self.input[0] + x..][..window.width()];
                (0..window.height()).flat_map(row).copied().collect()
            };
            Tile {
                window,
                planes: sheets[piece.sheet].planes.iter().map(cut).collect(),
            }
        };
        self.pieces.par_iter().map(cut).collect()
    }

    /// Pixels over which its tiles fade.
    pub(crate) fn overlap() -> usize {
        2 * FADE
    }
}

/// The window with so many pixels more on each side, within the image.
fn grown(window: PixelWindow, by: usize, image: [usize; 2]) -> PixelWindow {
    PixelWindow {
        x0: window.x0.saturating_sub(by),
        y0: window.y0.saturating_sub(by),
        x1: (window.x1 + by).min(image[0]),
        y1: (window.y1 + by).min(image[1]),
    }
}

/// A row of pieces on a sheet.
struct Shelf {
    sheet: usize,
    /// Where it begins on the sheet.
    top: usize,
    height: usize,
    /// How much of its width is taken.
    taken: usize,
}

/// Where a piece of this size goes: on the first shelf with room for it, else on a new one on the first sheet with room
/// for that, else on a new sheet. `sheets` are the heights taken on each.
fn place(
    [width, height]: [usize; 2],
    input: [usize; 2],
    shelves: &mut Vec<Shelf>,
    sheets: &mut Vec<usize>,
) -> (usize, [usize; 2]) {
    let has_room = |shelf: &&mut Shelf| shelf.taken + width <= input[0] && height <= shelf.height;
    if let Some(shelf) = shelves.iter_mut().find(has_room) {
        let at = [shelf.taken, shelf.top];
        shelf.taken += width;
        return (shelf.sheet, at);
    }
    let sheet = sheets.iter().position(|taken| taken + height <= input[1]);
    let sheet = sheet.unwrap_or_else(|| {
        sheets.push(0);
        sheets.len() - 1
    });
    let top = sheets[sheet];
    sheets[sheet] += height;
    shelves.push(Shelf {
        sheet,
        top,
        height,
        taken: width,
    });
    (sheet, [0, top])
}

/// The cells of an image that are asked about and in no piece yet, row by row.
struct Cells {
    image: [usize; 2],
    columns: usize,
    rows: usize,
    left: Vec<bool>,
}

impl Cells {
    fn of(image: [usize; 2], places: &[PixelWindow]) -> Self {
        let [columns, rows] = image.map(|side| side.div_ceil(CELL));
        let mut left = vec![false; columns * rows];
        for place in places {
            for row in place.y0 / CELL..place.y1.div_ceil(CELL) {
                left[row * columns + place.x0 / CELL..row * columns + place.x1.div_ceil(CELL)]
                    .fill(true);
            }
        }
        Self {
            image,
            columns,
            rows,
            left,
        }
    }

    /// Rectangles of at most so many columns and rows of cells that together hold every cell.
    ///
    /// Each is the one with the most new cells for the pixels that it takes with its margin, among those that begin
    /// in the row of the first cell that is left, and hold this.
    fn pieces(mut self, most: [usize; 2]) -> Vec<PixelWindow> {
        let mut pieces = Vec::new();
        while let Some(first) = self.left.iter().position(|left| *left) {
            let best = self.best(first, most);
            pieces.push(self.window(best));
            for row in best.y0..best.y1 {
                self.left[row * self.columns + best.x0..row * self.columns + best.x1].fill(false);
            }
        }
        pieces
    }

    fn best(&self, first: usize, [most_columns, most_rows]: [usize; 2]) -> PixelWindow {
        let (column, row) = (first % self.columns, first / self.columns);
        let mut best = (0, 1, PixelWindow::full(0, 0));
        for x0 in column.saturating_sub(most_columns - 1)..=column {
            // New cells in the rows so far, from the column `x0` up to each.
            let end = (x0 + most_columns).min(self.columns);
            let mut counts = vec![0; end - x0];
            for y1 in row + 1..=(row + most_rows).min(self.rows) {
                let mut in_row = 0;
                let line = (y1 - 1) * self.columns;
                for (x, count) in (x0..end).zip(&mut counts) {
                    in_row += usize::from(self.left[line + x]);
                    *count += in_row;
                }
                for x1 in column + 1..=end {
                    let (new, old) = (counts[x1 - x0 - 1], best.0);
                    let pixels = |cells: usize| cells * CELL + 2 * MARGIN;
                    let cost = pixels(x1 - x0) * pixels(y1 - row);
                    if new * best.1 > old * cost {
                        let y0 = row;
                        best = (new, cost, PixelWindow { x0, y0, x1, y1 });
                    }
                }
            }
        }
        best.2
    }

    /// The pixels of a rectangle of cells.
    fn window(&self, cells: PixelWindow) -> PixelWindow {
        PixelWindow {
            x0: cells.x0 * CELL,
            y0: cells.y0 * CELL,
            x1: (cells.x1 * CELL).min(self.image[0]),
            y1: (cells.y1 * CELL).min(self.image[1]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn places() -> impl Strategy<Value = Vec<PixelWindow>> {
        let place = (0_usize..250, 0_usize..150, 1_usize..90, 1_usize..90);
        let window = |(x0, y0, width, height): (usize, usize, usize, usize)| PixelWindow {
            x0,
            y0,
            x1: (x0 + width).min(251),
            y1: (y0 + height).min(151),
        };
        proptest::collection::vec(place.prop_map(window), 0..12)
    }

    proptest! {
        #[test]
        fn every_place_is_in_a_piece_and_pieces_lie_apart(places in places(), width in 48_usize..130) {
            let (image, input) = ([251, 151], [width, 100]);
            let collage = Collage::new(image, &places, input).unwrap();
            let mut seen = vec![false; image[0] * image[1]];
            let mut taken = vec![false; input[0] * input[1] * collage.sheets()];
            for piece in &collage.pieces {
                for v in piece.window.y0..piece.window.y1 {
                    seen[v * image[0] + piece.window.x0..v * image[0] + piece.window.x1].fill(true);
                }
                let size = [piece.window.width() + 2 * MARGIN, piece.window.height() + 2 * MARGIN];
                for k in [0, 1] {
                    prop_assert!(piece.at[k] + size[k] <= input[k]);
                }
                for v in piece.at[1]..piece.at[1] + size[1] {
                    for u in piece.at[0]..piece.at[0] + size[0] {
                        let k = (piece.sheet * input[1] + v) * input[0] + u;
                        prop_assert!(!taken[k]);
                        taken[k] = true;
                    }
                }
            }
            for place in places {
                for v in place.y0..place.y1 {
                    prop_assert!(seen[v * image[0] + place.x0..v * image[0] + place.x1].iter().all(|s| *s));
                }
            }
        }
    }

    #[test]
    fn an_input_without_room_has_no_collage() {
        assert!(Collage::new([100, 100], &[], [2 * MARGIN + CELL - 1, 100]).is_none());
        let none = Collage::new([100, 100], &[], [2 * MARGIN + CELL, 100]).unwrap();
        assert_eq!((none.sheets(), none.windows().len()), (0, 0));
    }

    #[test]
    fn small_places_share_a_sheet() {
        let place = |x0: usize, y0: usize| PixelWindow {
            x0,
            y0,
            x1: x0 + 64,
            y1: y0 + 64,
        };
        let places = [
            place(0, 0),
            place(800, 16),
            place(1600, 800),
            place(400, 960),
        ];
        let collage = Collage::new([1920, 1080], &places, [416, 416]).unwrap();
        assert_eq!((collage.pieces.len(), collage.sheets()), (4, 1));
    }
}
