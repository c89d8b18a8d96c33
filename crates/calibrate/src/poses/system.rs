//! What one pose sample says about the two unknown transforms.

use nalgebra::{Isometry3, Matrix3, Matrix6, SMatrix, SVector, Vector3, Vector6};
use pomona_transforms::twist;

/// Derivatives of a sample's residual by both unknowns: six for the camera, six for the target.
pub(crate) type Jacobian = SMatrix<f64, 6, 12>;
pub(crate) type Matrix12 = SMatrix<f64, 12, 12>;
pub(crate) type Vector12 = SVector<f64, 12>;

/// One sample, whatever the set-up: C Q = X M.
///
/// X, the answer, is where the camera is on its carrier (the robot's base, or the flange); Q is where the
/// target is on the other part. M = `camera_from_target` was seen, and
/// C = `carrier_from_other` was told by the robot.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PosePair {
    pub(crate) carrier: Isometry3<f64>,
    pub(crate) seen: Isometry3<f64>,
}

/// Both unknowns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PoseSolution {
    /// X, `carrier_from_camera`.
    pub(crate) camera: Isometry3<f64>,
    /// Q, `other_from_target`.
    pub(crate) target: Isometry3<f64>,
}

/// Difference between the predicted and the observed pose of the target, in the camera's frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PoseResidual {
    /// Rotation vector, rad.
    pub(crate) rotation: Vector3<f64>,
    /// m.
    pub(crate) translation: Vector3<f64>,
}

impl PoseResidual {
    /// Squared, in units of the two scales.
    pub(crate) fn squared(&self, scale: &Scale) -> f64 {
        self.rotation.norm_squared() / scale.rotation_rad.powi(2)
            + self.translation.norm_squared() / scale.translation_m.powi(2)
    }
}

/// Sizes of the two parts of an offset: standard deviations, or tolerances.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scale {
    pub(crate) rotation_rad: f64,
    pub(crate) translation_m: f64,
}

impl PoseSolution {
    /// M̂ = X⁻¹ C Q against M.
    pub(crate) fn offset(&self, pair: &PosePair) -> PoseResidual {
        let predicted = self.camera.inv_mul(&(pair.carrier * self.target));
        let turn = predicted.rotation * pair.seen.rotation.inverse();
        PoseResidual {
            rotation: twist::rotation_vector(&turn),
            translation: predicted.translation.vector - pair.seen.translation.vector,
        }
    }

    /// Derivatives of the offset by left perturbations of X and of Q, the rotation first.
    ///
    /// With both perturbed `M̂ = X̂⁻¹ Exp(η) C Q̂`, where `η = Ad(C) ξ_Q − ξ_X`; η = (ω, υ) turns M̂ by
    /// `R_Xᵀ ω` and moves its origin by `R_Xᵀ (ω × t + υ)`, t being that of C Q̂.
    pub(crate) fn jacobian(&self, pair: &PosePair, offset: &PoseResidual) -> Jacobian {
        let into_camera = self
            .camera
            .rotation
            .inverse()
            .to_rotation_matrix()
            .into_inner();
        let place = (pair.carrier * self.target).translation.vector;
        let mut by_eta = Matrix6::zeros();
        by_eta
            .fixed_view_mut::<3, 3>(0, 0)
            .copy_from(&(twist::left_jacobian_inverse(&offset.rotation) * into_camera));
        by_eta
            .fixed_view_mut::<3, 3>(3, 0)
            .copy_from(&(-into_camera * twist::skew(&place)));
        by_eta.fixed_view_mut::<3, 3>(3, 3).copy_from(&into_camera);
        let mut j = Jacobian::zeros();
        j.fixed_view_mut::<6, 6>(0, 0).copy_from(&-by_eta);
        j.fixed_view_mut::<6, 6>(0, 6)
            .copy_from(&(by_eta * twist::adjoint(&pair.carrier)));
        j
    }

