//! Whether a result is good enough, and no worse than the last blessed one.

mod field;
mod golden;
mod judgement;
mod limits;

pub use field::{Better, FIELDS, Field};
pub use golden::{GOLDEN_SCHEMA, Golden};
pub use judgement::{Finding, Verdict, failures, judge};
pub use limits::{FieldLimits, Limits, SuiteLimits};
