use crate::apple::AppleFusion;
use crate::associate::Association;
use crate::chi_square;
use crate::error::FusionError;
use crate::joint::{Joint, Track, middle_of, squared_distance};
use crate::record::{FUSED_SCHEMA, FusedFrame, FusedRecord, ShiftRecord};
use crate::sighting::Sighting;
use nalgebra::{Isometry3, Matrix3, Matrix6, UnitQuaternion, Vector3};
use pomona::{FrameAnswer, FusionConfig, RobotFromCamera};
use pomona_transforms::{CameraFrame, Position};

/// The answers for one frame and where its camera stood.
#[derive(Clone, Copy, Debug)]
pub struct PosedAnswer<'a> {
    /// The answers, in the camera's frame.
    pub answer: &'a FrameAnswer,
    /// The camera's pose when the frame was taken, with its covariance where that is known.
    pub robot_from_camera: &'a RobotFromCamera,
}

/// What several frames say together.
#[derive(Clone, Debug, PartialEq)]
pub struct Fusion {
    /// What `fused.json` holds.
    pub record: FusedRecord,
    /// For each frame what takes points of the robot's frame, as its pose gives them, to where the fused apples are: the
    /// estimated sway taken off.
    pub corrections: Vec<Isometry3<f64>>,
}

/// Combines the answers of several frames of one tree.
///
/// Apples are joined by the Mahalanobis distance of their centres, each with at most one of every other
/// frame. All places are estimated together with a small common motion of each frame (sway of the tree, errors of
/// the poses), so that the errors that the apples of a frame share are counted once. What then
/// lies beyond the gate, while the bodies of the two places overlap, is one apple: it has `moved` by itself if both places are
/// well seen, else the place that is seen worse is a misfit. Without an overlap they are two apples. An apple that one frame
/// alone shows is kept.
///
/// Poses that are all one and the same are taken for a camera at rest: their stated error is common to all frames, adds
/// to the covariance of each apple, and explains no shift. Any other poses are taken for independent.
///
/// The same answers and poses give the same bytes.
///
/// # Errors
///
/// [`FusionError`]: fewer than two frames, poses that do not belong to the frames or lead to different robots,
/// a frame given twice, numbers that cannot be calculated with. Frames without any apple are none.
pub fn fuse(frames: &[PosedAnswer<'_>], config: &FusionConfig) -> Result<Fusion, FusionError> {
    config.validate()?;
    check(frames)?;
    let mut sightings = Vec::new();
    for (k, frame) in frames.iter().enumerate() {
        let of_frame = frame.answer.apples.iter();
        sightings.extend(
            of_frame.filter_map(|apple| Sighting::new(k, apple, frame.robot_from_camera, config)),
        );
    }
    let middle = middle_of(&sightings);
    let at_rest = frames
        .windows(2)
        .all(|w| w[0].robot_from_camera == w[1].robot_from_camera);
    let poses: Vec<Matrix6<f64>> = frames
        .iter()
        .map(|f| about(&f.robot_from_camera.uncertain().covariance, &middle))
        .collect();
    let priors: Vec<Matrix6<f64>> = poses
        .iter()
        .map(|pose| prior(if at_rest { None } else { Some(pose) }, config))
        .collect();
    let gate = chi_square::bound_3(config.moved_rate);
    let association = Association {
        sightings: &sightings,
        priors: &priors,
        gate,
    };
    let (tracks, joint) = association.run().ok_or(FusionError::Numbers)?;

    let apples = AppleFusion {
        sightings: &sightings,
        tracks: &tracks,
        joint: &joint,
        common: poses.first().filter(|_| at_rest),
        middle,
        gate,
        config,
    };
    let shifts = Shifts {
        sightings: &sightings,
        tracks: &tracks,
        joint: &joint,
        poses: if at_rest { &[] } else { &poses },
        gate,
    };
    let record = FusedRecord {
        schema: FUSED_SCHEMA.to_owned(),
        frame_id: frames[0].robot_from_camera.to.clone(),
        frames: (0..frames.len())
            .map(|k| shifts.frame(k, frames[k].answer))
            .collect(),
        apples: apples.all(),
    };
    let corrections = (0..frames.len())
        .map(|k| correction(&joint, k, &middle))
        .collect();
    Ok(Fusion {
        record,
        corrections,
    })
}

fn check(frames: &[PosedAnswer<'_>]) -> Result<(), FusionError> {
    if frames.len() < 2 {
        return Err(FusionError::TooFew {
            count: frames.len(),
        });
    }
    for (k, frame) in frames.iter().enumerate() {
        let (of, pose) = (frame.answer, frame.robot_from_camera);
        if pose.from != of.camera_frame_id {
            return Err(FusionError::WrongPose {
                frame: of.id.clone(),
                camera: of.camera_frame_id.clone(),
                from: pose.from.clone(),
            });
        }
        for earlier in &frames[..k] {
            let before = earlier.answer;
            if earlier.robot_from_camera.to != pose.to {
                return Err(FusionError::DifferentRobots {
                    first: before.id.clone(),
                    first_to: earlier.robot_from_camera.to.clone(),
                    second: of.id.clone(),
                    second_to: pose.to.clone(),
                });
            }
            if before.id == of.id || same_apples(before, of) {
                return Err(FusionError::SameFrame {
                    first: before.id.clone(),
                    second: of.id.clone(),
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

/// Covariance of a motion about the origin, for the same motion about `middle`: there it shifts by ω × middle besides.
fn about(covariance: &Matrix6<f64>, middle: &Vector3<f64>) -> Matrix6<f64> {
    let mut transfer = Matrix6::identity();
    transfer
        .fixed_view_mut::<3, 3>(3, 0)
        .copy_from(&-middle.cross_matrix());
    transfer * covariance * transfer.transpose()
}

/// What a frame may have moved by: what its pose states and what trees sway.
fn prior(pose: Option<&Matrix6<f64>>, config: &FusionConfig) -> Matrix6<f64> {
    let mut sway = Matrix6::zeros();
    for i in 0..3 {
        // The least keeps it invertible.
        sway[(i, i)] = config.sway_sd_rad.max(1e-6).powi(2);
        sway[(i + 3, i + 3)] = config.sway_sd_m.max(1e-6).powi(2);
    }
    pose.map_or(sway, |pose| {
        let pose = pose + sway;
        (pose + pose.transpose()) * 0.5
    })
}

/// m ↦ m − (ω × (m − c) + υ), to first order a rotation by −ω about c and a shift by −υ.
fn correction(joint: &Joint, k: usize, middle: &Vector3<f64>) -> Isometry3<f64> {
    let motion = joint.motion(k);
    let omega: Vector3<f64> = motion.fixed_rows::<3>(0).into();
    let shift: Vector3<f64> = motion.fixed_rows::<3>(3).into();
    let rotation = UnitQuaternion::from_scaled_axis(-omega);
    let translation = middle - rotation * middle - shift;
    Isometry3::from_parts(translation.into(), rotation)
}

/// What the frames' common motions are reported from.
struct Shifts<'a> {
    sightings: &'a [Sighting],
    tracks: &'a [Track],
    joint: &'a Joint,
    /// What the poses state of their errors about the middle; nothing for a camera at rest.
    poses: &'a [Matrix6<f64>],
    gate: f64,
}

impl Shifts<'_> {
    fn frame(&self, k: usize, answer: &FrameAnswer) -> FusedFrame {
        let own = |&i: &usize| self.sightings[i].frame == k;
        let shared = self
            .tracks
            .iter()
            .filter(|t| t.len() > 1 && t.iter().any(&own))
            .count();
        let shift = (k > 0 && shared > 0).then(|| {
            let (by, covariance): (Vector3<f64>, Matrix3<f64>) = self.joint.shift(k, 0);
            let stated = [0, k].into_iter().filter_map(|f| self.poses.get(f));
            let stated: Matrix3<f64> = stated
                .map(|p| p.fixed_view::<3, 3>(3, 3).into_owned())
                .sum();
            ShiftRecord {
                by: by.into(),
                distance: by.norm(),
                sd: (covariance.trace() / 3.0).max(0.0).sqrt(),
                significant: squared_distance(&by, &(covariance + stated)) > self.gate,
            }
        });
        FusedFrame {
            id: answer.id.clone(),
            frame_id: answer.camera_frame_id.clone(),
            apples: self.sightings.iter().filter(|s| s.frame == k).count(),
            shared,
            shift,
        }
    }
}
