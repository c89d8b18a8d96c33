use crate::{CovarianceError, Direction, FrameTag, Position, Transform, twist};
use nalgebra::{Matrix3, Matrix6, Vector3};
use std::ops::Mul;

/// How far from symmetric a covariance may be, as a share of its largest entry.
const SYMMETRY: f64 = 1e-9;

/// A transform with the covariance of its error.
///
/// **Convention.** The true transform is T = Exp(ξ) T̂, T̂ the stored one: a perturbation from the *left*,
/// in the axes of `To` and about its origin. The twist ξ = (ω, υ) has the *rotation first*:
/// ω in radians, υ in metres; so the 6×6 covariance has rad² above left, m² below right and
/// rad·m beside. υ is what the error moves at the origin of `To`; the error of the translation
/// itself, at the origin of `From`, is [`translation_covariance_m2`](Self::translation_covariance_m2).
///
/// All propagation is of first order (Barfoot and Furgale 2014, doi
/// 10.1109/TRO.2014.2298059, Section IV), which for angles of a degree errs by less than
/// a per cent, and takes what is joined for independent.
///
/// ```
/// use nalgebra::{Matrix6, Point3};
/// use pomona_transforms::{CameraFrame, Position, RobotFrame, Transform, UncertainTransform};
///
/// let robot_from_camera =
///     Transform::<RobotFrame, CameraFrame>::from_quaternion([0.0, 0.0, 0.5], [0.5, -0.5, 0.5, -0.5])?;
/// // A tenth of a degree about each axis, and nothing else.
/// let mut covariance = Matrix6::zeros();
/// covariance.fill_diagonal(0.1_f64.to_radians().powi(2));
/// covariance.fixed_view_mut::<3, 3>(3, 3).fill(0.0);
/// let robot_from_camera = UncertainTransform::new(robot_from_camera, covariance)?;
/// let apple = Position::new(Point3::new(0.0, 0.0, 1.0)).into();
/// let apple = robot_from_camera.position(&apple);
/// // 1.7 mm for each metre across, nothing along the way there.
/// assert!((apple.covariance_m2[(1, 1)].sqrt() - 1.95e-3).abs() < 1e-4);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// Frames meet here too, or it does not compile:
///
/// ```compile_fail,E0308
/// use pomona_transforms::{CameraFrame, FlangeFrame, RobotFrame, UncertainTransform};
///
/// fn chain(
///     robot_from_flange: UncertainTransform<RobotFrame, FlangeFrame>,
///     robot_from_camera: UncertainTransform<RobotFrame, CameraFrame>,
/// ) {
///     let _ = robot_from_flange * robot_from_camera;
/// }
/// ```
///
/// ```compile_fail,E0308
/// use pomona_transforms::{CameraFrame, RobotFrame, UncertainDirection, UncertainTransform};
///
/// fn turn(
///     robot_from_camera: UncertainTransform<RobotFrame, CameraFrame>,
///     upwards: UncertainDirection<CameraFrame>,
/// ) {
///     robot_from_camera.position(&upwards);
/// }
/// ```
pub struct UncertainTransform<To: FrameTag, From: FrameTag> {
    /// The transform.
    pub transform: Transform<To, From>,
    /// Covariance of ξ = (ω, υ) in the axes of `To`: rad², rad·m, m².
    pub covariance: Matrix6<f64>,
}

/// A position with the covariance of its error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UncertainPosition<F: FrameTag> {
    /// The position.
    pub position: Position<F>,
    /// Its covariance in the axes of `F`, in m².
    pub covariance_m2: Matrix3<f64>,
}

/// A direction with the covariance of its error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UncertainDirection<F: FrameTag> {
    /// The direction.
    pub direction: Direction<F>,
    /// Covariance of the unit vector's components in the axes of `F`, in rad². The direction itself
    /// is in its null space: a unit vector errs across itself only.
    pub covariance_rad2: Matrix3<f64>,
}

impl<To: FrameTag, From: FrameTag> UncertainTransform<To, From> {
    /// A transform with a covariance in the convention of [`UncertainTransform`].
    ///
    /// # Errors
    ///
    /// [`CovarianceError`] for a matrix that is not a covariance: not finite, not symmetric, with a negative
    /// variance.
    pub fn new(
        transform: Transform<To, From>,
        covariance: Matrix6<f64>,
    ) -> Result<Self, CovarianceError> {
        check(&covariance)?;
        Ok(Self {
            transform,
            covariance,
        })
    }

    /// A transform that is taken as exact.
    pub fn exact(transform: Transform<To, From>) -> Self {
        Self {
            transform,
            covariance: Matrix6::zeros(),
        }
    }

    /// The transform back: T⁻¹ = Exp(−Ad(T̂⁻¹) ξ) T̂⁻¹.
    #[must_use]
    pub fn inverse(&self) -> UncertainTransform<From, To> {
        let transform = self.transform.inverse();
        let ad = twist::adjoint(&transform.isometry());
        UncertainTransform {
            transform,
            covariance: symmetric(&(ad * self.covariance * ad.transpose())),
        }
    }

    /// A position in `To`: R Σ Rᵀ of its own error, and from the transform's the covariance of
    /// ω × p + υ, p being the place in `To`.
    pub fn position(&self, position: &UncertainPosition<From>) -> UncertainPosition<To> {
        let moved = self.transform.position(&position.position);
        let r = self.rotation();
        UncertainPosition {
            position: moved,
            covariance_m2: symmetric3(
                r * position.covariance_m2 * r.transpose() + self.at(&moved.point().coords),
            ),
        }
    }

