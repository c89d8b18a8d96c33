mod chart;
mod estimator;
mod geometric;
mod kernel;
mod least_squares;
mod minimal;
mod normal;
mod sample;

pub(crate) use chart::SphereChart;
pub use estimator::{SphereEstimator, SphereRefit};
pub(crate) use geometric::sphere_held;
pub use geometric::{sphere_geometric, sphere_weighted};
pub(crate) use kernel::shell;
pub use least_squares::sphere_least_squares;
pub use minimal::{sphere_through, sphere_through_normals, spheres_of_radius};
pub use sample::{FourPoints, SphereSample, ThreePointsAndRadius, TwoNormals};
