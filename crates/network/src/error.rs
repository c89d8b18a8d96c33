use crate::tiling_choice::TilingChoice;
use pomona_cloud::PixelWindow;
use pomona_files::Malformed;
use std::path::PathBuf;
use thiserror::Error;

/// Why a network could not be opened or run.
///
/// Every message names the file or the input, what is wrong with it, and what to do about it.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum NetworkError {
    /// The operating system refused to read a file.
    #[error("{}: cannot be read: {source}; check the path and its permissions", .path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A model, or the description beside it, cannot be used.
    #[error("{model}: {place}: {problem}; {remedy}")]
    Model {
        /// The model's or description's file, or the name of the built-in one.
        model: String,
        /// Where in it: an input, an output, a key.
        place: String,
        /// What is wrong there.
        problem: String,
        /// What to do about it.
        remedy: String,
    },
    /// The chosen inference backend cannot be used.
    #[error("{runtime}: {problem}; {remedy}")]
    Runtime {
        /// The library or backend.
        runtime: String,
        /// What is wrong with it.
        problem: String,
        /// What to do about it.
        remedy: String,
    },
    /// An image without pixels, or with fewer or more than its size says.
    #[error(
        "{width}x{height} image: {pixels} pixels; give at least one, and as many as the image's size says"
    )]
    Image {
        /// Width in pixels.
        width: usize,
        /// Height in pixels.
        height: usize,
        /// How many pixels there are.
        pixels: usize,
    },
    /// A window that is empty or reaches beyond the image.
    #[error(
        "{width}x{height} image: the window from ({}, {}) to ({}, {}) is empty or reaches beyond it; \
         give windows of at least one pixel inside the image",
        .window.x0, .window.y0, .window.x1, .window.y1
    )]
    Window {
        /// The image's width in pixels.
        width: usize,
        /// The image's height in pixels.
        height: usize,
        /// The window.
        window: PixelWindow,
    },
    /// A grid without tiles, or with too many.
    #[error(
        "tiling = {columns}x{rows}: not a grid of tiles; give 1 to {} columns and rows",
        TilingChoice::LARGEST_GRID
    )]
    TileGrid {
        /// Columns.
        columns: usize,
        /// Rows.
        rows: usize,
    },
}

impl NetworkError {
    /// The error for a fault in the model or description of this name.
    pub fn model(model: impl Into<String>, fault: Malformed) -> Self {
        let Malformed {
            place,
            problem,
            remedy,
            ..
        } = fault;
        Self::Model {
            model: model.into(),
            place,
            problem,
            remedy,
        }
    }
}
