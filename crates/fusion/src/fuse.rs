use crate::answer::{FusedFrame, FusedTree};
use crate::apple::AppleFusion;
use crate::association::Association;
use crate::error::FusionError;
use crate::joint::JointEstimate;
use crate::motion::{MotionPriors, correction};
use crate::observation::{Observation, centroid};
use pomona::{FrameAnswer, FusionConfig, RobotFromCamera};
use pomona_statistics::chi_square_critical;
use pomona_transforms::{CameraFrame, Position};

/// The answers for one frame and the pose of its camera.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct PosedAnswer<'a> {
    /// The answers, in the camera's frame.
    pub answer: &'a FrameAnswer,
    /// The camera's pose when the frame was taken, with its covariance where that is known.
    pub robot_from_camera: &'a RobotFromCamera,
}

impl<'a> PosedAnswer<'a> {
    /// The answers for a frame that was taken at this pose.
    pub fn new(answer: &'a FrameAnswer, robot_from_camera: &'a RobotFromCamera) -> Self {
        Self {
            answer,
            robot_from_camera,
        }
    }
}

/// Combines the answers of several frames of one tree.
///
/// Apples are joined by the Mahalanobis distance of their centres, each with at most one of every other
/// frame. All positions are estimated together with a small common motion of each frame (sway of the tree, errors of
/// the poses), so that the errors that the apples of a frame share are counted once. What is then
/// outside the gate, while the spheres of the two positions overlap, is one apple: it has moved by itself if both positions
/// are well visible, else the position that is less visible is a misfit. Without an overlap they are two apples. An apple that
/// only one frame shows is kept.
///
/// Poses that are all the same are taken for a camera at rest: their stated error is common to all frames, adds
/// to the covariance of each apple, and explains no shift. Any other poses are taken for independent.
///
/// The same answers and poses give the same result bit for bit. Frames without any apple are not an error.
///
/// # Errors
///
/// - [`FusionError::Config`]: a setting out of its range.
/// - [`FusionError::TooFew`]: fewer than two frames.
/// - [`FusionError::WrongPose`], [`FusionError::DifferentRobots`]: poses that do not belong to the frames, or that lead to
///   different frames of a robot.
/// - [`FusionError::SameFrame`]: a frame given twice.
/// - [`FusionError::Numbers`]: covariances that are not positive definite.
pub fn fuse(frames: &[PosedAnswer<'_>], config: &FusionConfig) -> Result<FusedTree, FusionError> {
    config.validate()?;
    check(frames)?;
    let observations: Vec<Observation> = frames
        .iter()
        .enumerate()
        .flat_map(|(k, frame)| {
            let apples = frame.answer.apples.iter();
            apples.filter_map(move |a| Observation::new(k, a, frame.robot_from_camera, config))
        })
        .collect();
    let poses: Vec<&RobotFromCamera> = frames.iter().map(|f| f.robot_from_camera).collect();
    let priors = MotionPriors::new(&poses, &centroid(&observations), config);
    let gate = chi_square_critical(config.moved_rate, 3);
    let association = Association {
        observations: &observations,
        priors: &priors.covariances,
        gate,
    };
    let estimate = association.run().ok_or(FusionError::Numbers)?;
    let apples = AppleFusion {
        estimate: &estimate,
        common_pose_error: priors.common_pose_error(),
        gate,
        config,
    };
    Ok(FusedTree {
        frame_id: frames[0].robot_from_camera.to.clone(),
        frames: (0..frames.len())
            .map(|k| fused_frame(k, frames[k].answer, &estimate, &priors, gate))
            .collect(),
        apples: apples.apples(),
    })
}

fn fused_frame(
    k: usize,
    answer: &FrameAnswer,
    estimate: &JointEstimate<'_>,
    priors: &MotionPriors,
    gate: f64,
) -> FusedFrame {
    let shows = |track: usize| estimate.observations_of(track).any(|o| o.frame == k);
    let shared = (0..estimate.tracks.len())
        .filter(|&track| estimate.tracks[track].len() > 1 && shows(track))
        .count();
    let observations = estimate.observations.iter();
    FusedFrame {
        id: answer.id.clone(),
        camera_frame_id: answer.camera_frame_id.clone(),
        apples: observations.filter(|o| o.frame == k).count(),
        shared,
        shift: (k > 0 && shared > 0).then(|| priors.shift(estimate, k, gate)),
        correction: correction(estimate, k),
    }
}

fn check(frames: &[PosedAnswer<'_>]) -> Result<(), FusionError> {
    if frames.len() < 2 {
        return Err(FusionError::TooFew {
            count: frames.len(),
        });
    }
    for (k, frame) in frames.iter().enumerate() {
        let (answer, pose) = (frame.answer, frame.robot_from_camera);
        if pose.from != answer.camera_frame_id {
            return Err(FusionError::WrongPose {
                frame: answer.id.clone(),
                camera: answer.camera_frame_id.clone(),
                from: pose.from.clone(),
            });
        }
        for earlier in &frames[..k] {
            let before = earlier.answer;
            if earlier.robot_from_camera.to != pose.to {
                return Err(FusionError::DifferentRobots {
                    first: before.id.clone(),
                    first_to: earlier.robot_from_camera.to.clone(),
                    second: answer.id.clone(),
                    second_to: pose.to.clone(),
                });
            }
            if before.id == answer.id || same_apples(before, answer) {
                return Err(FusionError::SameFrame {
                    first: before.id.clone(),
                    second: answer.id.clone(),
                });
            }
        }
    }
    Ok(())
}

/// Noise never repeats all centres to the last digit.
fn same_apples(a: &FrameAnswer, b: &FrameAnswer) -> bool {
    let centers = |answer: &FrameAnswer| -> Vec<Position<CameraFrame>> {
        let apples = answer.apples.iter();
        apples
            .filter_map(|a| Some(a.apple.as_ref()?.center))
            .collect()
    };
    let (a, b) = (centers(a), centers(b));
    !a.is_empty() && a == b
}
