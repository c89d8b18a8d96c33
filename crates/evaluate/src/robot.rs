//! Where the gripper ends up in the frame of a robot's base, with a camera whose place was calibrated.

mod mounting;
mod row;
mod trial;

pub use mounting::CalibrationNoise;
pub use row::{BaseRow, DirectionTerms, PlannedRow, PositionTerms, Term};
pub use trial::RobotTrial;
