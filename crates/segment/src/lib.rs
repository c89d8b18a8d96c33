//! Wood, fruit and posts in a colour image, pixel by pixel: ONNX networks run over tiles without seams, or any other
//! segmenter behind one trait.
//!
//! A custom segmenter, here one that takes anything brown for wood:
//!
//! ```
//! use pomona_cloud::{ColorImage, PixelWindow};
//! use pomona_segment::{Classes, Role, SegmentError, Segmentation, Segmenter, SegmenterReport};
//!
//! struct Brownness(Classes);
//!
//! impl Segmenter for Brownness {
//!     fn classes(&self) -> &Classes {
//!         &self.0
//!     }
//!
//!     fn segment_windows(
//!         &self,
//!         image: &ColorImage,
//!         windows: &[PixelWindow],
//!     ) -> Result<Segmentation, SegmentError> {
//!         let brown = |[r, g, b]: [u8; 3]| f32::from(u8::from(r > g && g > b));
//!         let wood: Vec<f32> = image.pixels.iter().map(|pixel| brown(*pixel)).collect();
//!         let rest = wood.iter().map(|p| 1.0 - p).collect();
//!         let size = [image.width, image.height];
//!         Ok(Segmentation::new(size, self.0.clone(), vec![rest, wood])?.within(windows))
//!     }
//!
//!     fn report(&self) -> SegmenterReport {
//!         SegmenterReport::new("brownness")
//!     }
//! }
//!
//! let mut image = ColorImage::filled(8, 6, [40, 120, 40]);
//! image.pixels[2 * 8 + 3] = [120, 90, 60];
//! let classes = Classes::by_names(["rest", "wood"])?;
//! let seen = Brownness(classes).segment(&image)?;
//! assert_eq!(seen.probability(Role::Wood, 3, 2), Some(1.0));
//! assert_eq!(seen.probability(Role::Wood, 4, 2), Some(0.0));
//! # Ok::<(), SegmentError>(())
//! ```
//!
//! # Concepts
//!
//! - A [`Segmenter`] gives each pixel of a colour image the probability of each of its [`Classes`]: a
//!   [`Segmentation`]. It may be asked about some windows only; the other pixels stay unseen.
//! - A segmenter has classes of its own, and each plays a [`Role`]: wood, peduncle, fruit, post, or the rest. Roles are
//!   recognised from the classes' names, or stated in the description beside the model; several classes may share one.
//! - [`SegmenterOptions`] open one from an ONNX file, or the built-in one. That is an [`OnnxSegmenter`]: a network that
//!   `pomona-network` loads and runs over tiles of the image. Where tiles overlap, their probabilities are averaged
//!   with weights that fall to the tiles' edges, so that no seam shows. Small places of a large image are put beside
//!   each other in few inputs by [`Segmenter::segment_places`].
//! - [`SegmenterOptions::zooms`] are the scales at which an image is looked at; the result is the mean of all of them.
//!   [`CloseUps`] look closer at some places only.
//! - The output is one tensor `[1, C, h, w]`, of logits or of probabilities; with a single channel it is one class
//!   against the rest. Where h and w are not the input's, it is interpolated.
//! - [`SegmentDescription`], a small TOML beside the model, states what the model does not tell.
//!
//! Networks are untrusted: outputs of another shape, and numbers that are not finite, are errors that name them.
//!
//! # Not here
//!
//! Boxes (`pomona-detect`), depth and robots; training (the recipe of the built-in model is in `training/`); instances:
//! two branches that cross are one region of wood.
//!
//! # Features
//!
//! The inference backends of `pomona-network`: `onnxruntime` loads ONNX Runtime at run time, if its library is
//! found; `embedded` builds one in pure Rust in. Both are on by default.
//!
//! # References
//!
//! - Ronneberger, Fischer and Brox, U-Net: Convolutional Networks for Biomedical Image Segmentation, MICCAI 2015,
//!   doi 10.1007/978-3-319-24574-4_28.

mod blend;
mod built_in;
mod classes;
mod close_ups;
mod collage;
mod description;
mod error;
mod onnx_segmenter;
mod options;
mod output;
mod segmentation;
mod segmenter;
mod zooms;

pub use classes::{Classes, Role};
pub use close_ups::CloseUps;
pub use description::{Activation, SegmentDescription};
pub use error::SegmentError;
pub use onnx_segmenter::OnnxSegmenter;
pub use options::SegmenterOptions;
pub use segmentation::{Segmentation, UNSEEN};
pub use segmenter::{Segmenter, SegmenterReport};

// Those types of `pomona-network` that the types above are made with.
pub use pomona_network::{Network, NetworkError, RuntimeChoice, RuntimeReport, TilingChoice};
