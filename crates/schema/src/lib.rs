//! JSON Schemas made from types, and compared with the copies in the documentation.
//!
//! ```
//! use pomona_schema::{UnitVector, schema_of};
//! use schemars::JsonSchema;
//!
//! /// Where a lamp hangs and shines.
//! #[derive(JsonSchema)]
//! #[schemars(deny_unknown_fields)]
//! struct Lamp {
//!     /// Its place, metres.
//!     place: [f64; 3],
//!     /// Which way it shines.
//!     #[schemars(with = "UnitVector")]
//!     direction: [f64; 3],
//! }
//!
//! let schema = schema_of::<Lamp>("lamp/1", "lamp.schema.json");
//! assert_eq!(schema["title"], "lamp/1");
//! assert_eq!(schema["properties"]["place"]["description"], "Its place, metres.");
//! ```
//!
//! # Concepts
//!
//! - A record's crate derives `JsonSchema` for its tests only, so that no other build pays for it, and has one test that
//!   calls [`assert_in_docs`].
//! - Descriptions come from the doc comments, what must be there from `serde`'s attributes, ranges and conditions from
//!   `schemars`'.
//! - A field of a type whose crate knows no schemas names the same part or shape here: `#[schemars(with = "…")]`.
//! - With the environment variable `UPDATE_SCHEMAS` set, [`assert_in_docs`] writes the file in place of comparing it.
//!
//! # Not here
//!
//! The records; validation of a file against its schema.

mod docs;
mod parts;
mod plain;
mod shapes;

pub use docs::{assert_in_docs, schema_of};
pub use parts::{DetectorReport, Proportion, RuntimeReport, SegmenterReport};
pub use shapes::{Nullable, Share, UnitQuaternion, UnitVector};
