//! Evaluations as a whole: scenes and folders, calipers, a simulated robot, and the regression gate.

mod calipers;
mod evaluation;
mod real;
mod robot;
mod sabotage;
