//! Transforms in the formats of other programs.
//!
//! The names of the fields state the order of the quaternion and of the angles; lengths are metres and angles radians
//! in all of them.

mod checked;
mod easy_handeye;
mod error;
mod matrix_text;
mod opencv;
mod stamped;
mod static_transform;
mod urdf;

pub use easy_handeye::{HandEyeType, from_easy_handeye, to_easy_handeye};
pub use error::FormatError;
pub use matrix_text::from_matrix_text;
pub use opencv::{from_opencv_yaml, to_opencv_yaml};
pub use stamped::from_stamped;
pub use static_transform::{
    StaticTransformForm, from_static_transform_arguments, to_static_transform_arguments,
};
pub use urdf::{from_urdf_origin, to_urdf_joint, to_urdf_origin};
