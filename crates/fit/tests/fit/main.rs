//! Properties of the fits, one module for each shape, and of the constraints.

mod capsule;
mod circle;
mod constraint;
mod covariance;

mod cylinder;
mod quality;
mod shapes;
mod sphere;
mod structures;
