use serde::{Deserialize, Serialize};

/// A box in a colour image, in pixels; `x_min <= x < x_max` and likewise y.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PixelBox {
    /// Name of the boxed apple; a number as text where the file gives none.
    pub name: String,
    /// Left edge.
    pub x_min: f64,
    /// Top edge.
    pub y_min: f64,
    /// Right edge.
    pub x_max: f64,
    /// Bottom edge.
    pub y_max: f64,
    /// Detection score in 0..=1; 1 for a box drawn by a person.
    pub score: f64,
}
