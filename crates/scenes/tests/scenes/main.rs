//! What scenes promise: the same bytes again, sensors with the stated statistics, truth that the images show.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

mod dense;
mod fixtures;
mod folder;
mod recovery;
mod sensor;
mod suites;
