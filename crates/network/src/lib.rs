//! An ONNX network run over an image: loaded into an inference backend, fed window by window, its outputs mapped
//! back to pixels of the image.
//!
//! The caller interprets the outputs: boxes for a detector, classes of pixels for a segmenter. Here a
//! stand-in for a segmentation network answers `[1, 1, H, W]` logits, and its caller counts the pixels above 0:
//!
//! ```
//! use pomona_cloud::{ColorImage, PixelWindow};
//! use pomona_network::{
//!     Element, ImageNetwork, Network, NetworkError, Port, Preparation, RuntimeReport, Tensor, Tiling, TilingOptions,
//! };
//!
//! /// Calls every pixel wood that is more red than green. A file is opened with `open_network` instead.
//! struct Redder([Port; 2]);
//!
//! impl Network for Redder {
//!     fn inputs(&self) -> &[Port] {
//!         &self.0[..1]
//!     }
//!     fn outputs(&self) -> &[Port] {
//!         &self.0[1..]
//!     }
//!     fn run(&self, inputs: &[Tensor]) -> Result<Vec<Tensor>, NetworkError> {
//!         let (red, green) = (&inputs[0].data[..64], &inputs[0].data[64..128]);
//!         let data = red.iter().zip(green).map(|(r, g)| r - g).collect();
//!         Ok(vec![Tensor { name: "wood".to_owned(), shape: vec![1, 1, 8, 8], data }])
//!     }
//!     fn report(&self) -> RuntimeReport {
//!         RuntimeReport::new("redder", "1")
//!     }
//! }
//!
//! let port = |name: &str, channels| Port {
//!     name: name.to_owned(),
//!     shape: [1, channels, 8, 8].map(Some).to_vec(),
//!     element: Element::F32,
//! };
//! let network = Box::new(Redder([port("image", 3), port("wood", 1)]));
//! let network = ImageNetwork::new(network, [8, 8], Preparation::default()).map_err(|fault| NetworkError::model("redder", fault))?;
//!
//! // A brown post, 4 pixels wide, before grass; only the tiles in which it can be are run.
//! let mut image = ColorImage::filled(32, 8, [60, 120, 60]);
//! for row in image.pixels.chunks_exact_mut(32) {
//!     row[18..22].fill([130, 90, 60]);
//! }
//! let mut options = TilingOptions::default();
//! (options.tile, options.overlap, options.whole_pass) = (Some(8), 2, false);
//! let tiling = Tiling::new(&options, [8, 8])?;
//! let mut windows = tiling.windows([32, 8]);
//! windows.retain(|window| window.x1 > 16 && window.x0 < 24);
//! assert_eq!((windows.len(), tiling.windows([32, 8]).len()), (2, 5));
//!
//! let mut wood = vec![false; 32 * 8];
//! let seen = network.run_windows(&image, &windows, |letterbox, outputs| Ok::<_, NetworkError>((letterbox, outputs)))?;
//! for (letterbox, outputs) in seen {
//!     let PixelWindow { x0, y0, x1, y1 } = letterbox.window();
//!     for (v, u) in (y0..y1).flat_map(|v| (x0..x1).map(move |u| (v, u))) {
//!         let [x, y] = letterbox.to_input([u as f64 + 0.5, v as f64 + 0.5]).map(|c| c as usize);
//!         wood[v * 32 + u] |= outputs[0].data[y * 8 + x] > 0.0;
//!     }
//! }
//! assert_eq!(wood.iter().filter(|wood| **wood).count(), 4 * 8);
//! # Ok::<(), NetworkError>(())
//! ```
//!
//! # Concepts
//!
//! - A [`Network`] has named inputs and outputs, [`Port`]s, and turns [`Tensor`]s into tensors. [`open_network`]
//!   creates one from an ONNX file; implement the trait for another inference backend.
//! - An inference backend (*runtime*) executes it: ONNX Runtime, loaded at run time if its library is found, or rten,
//!   built in. [`RuntimeChoice`] selects one, [`RuntimeReport`] names the one used and the reason.
//! - The file is read and checked before a backend sees it: a truncated or foreign file gives the same message with
//!   both, and both name the same inputs, outputs and metadata.
//! - A [`Tiling`] cuts a large image into overlapping windows. A [`Letterbox`] scales a window into the network's input
//!   and maps points back, exactly; [`Preparation`] defines how pixels become numbers. An [`ImageNetwork`] combines
//!   them and distributes the windows over the cores.
//!
//! Networks are untrusted: shapes that do not fit are errors that name them, and a panic of a backend on a malformed
//! model becomes an error.
//!
//! # Not here
//!
//! The meaning of outputs: boxes are decoded in `pomona-detect`. Training, networks with several images or other
//! inputs than an image and its size, and video.
//!
//! # Features
//!
//! `onnxruntime` loads ONNX Runtime at run time, if its library is found; `embedded` builds rten in. Both are on by
//! default; with neither, a custom [`Network`] still runs.
//!
//! # References
//!
//! - ONNX, Open Neural Network Exchange, version 1.17, `onnx.proto3`.
//! - Protocol Buffers documentation, Encoding.

pub mod description;
mod error;
mod image_input;
mod image_network;
mod letterbox;
mod names;
mod network;
mod onnx_file;
mod preparation;
mod resample;
mod runtime;
mod source;
mod tensor;
mod tiling;
mod tiling_choice;

pub use error::NetworkError;
pub use image_input::{LARGEST_INPUT_SIDE, input_size};
pub use image_network::{ImageNetwork, check_image};
pub use letterbox::Letterbox;
pub use names::nearest;
pub use network::{Network, RuntimeReport};
pub use pomona_files::Malformed;
pub use preparation::{ChannelOrder, Padding, Preparation};
pub use runtime::{RuntimeChoice, open_network};
pub use source::ModelSource;
pub use tensor::{Element, Port, Tensor};
pub use tiling::{Tiling, TilingOptions};
pub use tiling_choice::TilingChoice;
