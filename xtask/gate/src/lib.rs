//! The regression gate: whether a result is good enough, and no worse than the last blessed one.
//!
//! `cargo xtask regress` decides by it, and tests hold it against methods that are spoilt on purpose.
//!
//! ```
//! use serde_json::json;
//! use xtask_gate::{Golden, Limits, failures, judge};
//!
//! let limits = Limits::parse(r#"
//!     [[suite]]
//!     name = "lab15"
//!     method = "paper"
//!     [suite.fields]
//!     angle_mean_deg = { ceiling = 6.0, tolerance = 0.2 }
//! "#)?;
//! let result = json!({ "suite": "lab15", "method": "paper", "cases": 15,
//!                      "angle": { "error": { "mean": 0.09 } } });
//! let golden = Golden::of(&result, &limits.suites[0])?;
//!
//! let moved = json!({ "suite": "lab15", "method": "paper", "cases": 15,
//!                     "angle": { "error": { "mean": 0.10 } } });
//! let findings = judge(&moved, &limits.suites[0], Some(&golden));
//! assert_eq!(failures(&findings).count(), 1, "0.6° more is over the tolerance");
//! # Ok::<(), anyhow::Error>(())
//! ```
//!
//! # Concepts
//!
//! - [`Limits`]: the one reviewed file `xtask/regress.toml`; for each suite the fields that count, each
//!   with a floor, a ceiling, and the tolerance within which it may move.
//! - [`Golden`]: what the last blessed run gave. A run may bless it anew; limits change by hand alone.
//! - [`judge`]: one [`Finding`] for each field.
//!
//! # Not here
//!
//! Any algorithm: results are read as JSON, as the program wrote them.

mod field;
mod golden;
mod judgement;
mod limits;

pub use field::{Better, FIELDS, Field};
pub use golden::{GOLDEN_SCHEMA, Golden};
pub use judgement::{Finding, Verdict, failures, judge};
pub use limits::{FieldLimits, Limits, RealLimits, SuiteLimits};
