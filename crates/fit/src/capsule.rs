mod estimator;
mod extent;

pub use estimator::CapsuleEstimator;
pub use extent::capsule_along;
