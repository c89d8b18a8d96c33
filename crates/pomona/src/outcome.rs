//! The pipeline's answers as types: positions, directions and covariances with their frame, lengths in metres,
//! angles in radians.
//!
//! Every stage of the program reads these; [`record`](crate::record) turns them into the form of `picks.json`.

mod apple;
mod confidence;
mod direction;
mod fitted;
mod frame;
mod plan;
mod presence;
mod robot;
mod status;
mod wood;

pub use apple::{AppleAnswer, Evidence, StageTimes, Weighed};
pub use confidence::CONFIDENCE_FEATURES;
pub(crate) use direction::unit;
pub use direction::{DirectionSource, FallbackDirection, PickDirection};
pub use fitted::{BranchCandidate, FittedApple, FittedBranch};
pub use frame::FrameAnswer;
pub use plan::{ApplePlan, NearestObstacle, PlannedApproach, PlannedTurn};
pub use presence::PRESENCE_FEATURES;
pub use robot::{RobotFromCamera, RobotTarget};
pub use status::Status;
pub use wood::WOOD_FEATURES;
