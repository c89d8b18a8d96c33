//! A frame's answers and the robot's plan as other programs read them: messages of ROS 2 and `MoveIt`, and recordings.
//!
//! [`ros`] writes a plan as YAML that `ros2 topic pub` takes.
//!
//! # Features
//!
//! `mcap` (off by default): the module `recording` writes a frame and its plan as an MCAP file with
//! Foxglove's schemas.

#[cfg(feature = "mcap")]
pub mod recording;
pub mod ros;
