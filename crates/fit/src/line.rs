mod estimator;
mod least_squares;

pub use estimator::LineEstimator;
pub use least_squares::line_least_squares;
