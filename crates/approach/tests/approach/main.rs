//! What a planner promises, held against geometry that it does not share code with.

mod free;
mod order;
mod path;
mod refusals;
mod world;
