//! Why frames cannot be fused.

use thiserror::Error;

/// Why frames could not be fused.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum FusionError {
    /// There are fewer than two frames.
    #[error("{count} frame given: fusing takes at least two frames of one tree")]
    TooFew {
        /// How many there are.
        count: usize,
    },
    /// The pose starts in another frame than the camera's.
    #[error(
        "frame '{frame}' was taken in '{camera}', but its pose starts in '{from}': \
         give the transform of this camera, or correct one of the names"
    )]
    WrongPose {
        /// The frame's id.
        frame: String,
        /// The camera's frame.
        camera: String,
        /// Where the pose starts.
        from: String,
    },
    /// Two poses lead to different frames.
    #[error(
        "the pose of frame '{first}' leads to '{first_to}', that of '{second}' to '{second_to}': \
         give all poses in one frame of the robot"
    )]
    DifferentRobots {
        /// Id of one frame.
        first: String,
        /// Where its pose leads.
        first_to: String,
        /// Id of the other.
        second: String,
        /// Where its pose leads.
        second_to: String,
    },
    /// The same frame is given twice.
    #[error(
        "frames '{first}' and '{second}' are the same image: the same apple would count twice; \
         give each frame once"
    )]
    SameFrame {
        /// Id of one.
        first: String,
        /// Id of the other.
        second: String,
    },
    /// A covariance of a pose or an apple is not positive definite.
    #[error(
        "the poses and the apples' covariances cannot be combined: check that the poses' covariances \
         are of metres and radians"
    )]
    Numbers,
    /// A setting makes no sense.
    #[error(transparent)]
    Config(#[from] pomona::ConfigError),
}
