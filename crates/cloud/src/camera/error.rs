use thiserror::Error;

/// Why a camera cannot be computed with.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum CameraError {
    /// A number that must be finite and positive is not.
    #[error(
        "camera field `{field}` is {value} but must be finite and positive; calibrate the camera, or copy its intrinsics again"
    )]
    NotPositive {
        /// Name of the field.
        field: &'static str,
        /// Its value.
        value: f64,
    },
    /// A number that must be finite is not.
    #[error(
        "camera field `{field}` is {value} but must be finite; calibrate the camera, or copy its intrinsics again"
    )]
    NotFinite {
        /// Name of the field.
        field: &'static str,
        /// Its value.
        value: f64,
    },
    /// A distortion model that is not known here.
    #[error(
        "distortion model `{model}` is not known; use plumb_bob (or brown_conrady, radtan), rational_polynomial, equidistant (or fisheye, kannala_brandt), inverse_brown_conrady or none, or undistort the images and leave `distortion` out"
    )]
    UnknownModel {
        /// The model's name as it was given.
        model: String,
    },
    /// A distortion model with the wrong number of coefficients.
    #[error(
        "distortion model `{model}` takes {expected} coefficients (k1 k2 p1 p2 k3 …, OpenCV's order) but {found} are given; copy all of them"
    )]
    CoefficientCount {
        /// The model's name.
        model: String,
        /// How many it takes.
        expected: &'static str,
        /// How many there are.
        found: usize,
    },
    /// Coefficients of a thin prism or of a tilted sensor, which are not modelled.
    #[error(
        "the thin-prism and tilt coefficients of distortion model `{model}` (from the 9th) are not zero and are not known here; calibrate without them, or undistort the images and leave `distortion` out"
    )]
    ThinPrism {
        /// The model's name.
        model: String,
    },
    /// A pixel whose ray is so far off the axis that no lens without a fisheye model sees it.
    #[error(
        "pixel ({u}, {v}) would look {off_axis_deg:.0}° away from the axis, which no such lens does; copy focal lengths and principal point, in pixels, and the image size again"
    )]
    OffAxis {
        /// Column of the pixel.
        u: f64,
        /// Row of the pixel.
        v: f64,
        /// Angle between its ray and the axis, degrees.
        off_axis_deg: f64,
    },
    /// A distortion that cannot be inverted over the whole image.
    #[error(
        "the distortion of model `{model}` has no inverse at pixel ({u}, {v}); check the order and the values of the coefficients"
    )]
    NotInvertible {
        /// The model's name.
        model: String,
        /// Column of the pixel.
        u: f64,
        /// Row of the pixel.
        v: f64,
    },
}
