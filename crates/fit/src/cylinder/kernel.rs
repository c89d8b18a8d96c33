use crate::Coordinate;
use crate::line::Across;
use crate::simd::{Radial, Shell};
use pomona_geometry::Cylinder;

impl<T: Coordinate> Radial<T> for Across<T> {
    #[inline(always)]
    fn squared_distance(&self, x: T, y: T, z: T) -> T {
        Across::squared_distance(self, x, y, z)
    }
}

/// A cylinder made ready for one threshold.
pub(crate) fn pipe<T: Coordinate>(cylinder: &Cylinder, threshold: f64) -> Shell<T, Across<T>> {
    Shell::new(Across::new(&cylinder.axis), cylinder.radius, threshold)
}
