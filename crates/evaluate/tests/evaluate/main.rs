//! Evaluations as a whole: scenes and folders, calipers, strokes, a simulated robot, and the regression gate.

#![allow(
    clippy::unwrap_used,
    reason = "the functions that tests share are tests too"
)]

mod calipers;
mod evaluation;
mod real;
mod robot;
mod sabotage;
