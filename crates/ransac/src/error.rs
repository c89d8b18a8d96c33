use thiserror::Error;

/// Why a search gave no model.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum RansacError {
    /// There are fewer data than a minimal sample has.
    #[error("too few data: a minimal sample has {needed}, there are {available}")]
    TooFewData {
        /// Data in a minimal sample.
        needed: usize,
        /// Data there are.
        available: usize,
    },
    /// No sample gave any model: the data coincide, lie in a degenerate place, or are not finite.
    #[error("all {draws} samples were degenerate")]
    AllDegenerate {
        /// Samples drawn.
        draws: u64,
    },
    /// There were models, and the constraints refused every one.
    #[error("the constraint '{constraint}' refused most of {draws} samples, and none was left")]
    ConstraintNeverMet {
        /// Samples drawn.
        draws: u64,
        /// Name of the constraint that refused most.
        constraint: &'static str,
    },
    /// The best model has too few inliers.
    #[error("no consensus: the best model has {inliers} inliers of the {needed} needed")]
    NoConsensus {
        /// Inliers of the best model.
        inliers: usize,
        /// Inliers needed.
        needed: usize,
    },
    /// The stopping rule ended the search before the first sample.
    #[error("the stopping rule allows no sample")]
    NothingDrawn,
}
