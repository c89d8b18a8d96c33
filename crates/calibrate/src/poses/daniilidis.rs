//! A X = X B by dual quaternions: rotation and translation at once.

use super::motions::Motion;
use nalgebra::{DMatrix, Isometry3, Quaternion, SVector, Translation3, UnitQuaternion, Vector3};
use pomona_transforms::twist;

type Vector8 = SVector<f64, 8>;

/// A rigid transform as a dual quaternion q + ε q′ with q′ = ½ t q.
fn dual(isometry: &Isometry3<f64>) -> (Quaternion<f64>, Quaternion<f64>) {
    let q = *isometry.rotation.quaternion();
    // One sign of two on both sides, so that their scalar parts agree.
    let q = if q.w < 0.0 { -q } else { q };
    let t = Quaternion::from_imag(isometry.translation.vector);
    (q, t * q * 0.5)
}

/// X of motions A X = X B; `None` where they do not determine it.
///
/// Each motion gives six equations S (q, q′) = 0 for the eight numbers of X; two right singular
/// vectors span the solutions, and the combination of them that is a unit dual quaternion
/// follows from a quadratic equation.
///
/// Source: Daniilidis 1999, "Hand-eye calibration using dual quaternions", Int. J. Robotics
/// Research 18(3), Eq. 31–37, doi 10.1177/02783649922066213.
pub(crate) fn solve(motions: &[Motion]) -> Option<Isometry3<f64>> {
    // Six rows each, and two of zeros in case of one motion alone.
    let mut t = DMatrix::<f64>::zeros((6 * motions.len()).max(8), 8);
    for (k, motion) in motions.iter().enumerate() {
        let (a, a_dual) = dual(&motion.carrier);
        let (b, b_dual) = dual(&motion.seen);
        let (minus, plus) = (a.imag() - b.imag(), twist::skew(&(a.imag() + b.imag())));
        let (minus_dual, plus_dual) = (
            a_dual.imag() - b_dual.imag(),
            twist::skew(&(a_dual.imag() + b_dual.imag())),
        );
        let row = 6 * k;
        t.fixed_view_mut::<3, 1>(row, 0).copy_from(&minus);
        t.fixed_view_mut::<3, 3>(row, 1).copy_from(&plus);
        t.fixed_view_mut::<3, 1>(row + 3, 0).copy_from(&minus_dual);
        t.fixed_view_mut::<3, 3>(row + 3, 1).copy_from(&plus_dual);
        t.fixed_view_mut::<3, 1>(row + 3, 4).copy_from(&minus);
        t.fixed_view_mut::<3, 3>(row + 3, 5).copy_from(&plus);
    }
    if !t.iter().all(|c| c.is_finite()) {
        return None;
    }
    // The singular vectors of the two least singular values are eigenvectors of TᵀT.
    let eigen = (t.transpose() * &t).symmetric_eigen();
    let mut order: Vec<usize> = (0..8).collect();
    order.sort_by(|&i, &j| eigen.eigenvalues[i].total_cmp(&eigen.eigenvalues[j]));
    let column =
        |k: usize| -> Vector8 { Vector8::from_fn(|i, _| eigen.eigenvectors[(i, order[k])]) };
    // A third one as small: the axes are parallel.
    if !(eigen.eigenvalues[order[2]] > 1e-14 * eigen.eigenvalues[order[7]]) {
        return None;
    }
    combination(&column(0), &column(1))
}

/// λ₁ v₁ + λ₂ v₂ with |q| = 1 and q · q′ = 0.
fn combination(v1: &Vector8, v2: &Vector8) -> Option<Isometry3<f64>> {
    let (u1, u2) = (v1.fixed_rows::<4>(0), v2.fixed_rows::<4>(0));
    let (w1, w2) = (v1.fixed_rows::<4>(4), v2.fixed_rows::<4>(4));
    // u₁·w₁ s² + (u₁·w₂ + u₂·w₁) s + u₂·w₂ = 0 with s = λ₁/λ₂, written for the pair itself.
    let (a, b, c) = (u1.dot(&w1), u1.dot(&w2) + u2.dot(&w1), u2.dot(&w2));
    let root = (b * b - 4.0 * a * c).max(0.0).sqrt();
    let half = -0.5 * (b + root.copysign(b));
    let candidates = [(half, a), (c, half)];
    let norm = |(l1, l2): (f64, f64)| (u1 * l1 + u2 * l2).norm_squared();
    let best = candidates
        .into_iter()
        .filter_map(|(l1, l2)| {
            let size = l1.hypot(l2);
            (size > 0.0).then(|| (l1 / size, l2 / size))
        })
        .max_by(|x, y| norm(*x).total_cmp(&norm(*y)))?;
    let scale = 1.0 / norm(best).sqrt();
    let q = (u1 * best.0 + u2 * best.1) * scale;
    let d = (w1 * best.0 + w2 * best.1) * scale;
    if !q.iter().chain(d.iter()).all(|c| c.is_finite()) {
        return None;
    }
    let rotation = Quaternion::new(q[0], q[1], q[2], q[3]);
    let dual = Quaternion::new(d[0], d[1], d[2], d[3]);
    let t: Vector3<f64> = (dual * rotation.conjugate() * 2.0).imag();
    Some(Isometry3::from_parts(
        Translation3::from(t),
        UnitQuaternion::new_normalize(rotation),
    ))
}
