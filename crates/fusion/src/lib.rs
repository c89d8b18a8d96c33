//! Several frames of one tree: what each frame says of an apple, combined in the robot's frame.
//!
//! ```
//! use nalgebra::Isometry3;
//! use pomona::{Config, Picker, RobotFromCamera};
//! use pomona_fusion::{FusionConfig, PosedRecord, fuse};
//! use pomona_scenes::{Axis, Lab, Orientation, Sensor, Shot};
//! use pomona_transforms::Transform;
//!
//! // One apple below a branch, rendered from two places 50 mm apart.
//! let upright = Orientation { axis: Axis::X, degrees: 0 };
//! let (world, camera) = (Lab::default().world(upright), Shot::paper_camera());
//! let picker = Picker::new(Config::default())?;
//! let mut frames = Vec::new();
//! for (id, x) in [("left", 0.0), ("right", 0.05)] {
//!     let seen = world.transformed(&Isometry3::translation(-x, 0.0, 0.0));
//!     let shot = Shot::new(id, camera.clone(), Sensor::paper(), 1).take(&seen);
//!     let pose = Transform::from_quaternion([x, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0])?;
//!     let pose = RobotFromCamera::new(pose, "base", camera.frame_id.clone());
//!     frames.push((picker.pick(&shot.frame, 0, Some(&pose))?.record, pose));
//! }
//!
//! let posed: Vec<PosedRecord> = frames
//!     .iter()
//!     .map(|(record, robot_from_camera)| PosedRecord { record, robot_from_camera })
//!     .collect();
//! let fusion = fuse(&posed, &FusionConfig::default())?;
//! assert_eq!(fusion.record.apples.len(), 1);
//! assert_eq!(fusion.record.apples[0].sightings.len(), 2);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

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
pub use fuse::{Fusion, PosedRecord, fuse};
pub use pomona::FusionConfig;
pub use record::{
    DirectionUse, FUSED_SCHEMA, FusedApple, FusedFrame, FusedRecord, FusedStatus, MovedRecord,
    PlaceUse, ShiftRecord, SightingRecord,
};
