//! What a planner promises, held against geometry that it does not share code with.

// The attribute on a test function does not reach what it calls.
#![allow(clippy::unwrap_used)]

mod free;
mod order;
mod path;
mod refusals;
mod world;
