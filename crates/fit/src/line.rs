mod chart;
mod estimator;
mod least_squares;

pub(crate) use chart::LineChart;
pub use estimator::LineEstimator;
pub use least_squares::line_least_squares;
