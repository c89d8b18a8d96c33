use crate::Coordinate;
use crate::simd::{Radial, Shell};
use pomona_geometry::Sphere;

/// A sphere's centre.
#[derive(Clone, Copy)]
pub(crate) struct Center<T>([T; 3]);

impl<T: Coordinate> Radial<T> for Center<T> {
    #[inline(always)]
    fn squared_distance(&self, x: T, y: T, z: T) -> T {
        let (dx, dy, dz) = (x - self.0[0], y - self.0[1], z - self.0[2]);
        dx * dx + dy * dy + dz * dz
    }
}

/// A sphere made ready for one threshold.
pub(crate) fn shell<T: Coordinate>(sphere: &Sphere, threshold: f64) -> Shell<T, Center<T>> {
    let center = [sphere.center.x, sphere.center.y, sphere.center.z].map(T::from_f64);
    Shell::new(Center(center), sphere.radius, threshold)
}
