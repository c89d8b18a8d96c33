//! Rules that models obey in the search and after every refit.

mod angle;
mod distance;
mod radius;
mod refusing;
mod side;
mod window;

pub use angle::AngleWindow;
pub use distance::DistanceWindow;
pub use radius::RadiusWindow;
pub use refusing::Refusing;
pub use side::{CenterSide, FootSide};
pub use window::WindowError;
