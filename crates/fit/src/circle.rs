mod chart;
mod estimator;
mod geometric;
mod minimal;

pub(crate) use chart::CircleChart;
pub use estimator::CircleEstimator;
pub(crate) use geometric::circle_held;
pub use geometric::{circle_geometric, circle_weighted};
pub use minimal::circle_through;
