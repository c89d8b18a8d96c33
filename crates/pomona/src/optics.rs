//! What the depth image means: from pixels to rays and metres, the noise of a reading, where depth jumps.
//!
//! Detection and both methods read the image through this module.

mod depth_patch;
mod law;
mod noise;
mod projection;
mod quality;
mod windows;

pub(crate) use depth_patch::DepthPatch;
pub(crate) use noise::{DepthNoise, depth_jump_m};
pub(crate) use projection::Projection;
pub use quality::DepthQuality;
pub(crate) use windows::{window_of_box, window_of_sphere};
