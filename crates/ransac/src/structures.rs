//! Several models in the same data.

mod claims;
mod competition;
mod sequential;

pub use competition::{Competition, Instance, Selection};
pub use sequential::{Ended, Extraction, Sequential};
