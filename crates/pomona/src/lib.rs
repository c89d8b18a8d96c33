//! How to pick each apple of an RGB-D frame: the pipeline that other programs add.
//!
//! ```
//! use pomona::{Config, Picker};
//! use pomona_scenes::Suite;
//!
//! // A frame of one apple below a branch; `Frame::read` takes one from a folder.
//! let case = Suite::Lab15.cases().find(|case| case.name.contains("x0")).unwrap();
//! let scene = case.scene();
//!
//! let picker = Picker::new(Config::default())?;
//! let outcome = picker.pick(&scene.frame, 0, None)?;
//!
//! let pick = &outcome.record.picks[0];
//! assert_eq!(pick.status, pomona::Status::Picked);
//! let [_, y, _] = pick.direction.unwrap();
//! assert!(y < -0.9, "the branch is above the apple, and y points down");
//! # Ok::<(), pomona::PickError>(())
//! ```
//!
//! # Concepts
//!
//! - A [`Picker`] holds a checked [`Config`] and turns a frame into an [`Outcome`]: the
//!   [`Record`] that `picks.json` holds, and beside it the [`Evidence`] of each apple (the
//!   pixels of its surface and of its branch) for pictures.
//! - Each apple is worked on by itself, so the apples of a frame run in parallel;
//!   the random numbers of one depend on (run seed, frame, apple) and nothing else.
//! - [`find_apples`] finds the boxes where a frame has none: a `pomona_detect::Detector` sees them in the colour
//!   image, depth marks those that show no apple and joins those that show the same one, and
//!   [`Picker::pick_found`] takes it from there.
//! - An apple without an answer is no error: it has a [`Status`] that says why, and what is
//!   known stays in its record. Asked for in [`FallbackConfig`], a labelled way to come in stands beside the refusal.
//! - A [`Robot`], where there is one, plans from an outcome how its gripper gets to each apple and in
//!   which order, and adds that to the record.
//! - Two methods are chosen by name: `paper` ([`PaperConfig`]), Gao et al. 2022, and `robust`
//!   ([`RobustConfig`]), ours, whose answers say how sure they are.
//!
//! # Frames and units
//!
//! Metres and radians; the camera's frame is REP-103 optical (x right, y down, z forward).
//! With a transform, position and direction are given in the robot's frame as well.
//!
//! # Not here
//!
//! Networks that find apples in a colour image (`pomona-detect`, or the frame's boxes say where they are), several frames
//! of one tree (`pomona-fusion`), messages of ROS 2 and recordings (`pomona-messages`), drawing, argument parsing.
//!
//! # References
//!
//! Gao, Zhou, Cao and Jiang 2022, "An Algorithm for Calculating Apple Picking Direction
//! Based on 3D Vision", Agriculture 12(8), 1170, doi 10.3390/agriculture12081170.

mod config;
mod detection;
mod error;
mod fallback;
mod fusion_config;
mod paper;
mod picker;
mod plan_record;
mod record;
mod robot;
mod robust;
mod seed;
mod surroundings;

pub use config::{Config, ConfigError, Method, PaperConfig};
pub use detection::{
    DetectionConfig, DetectionRecord, DetectionTiming, Found, FoundBox, FoundBy, FoundRecord, Mark,
    find_apples,
};
pub use error::PickError;
pub use fallback::{DirectionSource, FallbackConfig, FallbackKind};
pub use fusion_config::FusionConfig;
pub use picker::{Evidence, Outcome, Picker, RobotFromCamera};
pub use plan_record::{
    ApproachRecord, ClearanceRecord, GripperRecord, OrderRecord, PathRecord, PieceRecord,
    PlanRecord, PoseRecord, SampleRecord, WayRecord,
};
pub use pomona_approach::{ApproachConfig, COMMENTED_DEFAULTS as ROBOT_DEFAULTS, Gripper};
pub use record::{
    AppleRecord, BoxRecord, BranchRecord, CandidateRecord, FallbackRecord, FrameRecord, Pick,
    Record, RobotRecord, SCHEMA, Status, TimingRecord,
};
pub use robot::{Robot, RobotPlan};
pub use robust::{RobustConfig, SensorPreset};
