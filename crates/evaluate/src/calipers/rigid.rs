use nalgebra::{Isometry3, Matrix3, Point3, Rotation3, Translation3, UnitQuaternion};

/// The rotation and translation that bring `from` nearest to `to` in the least-squares sense.
///
/// `None` for fewer than three points, and where they lie on a line.
///
/// Kabsch 1976, Acta Cryst. A32, 922–923, with the sign correction of Umeyama 1991, IEEE PAMI 13(4), eq. 40.
pub(super) fn align(from: &[Point3<f64>], to: &[Point3<f64>]) -> Option<Isometry3<f64>> {
    let n = from.len().min(to.len());
    if n < 3 {
        return None;
    }
    let center = |points: &[Point3<f64>]| {
        points[..n]
            .iter()
            .map(|p| p.coords)
            .sum::<nalgebra::Vector3<f64>>()
            / n as f64
    };
    let (a, b) = (center(from), center(to));
    let mut covariance = Matrix3::zeros();
    for (p, q) in from.iter().zip(to) {
        covariance += (q.coords - b) * (p.coords - a).transpose();
    }
    let svd = covariance.try_svd(true, true, f64::EPSILON, 100)?;
    let (u, v_t) = (svd.u?, svd.v_t?);
    let mut values = svd.singular_values;
    values.as_mut_slice().sort_by(|x, y| y.total_cmp(x));
    // Points on a line leave the turn about it open.
    if !(values[1] > 1e-9 * values[0]) {
        return None;
    }
    let mut flip = Matrix3::identity();
    if (u * v_t).determinant() < 0.0 {
        let weakest = svd.singular_values.imin();
        flip[(weakest, weakest)] = -1.0;
    }
    let rotation = Rotation3::from_matrix_unchecked(u * flip * v_t);
    let translation = Translation3::from(b - rotation * a);
    Some(Isometry3::from_parts(
        translation,
        UnitQuaternion::from_rotation_matrix(&rotation),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;
    use proptest::prelude::*;

    fn points() -> impl Strategy<Value = Vec<Point3<f64>>> {
        let point = prop::array::uniform3(-1.0..1.0f64).prop_map(Point3::from);
        prop::collection::vec(point, 4..9)
    }

    proptest! {
        #[test]
        fn a_rigid_motion_is_found_again(
            from in points(), axis in prop::array::uniform3(-3.0..3.0f64), shift in prop::array::uniform3(-2.0..2.0f64),
        ) {
            let motion = Isometry3::new(Vector3::from(shift), Vector3::from(axis));
            let to: Vec<_> = from.iter().map(|p| motion * p).collect();
            let found = align(&from, &to);
            prop_assume!(found.is_some());
            let found = found.unwrap();
            for (p, q) in from.iter().zip(&to) {
                prop_assert!((found * p - q).norm() < 1e-6);
            }
        }
    }

    #[test]
    fn points_on_a_line_and_too_few_are_refused() {
        let line: Vec<_> = (0..5)
            .map(|i| Point3::new(f64::from(i), 0.0, 0.0))
            .collect();
        assert!(align(&line, &line).is_none());
        assert!(align(&line[..2], &line[..2]).is_none());
    }

    #[test]
    fn three_points_and_a_mirrored_set_give_a_rotation() {
        let from = [
            Point3::origin(),
            Point3::new(1.0, 0.0, 0.0),
            Point3::new(0.0, 1.0, 0.0),
        ];
        let to = [
            Point3::origin(),
            Point3::new(0.0, 1.0, 0.0),
            Point3::new(1.0, 0.0, 0.0),
        ];
        let found = align(&from, &to).unwrap();
        assert!((found.rotation.to_rotation_matrix().matrix().determinant() - 1.0).abs() < 1e-12);
        assert!((found * from[1] - to[1]).norm() < 1e-12);
    }
}
