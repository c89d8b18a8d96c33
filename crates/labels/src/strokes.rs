//! Strokes: the centre lines of long thin things, drawn by eye, with the half width along them.

mod class;
mod image;
mod parse;
mod path;

pub use class::StrokeClass;
pub use image::ImageStrokes;
pub use parse::{parse_strokes, read_strokes};
pub use path::{PathSample, Stroke, StrokePoint};
