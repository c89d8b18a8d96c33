use crate::TransformError;
use nalgebra::{Isometry3, Matrix3, Matrix4, RowVector4, Translation3, UnitQuaternion};

/// How far a singular value of the rotation's part may be from 1.
const ORTHONORMAL_TOLERANCE: f64 = 1e-3;

/// How far a number of the last row may be from 0 0 0 1: the rounding of printed digits.
const LAST_ROW_TOLERANCE: f64 = 1e-6;

/// The rigid transform of a homogeneous matrix whose rotation may be rounded.
pub(crate) fn to_isometry(
    matrix: &Matrix4<f64>,
    field: &'static str,
) -> Result<Isometry3<f64>, TransformError> {
    if !matrix.iter().all(|c| c.is_finite()) {
        return Err(TransformError::NotFinite { field });
    }
    let last = matrix.row(3).into_owned();
    if (last - RowVector4::new(0.0, 0.0, 0.0, 1.0)).amax() > LAST_ROW_TOLERANCE {
        return Err(TransformError::LastRow {
            field,
            row: [last[0], last[1], last[2], last[3]],
        });
    }
    let rotation = nearest_rotation(&matrix.fixed_view::<3, 3>(0, 0).into_owned(), field)?;
    let translation = Translation3::from(matrix.fixed_view::<3, 1>(0, 3).into_owned());
    Ok(Isometry3::from_parts(translation, rotation))
}

/// The rotation nearest to `m` in the Frobenius norm: with the singular value decomposition
/// m = U Σ Vᵀ it is U Vᵀ (Higham 1986, doi 10.1137/0907079, Section 2).
///
/// The largest |σ − 1| is the distance from `m` to it, in the spectral norm.
fn nearest_rotation(
    m: &Matrix3<f64>,
    field: &'static str,
) -> Result<UnitQuaternion<f64>, TransformError> {
    // No entry of a matrix exceeds its largest singular value; and squares of huge ones, which
    // the decomposition takes, would leave the range of f64.
    if m.amax() > 2.0 {
        return Err(TransformError::NotOrthonormal {
            field,
            deviation: m.amax() - 1.0,
        });
    }
    let svd = m.svd(true, true);
    let deviation = svd
        .singular_values
        .iter()
        .map(|s| (s - 1.0).abs())
        .fold(0.0, f64::max);
    let (Some(u), Some(v_t), true) = (svd.u, svd.v_t, deviation <= ORTHONORMAL_TOLERANCE) else {
        return Err(TransformError::NotOrthonormal { field, deviation });
    };
    let orthonormal = u * v_t;
    if orthonormal.determinant() < 0.0 {
        return Err(TransformError::LeftHanded { field });
    }
    let rotation = nalgebra::Rotation3::from_matrix_unchecked(orthonormal);
    Ok(UnitQuaternion::new_normalize(
        *UnitQuaternion::from_rotation_matrix(&rotation),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn refusal(m: [f64; 9]) -> TransformError {
        nearest_rotation(&Matrix3::from_row_slice(&m), "matrix").unwrap_err()
    }

    #[test]
    fn refuses_what_is_no_rotation() {
        let mirror = refusal([1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, -1.0]);
        assert!(
            matches!(mirror, TransformError::LeftHanded { .. }),
            "{mirror}"
        );
        for (m, least) in [
            ([0.0; 9], 1.0),
            ([1e300; 9], 1e300),
            ([1.0, 0.01, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0], 4e-3),
            ([0.5, 0.0, 0.0, 0.0, 0.5, 0.0, 0.0, 0.0, 0.5], 0.5),
        ] {
            match refusal(m) {
                TransformError::NotOrthonormal { deviation, .. } => {
                    assert!(deviation >= 0.99 * least);
                }
                other => panic!("{other}"),
            }
        }
    }

    proptest! {
        // The polar decomposition is unique: R is nearest where Rᵀ M is symmetric and positive.
        #[test]
        fn the_nearest_rotation_leaves_a_symmetric_rest(
            axis_angle in prop::array::uniform3(-3.0..3.0f64),
            noise in prop::array::uniform9(-2e-4..2e-4f64),
        ) {
            let exact = UnitQuaternion::from_scaled_axis(axis_angle.into());
            let m = exact.to_rotation_matrix().into_inner() + Matrix3::from_row_slice(&noise);
            let r = nearest_rotation(&m, "matrix").unwrap().to_rotation_matrix().into_inner();
            prop_assert!((r.transpose() * r - Matrix3::identity()).amax() < 1e-14);
            let rest = r.transpose() * m;
            prop_assert!((rest - rest.transpose()).amax() < 1e-12, "{rest}");
            prop_assert!((rest - Matrix3::identity()).amax() < 1e-3);
        }
    }
}
