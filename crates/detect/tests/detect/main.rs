//! The crate's tests, in one program.
#![expect(clippy::unwrap_used, reason = "a test may stop at the first surprise")]

#[path = "../../fuzz/any_network.rs"]
mod any_network;
#[cfg(feature = "embedded")]
mod built_in;
mod end_to_end;
mod fake_network;
mod families;
mod hostile;
#[cfg(all(feature = "embedded", feature = "onnxruntime"))]
#[path = "../../../network/tests/network/onnx.rs"]
#[expect(dead_code, reason = "one network of those that it writes is used here")]
mod onnx;
#[cfg(feature = "embedded")]
mod real_frames;
mod recognition;
#[cfg(all(feature = "embedded", feature = "onnxruntime"))]
mod runtimes_boxes;
#[cfg(feature = "embedded")]
mod shared;
mod tiles;
