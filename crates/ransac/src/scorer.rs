//! How well a model explains the data.

mod kernel;
mod per_datum;
mod scoring;

pub use kernel::{Flat, Kernel, Marginal, Quadratic, Tukey};
pub use per_datum::{PerDatum, PerDatumError};
pub use scoring::{InlierCount, MarginalScore, Msac, Scorer, Threshold};
