use super::kernel::Kernel;
use crate::Coordinate;

/// A way to measure the squared distance of a point from a centre or an axis.
pub(crate) trait Radial<T>: Copy {
    /// The squared distance.
    fn squared_distance(&self, x: T, y: T, z: T) -> T;
}

/// What lies about a radius r from a centre or an axis: a point is held where `low <= d² <= high`.
///
/// Counting needs no square root: |d − r| is at most the threshold t exactly where d² lies between
/// (r − t)², or 0 if t > r, and (r + t)². Floor of counting: 8 operations and two comparisons
/// a point about a centre, 15 and two about an axis, and 12 bytes in f32 (24 in f64); a gain takes a square
/// root and four operations more.
#[derive(Clone, Copy)]
pub(crate) struct Shell<T, R> {
    radial: R,
    radius: T,
    low: T,
    high: T,
    inverse: T,
}

impl<T: Coordinate, R: Radial<T>> Shell<T, R> {
    /// A threshold that is negative or NaN holds nothing.
    pub(crate) fn new(radial: R, radius: f64, threshold: f64) -> Self {
        let (low, high) = if threshold >= 0.0 {
            let inner = radius - threshold;
            (
                if inner > 0.0 { inner * inner } else { 0.0 },
                (radius + threshold).powi(2),
            )
        } else {
            (1.0, -1.0)
        };
        Self {
            radial,
            radius: T::from_f64(radius),
            low: T::from_f64(low),
            high: T::from_f64(high),
            inverse: T::from_f64(1.0 / threshold),
        }
    }
}

impl<T: Coordinate, R: Radial<T>> Kernel<T> for Shell<T, R> {
    #[expect(
        clippy::needless_bitwise_bool,
        reason = "a branch in the inner loop keeps it from being vectorised"
    )]
    #[inline(always)]
    fn holds(&self, x: T, y: T, z: T) -> bool {
        let d2 = self.radial.squared_distance(x, y, z);
        (self.low <= d2) & (d2 <= self.high)
    }

    #[inline(always)]
    fn gain(&self, x: T, y: T, z: T) -> T {
        let distance = self.radial.squared_distance(x, y, z).square_root();
        let fraction = (distance - self.radius) * self.inverse;
        T::from_f64(1.0) - fraction * fraction
    }
}
