//! Calibration from points and poses, from files to figures.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

mod figures;
mod files;
mod points;
mod poses;
mod slips;
