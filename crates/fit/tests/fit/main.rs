//! Properties of the fits, one module for each shape, and of the constraints.

mod capsule;
mod circle;
mod constraint;

mod cylinder;
mod shapes;
mod sphere;
