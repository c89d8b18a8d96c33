//! A X = X B by the logarithms of the rotations.

use super::motions::Motion;
use super::system::nearest_rotation;
use nalgebra::{Isometry3, Matrix3, Translation3, UnitQuaternion, Vector3};
use pomona_transforms::twist;

/// X of motions A X = X B; `None` where they do not determine it.
///
/// The rotation vectors obey α = R β, so that R is the orthogonal factor of Σ α βᵀ, with a
/// determinant of +1 also where two motions leave that matrix at rank 2.
///
/// Source: Park and Martin 1994, "Robot sensor calibration: solving AX = XB on the Euclidean
/// group", IEEE Trans. Robotics and Automation 10(5), Eq. 28 and 29, doi 10.1109/70.326576.
pub(crate) fn solve(motions: &[Motion]) -> Option<Isometry3<f64>> {
    let mut m = Matrix3::zeros();
    for motion in motions {
        let alpha = twist::rotation_vector(&motion.carrier.rotation);
        let beta = twist::rotation_vector(&motion.seen.rotation);
        m += alpha * beta.transpose();
    }
    let rotation = nearest_rotation(&m)?;
    translation(motions, &rotation).map(|t| Isometry3::from_parts(Translation3::from(t), rotation))
}

/// The translation for a rotation: `(R_A − I) t = R t_B − t_A` in the sense of least squares.
pub(crate) fn translation(
    motions: &[Motion],
    rotation: &UnitQuaternion<f64>,
) -> Option<Vector3<f64>> {
    let mut normal = Matrix3::zeros();
    let mut rhs = Vector3::zeros();
    for motion in motions {
        let a = motion.carrier.rotation.to_rotation_matrix().into_inner() - Matrix3::identity();
        let b = rotation * motion.seen.translation.vector - motion.carrier.translation.vector;
        normal += a.transpose() * a;
        rhs += a.transpose() * b;
    }
    let t = normal.cholesky()?.solve(&rhs);
    t.iter().all(|c| c.is_finite()).then_some(t)
}
