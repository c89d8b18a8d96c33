//! Several frames of one tree: what each frame says of an apple, combined in the robot's frame.

mod apple;
mod associate;
mod chi_square;
mod cloud;
mod direction;
mod error;
mod fuse;
mod joint;
mod record;
mod sighting;

pub use cloud::FusedCloud;
pub use error::FusionError;
pub use fuse::{Fusion, PosedAnswer, fuse};
pub use pomona::FusionConfig;
pub use record::{
    DirectionUse, FUSED_SCHEMA, FusedApple, FusedFrame, FusedRecord, FusedStatus, MovedRecord,
    PlaceUse, ShiftRecord, SightingRecord,
};