    /// A direction in `To`: R Σ Rᵀ of its own error, and from the transform's the covariance of ω × d.
    pub fn direction(&self, direction: &UncertainDirection<From>) -> UncertainDirection<To> {
        let turned = self.transform.direction(&direction.direction);
        let r = self.rotation();
        let across = twist::skew(&turned.vector());
        let omega: Matrix3<f64> = self.covariance.fixed_view::<3, 3>(0, 0).into();
        UncertainDirection {
            direction: turned,
            covariance_rad2: symmetric3(
                r * direction.covariance_rad2 * r.transpose() + across * omega * across.transpose(),
            ),
        }
    }

    /// Covariance of the rotation vector ω, in rad², in the axes of `To`.
    pub fn rotation_covariance_rad2(&self) -> Matrix3<f64> {
        self.covariance.fixed_view::<3, 3>(0, 0).into()
    }

    /// Covariance of the translation, that is of the place of `From`'s origin, in m², in the axes of `To`.
    pub fn translation_covariance_m2(&self) -> Matrix3<f64> {
        symmetric3(self.at(&self.transform.translation_m()))
    }

    fn rotation(&self) -> Matrix3<f64> {
        self.transform.rotation().to_rotation_matrix().into_inner()
    }

    /// What the transform's error adds at the place `p` of `To`: `J Σ Jᵀ` with `J = [−[p]× I]`.
    fn at(&self, p: &Vector3<f64>) -> Matrix3<f64> {
        let mut j = nalgebra::Matrix3x6::zeros();
        j.fixed_view_mut::<3, 3>(0, 0).copy_from(&-twist::skew(p));
        j.fixed_view_mut::<3, 3>(0, 3)
            .copy_from(&Matrix3::identity());
        j * self.covariance * j.transpose()
    }
}

/// First the right one, then the left one: Σ = Σₗ + Ad(T̂ₗ) Σᵣ Ad(T̂ₗ)ᵀ, their errors being independent.
impl<A: FrameTag, B: FrameTag, C: FrameTag> Mul<UncertainTransform<B, C>>
    for UncertainTransform<A, B>
{
    type Output = UncertainTransform<A, C>;

    fn mul(self, right: UncertainTransform<B, C>) -> UncertainTransform<A, C> {
        let ad = twist::adjoint(&self.transform.isometry());
        UncertainTransform {
            transform: self.transform * right.transform,
            covariance: symmetric(&(self.covariance + ad * right.covariance * ad.transpose())),
        }
    }
}

/// A position that is taken as exact.
impl<F: FrameTag> From<Position<F>> for UncertainPosition<F> {
    fn from(position: Position<F>) -> Self {
        Self {
            position,
            covariance_m2: Matrix3::zeros(),
        }
    }
}

/// A direction that is taken as exact.
impl<F: FrameTag> From<Direction<F>> for UncertainDirection<F> {
    fn from(direction: Direction<F>) -> Self {
        Self {
            direction,
            covariance_rad2: Matrix3::zeros(),
        }
    }
}

pub(crate) fn check(covariance: &Matrix6<f64>) -> Result<(), CovarianceError> {
    if !covariance.iter().all(|c| c.is_finite()) {
        return Err(CovarianceError::NotFinite);
    }
    let largest = covariance.amax();
    let asymmetry = (covariance - covariance.transpose()).amax();
    if asymmetry > SYMMETRY * largest {
        return Err(CovarianceError::NotSymmetric { asymmetry });
    }
    // Radians and metres differ in size: only scaled to a unit diagonal are the eigenvalues comparable.
    let deviation = covariance.diagonal().map(|v| v.max(0.0).sqrt());
    if let Some(&variance) = covariance.diagonal().iter().find(|v| **v < 0.0) {
        return Err(CovarianceError::NegativeVariance { variance });
    }
    let correlation = Matrix6::from_fn(|i, j| {
        let scale = deviation[i] * deviation[j];
        if scale > 0.0 {
            covariance[(i, j)] / scale
        } else {
            covariance[(i, j)]
        }
    });
    let least = correlation.symmetric_eigenvalues().min();
    if !(least >= -1e-6) {
        return Err(CovarianceError::NegativeVariance { variance: least });
    }
    Ok(())
}

fn symmetric(m: &Matrix6<f64>) -> Matrix6<f64> {
    (m + m.transpose()) * 0.5
}

fn symmetric3(m: Matrix3<f64>) -> Matrix3<f64> {
    (m + m.transpose()) * 0.5
}

// By hand: derived implementations would require the same traits of the frame tags.
impl<To: FrameTag, From: FrameTag> Clone for UncertainTransform<To, From> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<To: FrameTag, From: FrameTag> Copy for UncertainTransform<To, From> {}

impl<To: FrameTag, From: FrameTag> PartialEq for UncertainTransform<To, From> {
    fn eq(&self, other: &Self) -> bool {
        self.transform == other.transform && self.covariance == other.covariance
    }
}

impl<To: FrameTag, From: FrameTag> std::fmt::Debug for UncertainTransform<To, From> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("UncertainTransform")
            .field("transform", &self.transform)
            .field("covariance", &self.covariance)
            .finish()
    }
}
