mod estimator;
mod least_squares;

pub use estimator::PlaneEstimator;
pub use least_squares::plane_least_squares;
