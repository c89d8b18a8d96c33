//! Transforms, their files and their covariances, against what they promise.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

mod file;
mod formats;
mod tool;
mod transform;
mod uncertain;
