//! Apples in a colour image: ONNX detectors of the YOLO family, decoded, tiled and merged, or any other
//! network behind one trait.
//!
//! # Concepts
//!
//! - A [`Detector`] takes a colour image and gives [`Detection`]s: box, score and class, in the image's own
//!   pixels. Implement it for a camera that brings its own network.
//!
//! # Not here
//!
//! Depth, robots, and what an apple weighs. Box files are read and written by `pomona-cloud`.

mod detection;
mod error;
mod network;
mod options;
mod runtime;

pub use detection::{Detection, Detector, DetectorReport, RuntimeReport};
pub use error::DetectError;
pub use network::{Element, Network, Port, Tensor};
pub use options::{ClassChoice, DetectorOptions, RuntimeChoice, TilingChoice};
pub use runtime::{ModelSource, open_network};
