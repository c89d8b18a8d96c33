//! Settings that are declared once: name, type, default, unit, allowed range, and meaning.
//!
//! ```
//! use pomona_settings::{Description, parse, set, settings};
//!
//! settings! {
//!     /// Settings of a kettle.
//!     pub struct KettleConfig {
//!         /// Temperature at which it switches off. Higher: hotter tea, and more electricity.
//!         off_at_deg_c: f64 = 95.0, "degrees Celsius", within(30.0, 100.0);
//!         /// Temperature below which it switches on again.
//!         on_at_deg_c: f64 = 80.0, "degrees Celsius", within(0.0, 100.0);
//!     }
//!     order {
//!         off_at_deg_c > on_at_deg_c;
//!     }
//! }
//!
//! let kettle: KettleConfig = parse("off_at_deg_c = 85", "kettle.toml")?;
//! assert_eq!((kettle.off_at_deg_c, kettle.on_at_deg_c), (85.0, 80.0));
//!
//! // Names and values are checked, and the message gives the remedy.
//! let unknown = parse::<KettleConfig>("of_at_deg_c = 85", "kettle.toml").unwrap_err();
//! assert!(unknown.to_string().contains("did you mean `off_at_deg_c`"));
//! let cold = set(&kettle, "off_at_deg_c", 70.into())?.validate().unwrap_err();
//! assert_eq!(cold.to_string(), "setting off_at_deg_c = 70.0: it must be over on_at_deg_c = 80.0");
//!
//! // The same declaration explains the file.
//! let description = Description::of::<KettleConfig>();
//! assert!(description.toml("A kettle.", &kettle).contains("off_at_deg_c = 85.0"));
//! assert!(description.markdown().contains("hotter tea"));
//! assert_eq!(description.json_schema("A kettle")["properties"]["on_at_deg_c"]["default"], 80.0);
//! # Ok::<(), pomona_settings::ConfigError>(())
//! ```
//!
//! # Concepts
//!
//! - [`settings!`] declares a struct of settings. From the one declaration come the struct with its documentation, its
//!   defaults, serialisation, and its checks. Settings missing in a file keep their defaults.
//! - A declaration may have *sections*, structs declared the same way, which become the tables of the file. A setting's
//!   name is its path, `section.name`.
//! - Each setting has a [`Rule`] of its own. `order` states which of two settings is the larger one, `require` any
//!   other condition on several.
//! - [`choices!`] declares an enum whose values are names.
//! - A [`Description`] lists the sections and settings with everything that was declared; from it come the commented
//!   TOML file, Markdown tables and a JSON Schema.
//! - A setting of type `Option` may be left out; its declaration shows an example in place of a default.
//!
//! # Not here
//!
//! The meaning of any setting; the command line; the location of settings files.

// So that the macros work in this crate's own tests.
extern crate self as pomona_settings;

mod assign;
mod choice;
mod declare;
mod describe;
mod error;
mod file;
mod kind;
mod names;
mod other_values;
mod range;
pub mod readers;
pub mod rule;
mod schema;
mod setting;
mod tables;
mod toml_file;
mod value;

#[doc(hidden)]
pub mod check;
#[doc(hidden)]
pub use serde;
/// The crate of the files' format: [`set`] takes its values.
pub use toml;

pub use assign::{set, word_or_value};
pub use describe::{Description, Section, Settings};
pub use error::ConfigError;
pub use file::{parse, read};
pub use kind::{Choice, Kind};
pub use range::Range;
pub use rule::Rule;
pub use setting::Setting;
pub use value::Value;
