mod chart;
mod estimator;
mod kernel;
mod least_squares;

pub(crate) use chart::PlaneChart;
pub use estimator::PlaneEstimator;
pub(crate) use kernel::Slab;
pub use least_squares::plane_least_squares;
