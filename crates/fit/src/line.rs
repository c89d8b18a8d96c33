mod chart;
mod estimator;
mod kernel;
mod least_squares;

pub(crate) use chart::LineChart;
pub use estimator::LineEstimator;
pub(crate) use kernel::{Across, Tube};
pub use least_squares::line_least_squares;
