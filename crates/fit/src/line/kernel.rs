use crate::Coordinate;
use crate::simd::Kernel;
use nalgebra::Vector3;
use pomona_geometry::{Line, across};

/// A line made ready for one threshold: two unit vectors across it, and the squared threshold.
///
/// The squared distance is the sum of two squares, which unlike |w|² − (w·e)²
/// loses no digits far along the line. Floor: 16 operations and a comparison a point for counting,
/// and 12 bytes in f32 (24 in f64).
#[derive(Clone, Copy)]
pub(crate) struct Tube<T> {
    pub(crate) axis: Across<T>,
    squared_threshold: T,
    inverse: T,
}

/// A line's point and two unit vectors across it.
#[derive(Clone, Copy)]
pub(crate) struct Across<T> {
    origin: [T; 3],
    u: [T; 3],
    v: [T; 3],
}

impl<T: Coordinate> Across<T> {
    pub(crate) fn new(line: &Line) -> Self {
        let [u, v] = across(&line.direction);
        let coordinates = |w: Vector3<f64>| [w.x, w.y, w.z].map(T::from_f64);
        Self {
            origin: coordinates(line.point.coords),
            u: coordinates(u),
            v: coordinates(v),
        }
    }

    #[inline(always)]
    pub(crate) fn squared_distance(&self, x: T, y: T, z: T) -> T {
        let (wx, wy, wz) = (x - self.origin[0], y - self.origin[1], z - self.origin[2]);
        let a = wx * self.u[0] + wy * self.u[1] + wz * self.u[2];
        let b = wx * self.v[0] + wy * self.v[1] + wz * self.v[2];
        a * a + b * b
    }
}

impl<T: Coordinate> Tube<T> {
    /// A threshold that is negative or NaN holds nothing.
    pub(crate) fn new(line: &Line, threshold: f64) -> Self {
        let square = if threshold >= 0.0 {
            threshold * threshold
        } else {
            -1.0
        };
        Self {
            axis: Across::new(line),
            squared_threshold: T::from_f64(square),
            inverse: T::from_f64(1.0 / square),
        }
    }
}

impl<T: Coordinate> Kernel<T> for Tube<T> {
    #[inline(always)]
    fn holds(&self, x: T, y: T, z: T) -> bool {
        self.axis.squared_distance(x, y, z) <= self.squared_threshold
    }

    #[inline(always)]
    fn gain(&self, x: T, y: T, z: T) -> T {
        T::from_f64(1.0) - self.axis.squared_distance(x, y, z) * self.inverse
    }
}
