//! Which data make up a minimal sample.

mod neighbours;
mod pairs;
mod prosac;
mod sampling;
mod uniform;

pub use neighbours::{Anywhere, Local, Neighbourhood, Spread};
pub use pairs::{Pairs, Partners};
pub use prosac::Prosac;
pub use sampling::Sampler;
pub use uniform::Uniform;
