//! What all Rust peers need: jobs read and answered, and the two primitives, which
//! most of them have to be given.

mod job;
mod primitive;

pub use job::{Fitted, Job, serve};
pub use primitive::{Line, Point, Primitive, Sphere};
