//! Apples in a colour image: ONNX detectors of the YOLO family, run over tiles, decoded and fused, or any other
//! detector behind one trait.
//!
//! A custom detector, here one that takes anything red for an apple:
//!
//! ```
//! use pomona_cloud::ColorImage;
//! use pomona_detect::{DetectError, Detection, Detector, DetectorReport};
//!
//! struct Redness;
//!
//! impl Detector for Redness {
//!     fn detect(&self, image: &ColorImage) -> Result<Vec<Detection>, DetectError> {
//!         let red = |[r, g, b]: [u8; 3]| r > 150 && g < 80 && b < 80;
//!         let pixels = image.pixels.iter().enumerate().filter(|(_, pixel)| red(**pixel));
//!         let places = pixels.map(|(k, _)| (k % image.width, k / image.width));
//!         // The box that encloses all of them.
//!         let around = places.map(|(u, v)| [u, v, u + 1, v + 1]).reduce(|a, b| {
//!             [a[0].min(b[0]), a[1].min(b[1]), a[2].max(b[2]), a[3].max(b[3])]
//!         });
//!         let detection = |edges: [usize; 4]| {
//!             let [x_min, y_min, x_max, y_max] = edges.map(|edge| edge as f64);
//!             Detection { x_min, y_min, x_max, y_max, score: 1.0, class: 0 }
//!         };
//!         Ok(around.map(detection).into_iter().collect())
//!     }
//!
//!     fn report(&self) -> DetectorReport {
//!         DetectorReport::new("redness")
//!     }
//! }
//!
//! let mut image = ColorImage::filled(8, 6, [40, 120, 40]);
//! image.pixels[2 * 8 + 3] = [200, 30, 30];
//! image.pixels[3 * 8 + 4] = [190, 20, 40];
//! let seen = Redness.detect(&image)?;
//! assert_eq!([seen[0].x_min, seen[0].y_min, seen[0].x_max, seen[0].y_max], [3.0, 2.0, 5.0, 4.0]);
//! # Ok::<(), DetectError>(())
//! ```
//!
//! # Concepts
//!
//! - A [`Detector`] returns [`Detection`]s for a colour image: box, score and class, in pixels of the image.
//!   Implement it for a camera with a network of its own, for example.
//! - [`DetectorOptions`] open one from an ONNX file, or the built-in one. That is an [`OnnxDetector`]: a
//!   network that `pomona-network` loads and runs over the tiles of the image, and the meaning of its outputs.
//! - The meaning is recognised from the network's inputs and outputs; a [`ModelDescription`], a small TOML beside
//!   the model, states what they do not tell, and takes precedence.
//! - [`fuse`] combines the boxes of all tiles into one set; [`suppress`] is non-maximum suppression.
//!
//! | [`Family`] | outputs | meaning |
//! |---|---|---|
//! | `yolov3` | 2 or 3 of `[1, A·(5+C), h, w]`, other orders of axes too | logits, with anchors |
//! | `yolov3-nms` | `[1, N, 4]`, `[1, C, N]`, `[M, 3]`; the ONNX zoo's | corners, scores, rows kept by built-in suppression |
//! | `yolov5`, also v4 and v7 | `[1, N, 5+C]` | centre and size; objectness; classes |
//! | `yolov8`, also v9 and v11 | `[1, 4+C, N]` | centre and size; classes |
//! | `yolox` | `[1, N, 5+C]` | the same as v5 relative to the cells |
//!
//! Networks are untrusted: outputs with another shape are errors that name them, and boxes with non-finite numbers
//! are dropped.
//!
//! # Not here
//!
//! Depth and robots; training; tracking from image to image; networks that give masks, key points or rotated boxes.
//! Networks are loaded and run by `pomona-network`, box files are read and written by `pomona-cloud`.
//!
//! # Features
//!
//! The inference backends of `pomona-network`: `onnxruntime` loads ONNX Runtime at run time, if a library of it is
//! there; `embedded` builds one in pure Rust in. Both are on by default.
//!
//! # References
//!
//! - Redmon and Farhadi, `YOLOv3`: An Incremental Improvement, arXiv 1804.02767.
//! - Ge et al., YOLOX: Exceeding YOLO Series in 2021, arXiv 2107.08430.
//! - Solovyev, Wang and Gabruseva, Weighted boxes fusion, Image and Vision Computing 107, 2021,
//!   doi 10.1016/j.imavis.2021.104117.

mod built_in;
mod classes;
mod decode;
mod description;
mod detection;
mod error;
mod family;
mod fuse;
mod metadata;
mod onnx_detector;
mod open;
mod options;
mod suppress;

pub use description::ModelDescription;
pub use detection::{Detection, Detector, DetectorReport};
pub use error::DetectError;
pub use family::{Coordinates, Family};
pub use fuse::{View, fuse};
pub use onnx_detector::OnnxDetector;
pub use options::DetectorOptions;
pub use suppress::{Scope, suppress};

// The types of `pomona-cloud` that name a class.
pub use pomona_cloud::ClassChoice;

// Those types of `pomona-network` that the types above are made with.
pub use pomona_network::{Network, NetworkError, RuntimeChoice, RuntimeReport, TilingChoice};
