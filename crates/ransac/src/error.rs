use std::{error::Error, fmt};

/// Why a search gave no model.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum RansacError {
    /// There are fewer data than a minimal sample has.
    TooFewData {
        /// Data in a minimal sample.
        needed: usize,
        /// Data there are.
        available: usize,
    },
    /// No sample gave any model: the data coincide, lie in a degenerate place, or are not finite.
    AllDegenerate {
        /// Samples drawn.
        draws: u64,
    },
    /// There were models, and the constraints refused every one.
    ConstraintNeverMet {
        /// Samples drawn.
        draws: u64,
        /// Name of the constraint that refused most.
        constraint: &'static str,
    },
    /// The best model has too few inliers.
    NoConsensus {
        /// Inliers of the best model.
        inliers: usize,
        /// Inliers needed.
        needed: usize,
    },
    /// The stopping rule ended the search before the first sample.
    NothingDrawn,
}

impl fmt::Display for RansacError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooFewData { needed, available } => write!(
                f,
                "too few data: a minimal sample has {needed}, there are {available}"
            ),
            Self::AllDegenerate { draws } => write!(f, "all {draws} samples were degenerate"),
            Self::ConstraintNeverMet { draws, constraint } => write!(
                f,
                "the constraint '{constraint}' refused most of {draws} samples, and none was left"
            ),
            Self::NoConsensus { inliers, needed } => write!(
                f,
                "no consensus: the best model has {inliers} inliers of the {needed} needed"
            ),
            Self::NothingDrawn => f.write_str("the stopping rule allows no sample"),
        }
    }
}

impl Error for RansacError {}
