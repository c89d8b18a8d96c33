//! Images with labels, in the forms in which data sets are published.
//!
//! Each kind of label is a field of [`LabelledImage`] and is read by files of its own; what a folder holds is
//! recognised in `read.rs` alone.

mod coco;
mod frames;
mod images;
pub(crate) mod listing;
mod pairs;
mod read;

pub use images::{LabelForm, LabelledDataset, LabelledImage};
