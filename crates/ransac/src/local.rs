//! What is done with a hypothesis once it is the best.

mod near_best;
mod optimization;
mod reweighted;

pub use near_best::NearBest;
pub(crate) use optimization::Refitted;
pub use optimization::{
    LeastSquares, LocalOptimization, NoRefit, Refiner, RefitOnce, Scored, Then,
};
pub use reweighted::Reweighted;
