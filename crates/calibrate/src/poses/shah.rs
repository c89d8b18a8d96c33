//! A X = Z B: both unknowns at once, from the poses themselves and not from motions.

use super::system::{PosePair, PoseSolution, nearest_rotation};
use nalgebra::{Isometry3, Matrix3, SMatrix, SVector, Translation3, Vector3};

type Matrix9 = SMatrix<f64, 9, 9>;
type Vector9 = SVector<f64, 9>;

/// Both unknowns of C Q = X M; `None` where the samples do not determine them.
///
/// `R_C R_Q R_Mᵀ = R_X` for all samples, so that `vec R_X` and `vec R_Q` are the left and right singular
/// vectors of `Σ R_M ⊗ R_C` for its largest singular value; the translations then follow from
/// linear equations.
///
/// Source: Shah 2013, "Solving the robot-world/hand-eye calibration problem using the Kronecker
/// product", J. Mechanisms and Robotics 5(3), doi 10.1115/1.4024473, section 3.
pub(crate) fn solve(pairs: &[PosePair]) -> Option<PoseSolution> {
    let mut k = Matrix9::zeros();
    for pair in pairs {
        let c = pair.carrier.rotation.to_rotation_matrix().into_inner();
        let m = pair.seen.rotation.to_rotation_matrix().into_inner();
        k += m.kronecker(&c);
    }
    if !k.iter().all(|v| v.is_finite()) {
        return None;
    }
    let svd = k.svd(true, true);
    let largest = svd.singular_values.imax();
    let mut sorted: Vec<f64> = svd.singular_values.iter().copied().collect();
    sorted.sort_by(f64::total_cmp);
    // Rotations about one axis make the largest singular value threefold.
    if !(sorted[7] < (1.0 - 1e-6) * sorted[8]) {
        return None;
    }
    let (u, v_t) = (svd.u?, svd.v_t?);
    let rotation = |vector: Vector9| {
        let m = Matrix3::from_column_slice(vector.as_slice());
        nearest_rotation(&(m * m.determinant().signum()))
    };
    let camera = rotation(u.column(largest).into())?;
    let target = rotation(v_t.row(largest).transpose())?;
    translations(pairs, &camera, &target)
}

/// `R_C t_Q − t_X = R_X t_M − t_C` in the sense of least squares.
fn translations(
    pairs: &[PosePair],
    camera: &nalgebra::UnitQuaternion<f64>,
    target: &nalgebra::UnitQuaternion<f64>,
) -> Option<PoseSolution> {
    let mut normal = SMatrix::<f64, 6, 6>::zeros();
    let mut rhs = SVector::<f64, 6>::zeros();
    for pair in pairs {
        let mut row = SMatrix::<f64, 3, 6>::zeros();
        let c = pair.carrier.rotation.to_rotation_matrix().into_inner();
        row.fixed_view_mut::<3, 3>(0, 0).copy_from(&c);
        row.fixed_view_mut::<3, 3>(0, 3)
            .copy_from(&-Matrix3::identity());
        let right: Vector3<f64> =
            camera * pair.seen.translation.vector - pair.carrier.translation.vector;
        normal += row.transpose() * row;
        rhs += row.transpose() * right;
    }
    let t = normal.cholesky()?.solve(&rhs);
    let place = |at: usize, rotation: &nalgebra::UnitQuaternion<f64>| {
        let t: Vector3<f64> = t.fixed_rows::<3>(at).into();
        Isometry3::from_parts(Translation3::from(t), *rotation)
    };
    let model = PoseSolution {
        camera: place(3, camera),
        target: place(0, target),
    };
    model.is_finite().then_some(model)
}
