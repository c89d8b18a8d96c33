//! The similarity between two sets of points.

use nalgebra::{Isometry3, Matrix3, Point3, Rotation3, Translation3, UnitQuaternion, Vector3};

/// y = s R x + t; the rigid transform is that of R and t.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Similarity {
    pub(crate) scale: f64,
    pub(crate) isometry: Isometry3<f64>,
}

impl Similarity {
    pub(crate) fn apply(&self, p: &Point3<f64>) -> Point3<f64> {
        self.isometry * (p * self.scale)
    }
}

/// A pair of points with its weight.
pub(crate) type WeightedPair = (Point3<f64>, Point3<f64>, f64);

/// The least weighted squares of y − (s R x + t); s = 1 unless `free_scale`. `None` where the points are fewer than
/// three, lie on a line, or are not finite.
///
/// R is the rotation, not the reflection, that fits best, also where the points lie in a plane.
///
/// Source: Kabsch 1976, doi 10.1107/S0567739476001873; Umeyama 1991, "Least-squares estimation of
/// transformation parameters between two point patterns", IEEE PAMI 13(4), Eq. 39–42, doi 10.1109/34.88573.
pub(crate) fn fit(
    pairs: impl Iterator<Item = WeightedPair> + Clone,
    free_scale: bool,
) -> Option<Similarity> {
    let total: f64 = pairs.clone().map(|(.., w)| w).sum();
    let mean = |f: &dyn Fn(&WeightedPair) -> Vector3<f64>| {
        pairs.clone().map(|p| f(&p) * p.2).sum::<Vector3<f64>>() / total
    };
    let (x_mean, y_mean) = (mean(&|p| p.0.coords), mean(&|p| p.1.coords));
    let mut covariance = Matrix3::zeros();
    let mut variance = 0.0;
    for (x, y, w) in pairs {
        let (x, y) = (x.coords - x_mean, y.coords - y_mean);
        covariance += y * x.transpose() * (w / total);
        variance += w / total * x.norm_squared();
    }
    if !covariance.iter().all(|c| c.is_finite()) {
        return None;
    }
    let svd = covariance.svd(true, true);
    let (u, v_t, s) = (svd.u?, svd.v_t?, svd.singular_values);
    // On a line the turn about it is free; the singular values are products of two extents.
    if !(s[1] > 1e-9 * s[0]) || !(s[0] > 0.0) {
        return None;
    }
    let sign = (u * v_t).determinant().signum();
    let rotation = u * Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, sign)) * v_t;
    let rotation =
        UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(rotation));
    let rotation = UnitQuaternion::new_normalize(*rotation);
    let scale = if free_scale {
        (s[0] + s[1] + sign * s[2]) / variance
    } else {
        1.0
    };
    let translation = y_mean - rotation * (x_mean * scale);
    let finite = scale.is_finite() && translation.iter().all(|c| c.is_finite());
    finite.then(|| Similarity {
        scale,
        isometry: Isometry3::from_parts(Translation3::from(translation), rotation),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn an_exact_similarity_comes_back(
            xyz in prop::collection::vec(prop::array::uniform3(-1.0..1.0f64), 4..9),
            axis_angle in prop::array::uniform3(-2.0..2.0f64),
            t in prop::array::uniform3(-2.0..2.0f64),
            scale in 0.2..5.0f64,
        ) {
            let truth = Similarity {
                scale,
                isometry: Isometry3::from_parts(Translation3::from(t), UnitQuaternion::from_scaled_axis(axis_angle.into())),
            };
            let points: Vec<Point3<f64>> = xyz.into_iter().map(Point3::from).collect();
            let pairs = points.iter().map(|p| (*p, truth.apply(p), 1.0));
            let Some(found) = fit(pairs, true) else { return Ok(()); };
            for p in &points {
                prop_assert!((found.apply(p) - truth.apply(p)).norm() < 1e-7);
            }
        }
    }

    #[test]
    fn a_line_determines_nothing() {
        let line = (0..5).map(|i| Point3::new(f64::from(i), 2.0 * f64::from(i), 0.3));
        assert!(fit(line.map(|p| (p, p, 1.0)), false).is_none());
        let one = std::iter::repeat_n((Point3::origin(), Point3::origin(), 1.0), 4);
        assert!(fit(one, true).is_none());
    }

    #[test]
    fn a_plane_is_turned_and_not_mirrored() {
        let plane = [(0.0, 0.0), (1.0, 0.0), (0.0, 2.0), (1.5, 1.0)];
        let pairs = plane.map(|(x, y)| (Point3::new(x, y, 0.0), Point3::new(-x, y, 0.0), 1.0));
        let found = fit(pairs.into_iter(), false).unwrap();
        for (x, y, _) in pairs {
            assert!((found.apply(&x) - y).norm() < 1e-12);
        }
    }
}
