mod estimator;
mod geometric;
mod least_squares;
mod minimal;
mod normal;

pub use estimator::{SphereEstimator, SphereRefit};
pub use geometric::sphere_geometric;
pub use least_squares::sphere_least_squares;
pub use minimal::sphere_through;
