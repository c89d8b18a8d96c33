use thiserror::Error;

/// Why a picture could not be drawn.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ViewError {
    /// The picture has no pixel, or more than can be drawn on.
    #[error("cannot draw a picture of {width} x {height} pixels")]
    Size {
        /// Width asked for, pixels.
        width: usize,
        /// Height asked for, pixels.
        height: usize,
    },
    /// The image holds another number of pixels than its size says.
    #[error("a {width} x {height} image must hold {} pixels, not {pixels}", width.saturating_mul(*height))]
    PixelCount {
        /// Width stated, pixels.
        width: usize,
        /// Height stated, pixels.
        height: usize,
        /// Pixels held.
        pixels: usize,
    },
    /// A viewpoint without a direction: eye and target coincide, the field is
    /// not positive, or a number is not finite.
    #[error("the viewpoint is not usable: {0}")]
    Viewpoint(&'static str),
}
