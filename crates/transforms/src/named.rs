use crate::{FrameTag, Transform, UncertainTransform};
use nalgebra::Matrix6;

/// A transform together with the ids that its frames have at run time.
///
/// The types tell a camera's frame from a robot's; the ids tell one camera from another. Compare
/// `from` with the id in the camera's own file before using it.
///
/// Its file is JSON of our own schema:
///
/// ```json
/// { "schema": "pomona.transform/1",
///   "to": "base_link",
///   "from": "camera_color_optical_frame",
///   "translation_m": [0.1, -0.2, 1.3],
///   "quaternion_xyzw": [0.5, -0.5, 0.5, -0.5] }
/// ```
///
/// In place of the last two it may give `"matrix": [[…], […], […], [0, 0, 0, 1]]`, the
/// homogeneous matrix row by row, its translation in metres. It may end with the covariance,
/// `"covariance": {"perturbation": "left", "order": "rotation_translation", "matrix": […]}`, six
/// rows of six, with the convention of [`UncertainTransform`]. One that leads to the robot's flange says so,
/// `"to_kind": "flange"`, and is then refused where one to the base is asked for.
///
/// [`AnyTransform`](crate::AnyTransform) reads this form and those of other programs.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedTransform<To: FrameTag, From: FrameTag> {
    /// The transform.
    pub transform: Transform<To, From>,
    /// Id of the frame it leads to.
    pub to: String,
    /// Id of the frame it starts in.
    pub from: String,
    /// Covariance of its error, where it is known, as [`UncertainTransform`] has it: of a left
    /// perturbation, rotation first; rad², rad·m, m².
    pub covariance: Option<Matrix6<f64>>,
}

impl<To: FrameTag, From: FrameTag> NamedTransform<To, From> {
    /// A transform between the frames with these ids.
    pub fn new(
        transform: Transform<To, From>,
        to: impl Into<String>,
        from: impl Into<String>,
    ) -> Self {
        Self {
            transform,
            to: to.into(),
            from: from.into(),
            covariance: None,
        }
    }

    /// The transform back, between the same ids.
    #[must_use]
    pub fn inverse(&self) -> NamedTransform<From, To> {
        NamedTransform {
            transform: self.transform.inverse(),
            to: self.from.clone(),
            from: self.to.clone(),
            covariance: self
                .covariance
                .map(|_| self.uncertain().inverse().covariance),
        }
    }

    /// The transform with its covariance, which is 0 where none is known.
    pub fn uncertain(&self) -> UncertainTransform<To, From> {
        UncertainTransform {
            transform: self.transform,
            covariance: self.covariance.unwrap_or_default(),
        }
    }
}
