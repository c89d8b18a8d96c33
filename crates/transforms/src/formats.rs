//! Transforms in the forms of other programs.
//!
//! Each form tells which way round its quaternion is and in which order its angles are, here by its
//! fields' names; lengths are metres, angles radians in all of them.

mod checked;
mod easy_handeye;
mod error;
mod opencv;
mod static_transform;
mod urdf;

pub use easy_handeye::{HandEyeType, from_easy_handeye, to_easy_handeye};
pub use error::FormatError;
pub use opencv::{from_opencv_yaml, to_opencv_yaml};
pub use static_transform::{
    StaticTransformForm, from_static_transform_arguments, to_static_transform_arguments,
};
pub use urdf::{from_urdf_origin, to_urdf_joint, to_urdf_origin};
