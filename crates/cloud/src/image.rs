//! Image files as bytes: PNG in and out, JPEG, TIFF and NPY in.

mod claim;
mod color;
mod depth;
mod depth_file;
mod depth_values;
mod exif;
mod gray;
mod jpeg;
mod npy;
mod png;
mod tiff;

pub use depth_values::DepthValues;

#[cfg(test)]
mod tests;
