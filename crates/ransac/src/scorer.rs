//! How well a model explains the data.

mod kernel;
mod per_datum;
mod prior;
mod scoring;

pub use kernel::{Flat, Kernel, Marginal, Quadratic, Tukey};
pub use per_datum::{PerDatum, PerDatumError};
pub use prior::WithPrior;
pub use scoring::{InlierCount, MarginalScore, Msac, Scorer, Threshold};
