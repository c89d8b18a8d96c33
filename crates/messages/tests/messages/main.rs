//! Messages against the definitions of ROS 2, recordings against their schemas and another reader.

#![expect(
    clippy::unwrap_used,
    reason = "a test that cannot go on should fail where it stands"
)]

mod lab;
#[cfg(feature = "mcap")]
mod recording;
mod ros;