    /// The model after a step of both perturbations.
    pub(crate) fn stepped(&self, step: &Vector12) -> Self {
        let part = |at: usize| -> Vector6<f64> { step.fixed_rows::<6>(at).into() };
        let mut stepped = Self {
            camera: twist::exp(&part(0)) * self.camera,
            target: twist::exp(&part(6)) * self.target,
        };
        stepped.camera.rotation.renormalize();
        stepped.target.rotation.renormalize();
        stepped
    }

    pub(crate) fn is_finite(&self) -> bool {
        let finite = |t: &Isometry3<f64>| {
            t.translation.vector.iter().all(|c| c.is_finite())
                && t.rotation.coords.iter().all(|c| c.is_finite())
        };
        finite(&self.camera) && finite(&self.target)
    }
}

/// `JᵀWJ` and `−JᵀWr` of weighted samples, in units of the scale.
pub(crate) fn normal_equations(
    pairs: &[PosePair],
    weights: &[f64],
    model: &PoseSolution,
    scale: &Scale,
) -> (Matrix12, Vector12, f64) {
    let inverse = Vector6::from_fn(|i, _| {
        if i < 3 {
            1.0 / scale.rotation_rad
        } else {
            1.0 / scale.translation_m
        }
    });
    let whiten = Matrix6::from_diagonal(&inverse);
    let mut normal = Matrix12::zeros();
    let mut descent = Vector12::zeros();
    let mut objective = 0.0;
    for (pair, &weight) in pairs.iter().zip(weights) {
        if weight == 0.0 {
            continue;
        }
        let offset = model.offset(pair);
        let j = whiten * model.jacobian(pair, &offset);
        let (a, b) = (offset.rotation, offset.translation);
        let r = whiten * Vector6::new(a.x, a.y, a.z, b.x, b.y, b.z);
        normal += j.transpose() * j * weight;
        descent -= j.transpose() * r * weight;
        objective += weight * r.norm_squared();
    }
    (normal, descent, objective)
}

/// The rotation closest to a matrix that ought to be one, by its polar decomposition; `None`
/// where its two largest singular values do not determine one.
pub(crate) fn nearest_rotation(m: &Matrix3<f64>) -> Option<nalgebra::UnitQuaternion<f64>> {
    if !m.iter().all(|c| c.is_finite()) {
        return None;
    }
    let svd = m.svd(true, true);
    let (u, v_t) = (svd.u?, svd.v_t?);
    if !(svd.singular_values[1] > 1e-9 * svd.singular_values[0]) {
        return None;
    }
    // The least singular direction takes the sign that makes it a rotation (Umeyama 1991).
    let sign = (u * v_t).determinant().signum();
    let fixed = u * Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, sign)) * v_t;
    let rotation = nalgebra::Rotation3::from_matrix_unchecked(fixed);
    Some(nalgebra::UnitQuaternion::new_normalize(
        *nalgebra::UnitQuaternion::from_rotation_matrix(&rotation),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn isometry() -> impl Strategy<Value = Isometry3<f64>> {
        prop::array::uniform6(-1.0..1.0f64).prop_map(|v| twist::exp(&Vector6::from(v)))
    }

    proptest! {
        #[test]
        fn derivatives_are_differences(
            camera in isometry(), target in isometry(), carrier in isometry(), noise in prop::array::uniform6(-0.3..0.3f64),
        ) {
            let model = PoseSolution { camera, target };
            let seen = twist::exp(&Vector6::from(noise)) * camera.inv_mul(&(carrier * target));
            let pair = PosePair { carrier, seen };
            let offset = model.offset(&pair);
            let j = model.jacobian(&pair, &offset);
            for k in 0..12 {
                let h = 1e-6;
                let mut step = Vector12::zeros();
                step[k] = h;
                let (a, b) = (model.stepped(&step).offset(&pair), model.stepped(&-step).offset(&pair));
                for i in 0..3 {
                    prop_assert!(((a.rotation - b.rotation)[i] / (2.0 * h) - j[(i, k)]).abs() < 1e-6);
                    prop_assert!(((a.translation - b.translation)[i] / (2.0 * h) - j[(i + 3, k)]).abs() < 1e-6);
                }
            }
        }
    }
}
