//! Image files as bytes: PNG in and out, JPEG in.

mod claim;
mod color;
mod depth;
mod exif;
mod gray;
mod jpeg;
mod png;

#[cfg(test)]
mod tests;
