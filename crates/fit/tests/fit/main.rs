//! Properties of the fits, one module for each shape; of all solvers and kernels; and of the constraints.

mod capsule;
mod circle;
mod constraint;
mod covariance;
mod cylinder;
mod kernels;
mod quality;
mod shapes;
mod solvers;
mod sphere;
mod structures;
