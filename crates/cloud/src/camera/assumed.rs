//! What camera files leave open, and what is taken in its place.

use super::Camera;
use pomona_files::{Warning, WarningCode};

/// The file does not name the camera's frame; `camera` has the name that was taken.
pub(super) fn frame_id(camera: &Camera) -> Warning {
    let message = format!(
        "no `frame_id`; the camera's frame is taken to be `{}`: name it where a transform starts in another",
        camera.frame_id
    );
    Warning::new(WarningCode::FrameIdAssumed, message)
}

/// The file does not say how depth is stored; `camera` has the unit that was taken.
pub(super) fn depth_scale(camera: &Camera) -> Warning {
    let message = format!(
        "no depth unit; a unit of the depth image is taken to be {} mm",
        camera.depth_scale * 1000.0
    );
    Warning::new(WarningCode::DepthScaleAssumed, message)
}
