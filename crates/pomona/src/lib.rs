//! Picking directions for the apples of an RGB-D frame: the pipeline as a library.
//!
//! ```
//! use pomona::{CheckedFrame, Config, Picker};
//! use pomona_scenes::Suite;
//!
//! // A frame of one apple below a branch; `Frame::read` reads one from a folder.
//! let case = Suite::Lab15.cases().find(|case| case.name.contains("x0")).unwrap();
//! let scene = case.scene();
//!
//! let picker = Picker::new(Config::default())?;
//! let answer = picker.pick(&CheckedFrame::new(&scene.frame)?, 0, None)?;
//!
//! let apple = &answer.apples[0];
//! assert_eq!(apple.status, pomona::Status::Picked);
//! let direction = apple.pick.unwrap().direction.vector();
//! assert!(direction.y < -0.9, "the branch is above the apple, and y points down");
//! # Ok::<(), pomona::PickError>(())
//! ```
//!
//! # Concepts
//!
//! - A [`CheckedFrame`] is a frame whose images, camera and boxes fit together. It is made once and passed
//!   to every stage; its depth image is deprojected at most once.
//! - A [`Picker`] holds a checked [`Config`] and turns a frame into a [`FrameAnswer`]: for each box an
//!   [`AppleAnswer`] with the fitted apple, its branch, the direction, and the [`Evidence`] (the pixels of
//!   surface and branch) for pictures. Positions, directions and covariances carry their coordinate frame as a type.
//! - [`record`] is the form of `picks.json`: made from the answers when they are written, read by no stage.
//! - Apples are independent of each other, so those of a frame run in parallel;
//!   the random numbers of one depend on (run seed, frame, apple) and nothing else.
//! - [`find_apples`] detects the boxes of a frame without any: a `pomona_detect::Detector` finds them in the colour
//!   image, the depth check marks those without an apple and merges those of the same one, and
//!   [`Picker::pick_detected`] continues from there.
//! - An apple without a direction is no error: it has a [`Status`] that says why, and what is
//!   known stays in its answer. [`FallbackConfig`] adds a labelled fallback direction on request.
//! - A [`Robot`], where there is one, plans how its gripper gets to each apple and in which order, and adds
//!   an [`ApplePlan`] to each answer.
//! - Two methods are chosen by name: `paper` ([`PaperConfig`]), Gao et al. 2022, and `robust`
//!   ([`RobustConfig`]), ours, whose answers state their confidence.
//!
//! # Frames and units
//!
//! Metres and radians; the camera frame is REP-103 optical (x right, y down, z forward). With a transform, position
//! and direction are also given in the robot's frame.
//!
//! # Not here
//!
//! Networks that find apples in a colour image (`pomona-detect`, or the frame's boxes say where they are), several
//! frames of one tree (`pomona-fusion`), messages of ROS 2 and recordings (`pomona-messages`), drawing, argument
//! parsing.
//!
//! # References
//!
//! Gao, Zhou, Cao and Jiang 2022, "An Algorithm for Calculating Apple Picking Direction
//! Based on 3D Vision", Agriculture 12(8), 1170, doi 10.3390/agriculture12081170.

mod chromaticity;
mod config;
mod detection;
mod error;
mod fallback;
mod frame;
mod optics;
mod outcome;
mod paper;
mod picker;
pub mod record;
mod robot;
mod robust;
mod roundness;
mod seed;
mod size_doubt;

pub use config::{
    Config, DetectionConfig, FallbackConfig, FallbackKind, FruitConfig, FusionConfig, Method,
    PaperConfig, RobustConfig, SensorPreset,
};
pub use detection::{
    BoxOrigin, DetectedApples, DetectedBox, DetectionSummary, DetectionTimes, FoundBy, Mark,
    find_apples,
};
pub use error::PickError;
pub use frame::CheckedFrame;
pub use optics::DepthQuality;
pub use outcome::{
    AppleAnswer, ApplePlan, BranchCandidate, CONFIDENCE_FEATURES, DirectionSource, Evidence,
    FallbackDirection, FittedApple, FittedBranch, FrameAnswer, NearestObstacle, PRESENCE_FEATURES,
    PickDirection, PlannedApproach, PlannedTurn, RobotFromCamera, RobotTarget, StageTimes, Status,
    WOOD_FEATURES, Weighed,
};
pub use picker::Picker;
pub use pomona_approach::{ApproachConfig, Gripper};
pub use pomona_files::{Level, Warning, WarningCode};
pub use pomona_settings::ConfigError;
pub use robot::{Robot, RobotPlan};
pub use robust::{CONFIDENCE_MODEL, PRESENCE_MODEL, WOOD_MODEL};
