//! RGB-D frames and point clouds: what a depth camera delivers, and the files it comes in.

mod boxes;
mod camera;
mod cloud;
mod color;
mod depth;
mod frame;

pub use boxes::PixelBox;
pub use camera::{Camera, Distortion};
pub use cloud::PointCloud;
pub use color::ColorImage;
pub use depth::DepthImage;
pub use frame::Frame;
