//! The statistics of one suite under one method.

mod angle_errors;
mod base_result;
mod comparison;
mod grouping;
mod lab;
mod reliability;
mod repeatability;
mod result;

pub use angle_errors::AngleErrors;
pub use base_result::{BaseResult, BudgetTerm, Coverage, Planned};
pub use comparison::Comparison;
pub(crate) use comparison::compare;
pub use grouping::{Difficulty, Group, Grouping};
pub use lab::LabRow;
pub(crate) use reliability::RIGHT_RAD;
pub use reliability::{ConfidenceBin, Reliability, RiskPoint, SdCalibration};
pub use repeatability::Repeatability;
pub use result::{Refusals, SuiteResult, Timing};
