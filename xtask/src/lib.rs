//! The regression gate: what `cargo xtask regress` decides by, for its own tests and those of others.
//!
//! ```
//! use serde_json::json;
//! use xtask::gate::{Golden, Limits, failures, judge};
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
//! - [`gate::Limits`]: the one reviewed file `xtask/regress.toml`; for each suite the fields that count, each
//!   with a floor, a ceiling, and the tolerance within which it may move.
//! - [`gate::Golden`]: what the last blessed run gave. A run may bless it anew; limits change by hand alone.
//! - [`gate::judge`]: one [`gate::Finding`] for each field.
//!
//! # Not here
//!
//! Any algorithm: results are read as JSON, as the program wrote them.

pub mod gate;
