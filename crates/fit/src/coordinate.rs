use std::fmt::Debug;
use std::ops::{Add, AddAssign, Mul, Sub};

/// A number that coordinates are stored and scored in: `f32` or `f64`.
pub trait Coordinate:
    Copy
    + Debug
    + PartialOrd
    + Send
    + Sync
    + Add<Output = Self>
    + AddAssign
    + Sub<Output = Self>
    + Mul<Output = Self>
    + sealed::Sealed
    + 'static
{
    /// The nearest number of this type.
    fn from_f64(value: f64) -> Self;

    /// The same number as `f64`.
    fn to_f64(self) -> f64;

    /// The nearest number to the square root.
    #[must_use]
    fn square_root(self) -> Self;
}

mod sealed {
    pub trait Sealed {}
    impl Sealed for f32 {}
    impl Sealed for f64 {}
}

impl Coordinate for f32 {
    fn from_f64(value: f64) -> Self {
        value as f32
    }
    fn to_f64(self) -> f64 {
        f64::from(self)
    }
    #[inline(always)]
    fn square_root(self) -> Self {
        self.sqrt()
    }
}

impl Coordinate for f64 {
    fn from_f64(value: f64) -> Self {
        value
    }
    fn to_f64(self) -> f64 {
        self
    }
    #[inline(always)]
    fn square_root(self) -> Self {
        self.sqrt()
    }
}
