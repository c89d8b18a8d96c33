//! The pipeline on generated frames, stage by stage.

#![allow(
    clippy::unwrap_used,
    reason = "a test that cannot go on should fail where it stands"
)]

mod answers;
mod boxes_on_nothing;
mod detection;
mod every_setting;
mod fallback;
mod pick;
mod robot;
mod robust;
mod wood;
