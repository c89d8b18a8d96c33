use nalgebra::{Point3, SVector};

/// A shape's local parameters, and how the residuals of points depend on them.
///
/// `N` parameters are all zero at the shape the chart was made for; `R` residual rows belong to
/// one point, and the sum of their squares is the point's squared distance.
pub(crate) trait Chart<const N: usize, const R: usize> {
    /// What is parametrised.
    type Shape: Copy;

    /// Which parameter is the radius, if any is.
    const RADIUS: Option<usize> = None;

    /// The chart about `shape`.
    fn at(shape: &Self::Shape) -> Self;

    /// Residuals of `point` and their derivatives by the parameters; the derivatives of a
    /// point at a singularity (a sphere's centre, a cylinder's axis) that has none are zero.
    fn rows(&self, point: &Point3<f64>) -> ([f64; R], [SVector<f64, N>; R]);

    /// The shape at `step`; `None` where there is none (a radius not positive, say).
    fn stepped(&self, step: &SVector<f64, N>) -> Option<Self::Shape>;

    /// Squared distance of `point` from `shape`.
    fn squared_distance(shape: &Self::Shape, point: &Point3<f64>) -> f64;

    /// The radius of `shape`, zero where it has none.
    fn radius(_shape: &Self::Shape) -> f64 {
        0.0
    }
}
