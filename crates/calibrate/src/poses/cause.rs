//! Why pose samples do not agree: likely slips of whoever wrote them, each tried.

use crate::{CalibrateError, PoseSample};
use pomona_transforms::{FrameTag, Transform};

/// By how many rows one side may be moved against the other.
const SHIFTS: [usize; 2] = [1, 2];

/// The slip after whose correction the samples agree, if there is one.
///
/// `agree` tells whether samples agree.
pub(super) fn cause(
    samples: &[PoseSample],
    mut agree: impl FnMut(&[PoseSample]) -> bool,
) -> Option<CalibrateError> {
    for (robot, camera, sides) in [
        (true, true, "both poses"),
        (false, true, "`camera_from_target`"),
        (true, false, "`robot_from_flange`"),
    ] {
        let corrected: Option<Vec<PoseSample>> = samples
            .iter()
            .map(|sample| {
                let mut sample = sample.clone();
                if robot {
                    sample.robot_from_flange = w_first(&sample.robot_from_flange)?;
                }
                if camera {
                    sample.camera_from_target = w_first(&sample.camera_from_target)?;
                }
                Some(sample)
            })
            .collect();
        if corrected.is_some_and(|corrected| agree(&corrected)) {
            return Some(CalibrateError::WFirst { sides });
        }
    }
    for rows in SHIFTS {
        for later in [true, false] {
            let count = samples.len();
            let moved = |i: usize| {
                let other = if later { i + rows } else { i + count - rows } % count;
                let mut sample = samples[i].clone();
                sample.camera_from_target = samples[other].camera_from_target;
                sample
            };
            let corrected: Vec<PoseSample> = (0..count).map(moved).collect();
            if count > rows && agree(&corrected) {
                let direction = if later { "up" } else { "down" };
                return Some(CalibrateError::Shifted { rows, direction });
            }
        }
    }
    None
}

/// The transform whose quaternion was written w x y z and read x y z w.
fn w_first<To: FrameTag, From: FrameTag>(
    transform: &Transform<To, From>,
) -> Option<Transform<To, From>> {
    let [w, x, y, z] = transform.quaternion_xyzw();
    Transform::from_quaternion(transform.translation_m().into(), [x, y, z, w]).ok()
}
