mod chart;
mod estimator;
mod geometric;
mod kernel;
mod minimal;
mod near_line;

pub(crate) use chart::CylinderChart;
pub use estimator::CylinderEstimator;
pub(crate) use geometric::cylinder_held;
pub use geometric::{cylinder_geometric, cylinder_weighted};
pub(crate) use kernel::pipe;
pub use minimal::cylinder_through;
pub use near_line::cylinder_near_line;
