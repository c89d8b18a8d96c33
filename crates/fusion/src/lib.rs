//! Several frames of one tree: the observations of each apple combined in the robot's frame.
//!
//! ```
//! use nalgebra::Isometry3;
//! use pomona::{CheckedFrame, Config, Picker, RobotFromCamera};
//! use pomona_fusion::{FusionConfig, PosedAnswer, fuse};
//! use pomona_scenes::{CameraAxis, Lab, Orientation, Sensor, Shot};
//! use pomona_transforms::Transform;
//!
//! // One apple below a branch, rendered from two positions 50 mm apart.
//! let upright = Orientation { axis: CameraAxis::X, degrees: 0 };
//! let (world, camera) = (Lab::default().world(upright), Shot::paper_camera());
//! let picker = Picker::new(Config::default())?;
//! let mut frames = Vec::new();
//! for (id, x) in [("left", 0.0), ("right", 0.05)] {
//!     let seen = world.transformed(&Isometry3::translation(-x, 0.0, 0.0));
//!     let frame = Shot::new(id, camera.clone(), Sensor::paper(), 1).take(&seen).frame;
//!     let pose = Transform::from_quaternion([x, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0])?;
//!     let pose = RobotFromCamera::new(pose, "base", camera.frame_id.clone());
//!     frames.push((picker.pick(&CheckedFrame::new(&frame)?, 0, Some(&pose))?, pose));
//! }
//!
//! let posed: Vec<_> = frames.iter().map(|(answer, pose)| PosedAnswer::new(answer, pose)).collect();
//! let tree = fuse(&posed, &FusionConfig::default())?;
//! assert_eq!(tree.apples.len(), 1);
//! assert_eq!(tree.apples[0].observations.len(), 2);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Concepts
//!
//! - A [`PosedAnswer`] is the pipeline's answer for one frame and the pose of its camera; [`fuse`] combines several
//!   into a [`FusedTree`].
//! - An *observation* is one apple as one frame shows it. Observations of one apple form a *track*: they are joined
//!   by the Mahalanobis distance of their centres, each frame at most once.
//! - Each frame has a small common *motion*: sway of the tree, or an error of its pose. Motions and positions are
//!   estimated together; a [`FrameShift`] reports what was found, and [`FusedFrame::correction`] takes it off.
//! - An apple whose observations contradict each other although its spheres overlap has moved ([`Movement`]), or one
//!   of the positions is a misfit ([`PositionUse::Misfit`]).
//! - The directions of an apple are averaged where they agree; the confidence is the posterior probability of the group
//!   that agrees. An apple without a direction has a [`FusedStatus`] and a reason in words.
//! - A [`FusedRecord`] is the form of `fused.json`, made from the result and read back by nothing here. A
//!   [`FusedCloud`] joins the points of all frames.
//!
//! Metres and radians, in the robot's frame.
//!
//! # Not here
//!
//! How one frame is answered (`pomona`), where a camera is (`pomona-calibrate`), registration of clouds: poses come
//! from the robot.
//!
//! # References
//!
//! Each method's source is given at its function. The joint estimate: Triggs et al. 2000, doi 10.1007/3-540-44480-7_21.
//! Association: Bar-Shalom and Fortmann 1988; Neira and Tardós 2001, doi 10.1109/70.976019. Directions: Buss and
//! Fillmore 2001, doi 10.1145/502122.502124.

mod answer;
mod apple;
mod association;
mod cloud;
mod direction;
mod error;
mod fuse;
mod joint;
mod links;
mod motion;
mod observation;
mod pairs;
mod record;
mod verdict;

pub use answer::{
    DirectionUse, FrameShift, FusedApple, FusedDirection, FusedFrame, FusedObservation,
    FusedStatus, FusedTree, Movement, PositionUse,
};
pub use cloud::FusedCloud;
pub use error::FusionError;
pub use fuse::{PosedAnswer, fuse};
pub use pomona::FusionConfig;
pub use record::{
    FUSED_SCHEMA, FusedAppleRecord, FusedFrameRecord, FusedRecord, MovedRecord, ShiftRecord,
    SightingRecord,
};
