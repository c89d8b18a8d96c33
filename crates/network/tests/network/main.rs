//! The crate's tests, in one program.
#![expect(clippy::unwrap_used, reason = "a test may stop at the first surprise")]

#[cfg(all(feature = "onnxruntime", feature = "embedded", target_os = "linux"))]
mod library;
mod models;
mod onnx;
mod runtimes;
mod support;
