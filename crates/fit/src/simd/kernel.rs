/// A shape made ready to be compared with points at one threshold.
pub(crate) trait Kernel<T>: Copy {
    /// Whether a point lies within the threshold; never where something is NaN.
    fn holds(&self, x: T, y: T, z: T) -> bool;

    /// 1 − (residual/threshold)² of a point; above zero only by rounding where it does not hold, and
    /// then it is not used.
    fn gain(&self, x: T, y: T, z: T) -> T;
}
