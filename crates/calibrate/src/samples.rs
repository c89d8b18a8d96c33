use crate::CalibrateError;
use pomona_transforms::{
    CameraFrame, FlangeFrame, MAX_TRANSLATION_M, Position, RobotFrame, TargetFrame, Transform,
};
use std::collections::HashSet;

/// One place, as the camera saw it and as the robot touched it.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct PointSample {
    /// Its name, in messages and results.
    pub id: String,
    /// Where the camera saw it, m.
    pub camera: Position<CameraFrame>,
    /// Where it is for the robot, m.
    pub robot: Position<RobotFrame>,
}

impl PointSample {
    /// A sample of this name.
    pub fn new(
        id: impl Into<String>,
        camera: Position<CameraFrame>,
        robot: Position<RobotFrame>,
    ) -> Self {
        Self {
            id: id.into(),
            camera,
            robot,
        }
    }
}

/// One stop of the robot: where its flange was, and where the camera saw the target.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct PoseSample {
    /// Its name, in messages and results.
    pub id: String,
    /// The flange's pose, as the robot told it.
    pub robot_from_flange: Transform<RobotFrame, FlangeFrame>,
    /// The target's pose, as the camera saw it.
    pub camera_from_target: Transform<CameraFrame, TargetFrame>,
}

impl PoseSample {
    /// A sample of this name.
    pub fn new(
        id: impl Into<String>,
        robot_from_flange: Transform<RobotFrame, FlangeFrame>,
        camera_from_target: Transform<CameraFrame, TargetFrame>,
    ) -> Self {
        Self {
            id: id.into(),
            robot_from_flange,
            camera_from_target,
        }
    }
}

pub(crate) fn check_points(samples: &[PointSample], needed: usize) -> Result<(), CalibrateError> {
    check_ids(samples.iter().map(|s| s.id.as_str()), needed)?;
    for sample in samples {
        for (field, point) in [
            ("camera_m", sample.camera.point()),
            ("robot_m", sample.robot.point()),
        ] {
            check_length(&sample.id, field, &point.coords)?;
        }
    }
    Ok(())
}

/// Refuses lengths that are millimetres, taken for metres.
pub(crate) fn check_point_lengths(samples: &[PointSample]) -> Result<(), CalibrateError> {
    for sample in samples {
        check_far(&sample.id, "camera_m", &sample.camera.point().coords)?;
        check_far(&sample.id, "robot_m", &sample.robot.point().coords)?;
    }
    Ok(())
}

pub(crate) fn check_poses(samples: &[PoseSample], needed: usize) -> Result<(), CalibrateError> {
    check_ids(samples.iter().map(|s| s.id.as_str()), needed)?;
    for sample in samples {
        for (field, translation) in [
            (
                "robot_from_flange",
                sample.robot_from_flange.translation_m(),
            ),
            (
                "camera_from_target",
                sample.camera_from_target.translation_m(),
            ),
        ] {
            check_length(&sample.id, field, &translation)?;
            check_far(&sample.id, field, &translation)?;
        }
    }
    Ok(())
}

fn check_ids<'a>(
    ids: impl ExactSizeIterator<Item = &'a str>,
    needed: usize,
) -> Result<(), CalibrateError> {
    let found = ids.len();
    if found < needed {
        return Err(CalibrateError::TooFew { found, needed });
    }
    let mut seen = HashSet::new();
    for id in ids {
        if !seen.insert(id) {
            return Err(CalibrateError::SameId { id: id.to_owned() });
        }
    }
    Ok(())
}

fn check_length(
    id: &str,
    field: &'static str,
    v: &nalgebra::Vector3<f64>,
) -> Result<(), CalibrateError> {
    if v.iter().all(|c| c.is_finite()) {
        return Ok(());
    }
    Err(CalibrateError::NotFinite {
        id: id.to_owned(),
        field,
    })
}

fn check_far(
    id: &str,
    field: &'static str,
    v: &nalgebra::Vector3<f64>,
) -> Result<(), CalibrateError> {
    let length_m = v.x.hypot(v.y).hypot(v.z);
    if length_m <= MAX_TRANSLATION_M {
        return Ok(());
    }
    Err(CalibrateError::TooFar {
        id: id.to_owned(),
        field,
        length_m,
    })
}
