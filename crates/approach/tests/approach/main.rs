//! What a planner promises, held against geometry that it does not share code with.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

mod free;
mod order;
mod path;
mod readers;
mod refusals;
mod world;
