mod chart;
mod estimator;
mod least_squares;

pub(crate) use chart::PlaneChart;
pub use estimator::PlaneEstimator;
pub use least_squares::plane_least_squares;
