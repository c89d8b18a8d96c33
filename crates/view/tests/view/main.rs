//! What a person sees in the pictures, read off their pixels.

mod cloud;
mod overlay;
