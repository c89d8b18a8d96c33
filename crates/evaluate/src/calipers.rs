//! Real frames: fitted radii against measured ones, and the centres of two frames against each other.

mod alignment;
mod measure;
mod rigid;
mod table;

pub(crate) use alignment::SharedCenters;
pub use alignment::{AlignedApple, Alignment};
pub use measure::{
    CALIPER_SCHEMA, CaliperFrame, CaliperReport, CaliperResult, CaliperRow, measure_calipers,
};
pub use table::{Caliper, read_calipers};
