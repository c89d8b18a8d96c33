/// Which windows of a large image are run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TilingChoice {
    /// By the sizes of image and input.
    #[default]
    Automatic,
    /// The whole image, scaled to the network's input.
    Whole,
    /// So many columns and rows of tiles.
    Grid {
        /// Columns.
        columns: usize,
        /// Rows.
        rows: usize,
    },
}

impl TilingChoice {
    /// Most columns or rows of a grid: more tiles would be smaller than any network's input on any image.
    pub const LARGEST_GRID: usize = 64;
}
