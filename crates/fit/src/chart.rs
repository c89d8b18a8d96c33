use nalgebra::{Point3, SVector};
use pomona_ransac::Linearization;

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

/// Pushes a point's residuals and their derivatives by the parameters of `shape`'s chart.
pub(crate) fn linearize<C: Chart<N, R>, const N: usize, const R: usize>(
    shape: &C::Shape,
    point: &Point3<f64>,
    rows: &mut Linearization,
) {
    let (residuals, gradients) = C::at(shape).rows(point);
    for (residual, gradient) in residuals.iter().zip(&gradients) {
        rows.push(*residual, gradient.as_slice());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::circle::CircleChart;
    use crate::cylinder::CylinderChart;
    use crate::line::LineChart;
    use crate::plane::PlaneChart;
    use crate::sphere::SphereChart;
    use nalgebra::{Unit, Vector3};
    use pomona_geometry::{Circle, Cylinder, Line, Plane, Sphere};
    use proptest::prelude::*;

    /// Rows against differences of the residuals, and against the squared distance.
    fn check<C: Chart<N, R>, const N: usize, const R: usize>(
        shape: &C::Shape,
        point: &Point3<f64>,
        residuals: impl Fn(&C::Shape, &C, &Point3<f64>) -> [f64; R],
    ) -> Result<(), TestCaseError> {
        const H: f64 = 1e-6;
        let chart = C::at(shape);
        let (values, rows) = chart.rows(point);
        let squares: f64 = values.iter().map(|v| v * v).sum();
        prop_assert!((squares - C::squared_distance(shape, point)).abs() < 1e-9);
        for k in 0..N {
            let mut step = SVector::zeros();
            step[k] = H;
            let (Some(after), Some(before)) = (chart.stepped(&step), chart.stepped(&-step)) else {
                continue;
            };
            let after = residuals(&after, &chart, point);
            let before = residuals(&before, &chart, point);
            for row in 0..R {
                let slope = (after[row] - before[row]) / (2.0 * H);
                prop_assert!(
                    (slope - rows[row][k]).abs() < 1e-6,
                    "row {row}, parameter {k}: {slope}, {}",
                    rows[row][k]
                );
            }
        }
        Ok(())
    }

    proptest! {
        #[test]
        fn rows_are_the_derivatives(
            p in prop::array::uniform3(-2.0..2.0f64), d in prop::array::uniform3(-1.0..1.0f64),
            o in prop::array::uniform3(-1.0..1.0f64), r in 0.1..1.0f64,
        ) {
            let (p, d, o) = (Point3::from(p), Vector3::from(d), Point3::from(o));
            prop_assume!(d.norm() > 0.1 && (p - o).norm() > 0.1);
            let d = Unit::new_normalize(d);
            prop_assume!((p - o).cross(&d).norm() > 0.1);
            let line = Line::new(o, d.into_inner()).unwrap();
            let one = |c: f64| [c];
            check::<SphereChart, 4, 1>(&Sphere::new(o, r).unwrap(), &p, |s, _, p| one(s.signed_distance(p)))?;
            check::<CylinderChart, 5, 1>(&Cylinder::new(line, r).unwrap(), &p, |s, _, p| one(s.signed_distance(p)))?;
            check::<PlaneChart, 3, 1>(&Plane::new(o, d.into_inner()).unwrap(), &p, |s, _, p| one(s.signed_distance(p)))?;
            let [u, v] = pomona_geometry::across(&d);
            check::<LineChart, 4, 2>(&line, &p, |s, _, p| {
                let off = p - s.foot(p);
                [off.dot(&u), off.dot(&v)]
            })?;
            check::<CircleChart, 6, 2>(&Circle::new(o, d.into_inner(), r).unwrap(), &p, |s, _, p| {
                let w = p - s.center;
                [w.cross(&s.normal).norm() - s.radius, w.dot(&s.normal)]
            })?;
        }
    }
}
