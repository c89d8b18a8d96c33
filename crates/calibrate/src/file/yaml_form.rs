//! Samples as programs of ROS write them in YAML: `MoveIt`'s calibration, and `easy_handeye`.

use super::checks::not_rigid;
use crate::{FrameIds, PoseSample, SampleSet, Samples};
use nalgebra::Matrix4;
use pomona_files::Malformed;
use pomona_transforms::{FrameTag, Transform};
use serde::Deserialize;
use serde::de::DeserializeOwned;

const REMEDY: &str = "give the samples of MoveIt's hand-eye calibration (effector_wrt_world and object_wrt_sensor, 16 numbers each), of easy_handeye (samples with robot and tracking), or pomona's JSON or CSV";

/// Whether a text is of one of these forms.
pub(super) fn is_yaml(text: &str) -> bool {
    text.contains("effector_wrt_world") || (text.contains("samples") && text.contains("robot"))
}

#[derive(Deserialize)]
struct MoveIt {
    effector_wrt_world: Vec<f64>,
    object_wrt_sensor: Vec<f64>,
}

#[derive(Deserialize)]
struct EasyHandeye {
    samples: Vec<EasyHandeyeSample>,
}

#[derive(Deserialize)]
struct EasyHandeyeSample {
    robot: Rigid,
    #[serde(alias = "optical")]
    tracking: Rigid,
}

#[derive(Deserialize)]
struct Rigid {
    translation: Xyz,
    rotation: Xyzw,
}

#[derive(Deserialize)]
struct Xyz {
    x: f64,
    y: f64,
    z: f64,
}

#[derive(Deserialize)]
struct Xyzw {
    x: f64,
    y: f64,
    z: f64,
    w: f64,
}

pub(super) fn parse(text: &str) -> Result<SampleSet, Malformed> {
    let samples: Vec<PoseSample> = if text.contains("effector_wrt_world") {
        let list: Vec<MoveIt> = from_yaml(text)?;
        let sample = |(i, s): (usize, MoveIt)| {
            let id = format!("s{}", i + 1);
            let place = |field: &str| format!("sample {}: {field}", i + 1);
            Ok(PoseSample {
                robot_from_flange: of_matrix(&s.effector_wrt_world, place("effector_wrt_world"))?,
                camera_from_target: of_matrix(&s.object_wrt_sensor, place("object_wrt_sensor"))?,
                id,
            })
        };
        list.into_iter()
            .enumerate()
            .map(sample)
            .collect::<Result<_, _>>()?
    } else {
        let list: EasyHandeye = from_yaml(text)?;
        let sample = |(i, s): (usize, EasyHandeyeSample)| {
            let id = format!("s{}", i + 1);
            let place = |field: &str| format!("sample {}: {field}", i + 1);
            Ok(PoseSample {
                robot_from_flange: of_rigid(&s.robot, place("robot"))?,
                camera_from_target: of_rigid(&s.tracking, place("tracking"))?,
                id,
            })
        };
        list.samples
            .into_iter()
            .enumerate()
            .map(sample)
            .collect::<Result<_, _>>()?
    };
    Ok(SampleSet {
        samples: Samples::Poses(samples),
        frames: FrameIds::default(),
        warnings: Vec::new(),
    })
}

fn from_yaml<T: DeserializeOwned>(text: &str) -> Result<T, Malformed> {
    serde_saphyr::from_str(text).map_err(|e| {
        let place = e
            .location()
            .map_or_else(|| "YAML".to_owned(), |at| format!("line {}", at.line()));
        Malformed::new(place, e.without_snippet().to_string(), REMEDY)
    })
}

fn of_matrix<To: FrameTag, From: FrameTag>(
    numbers: &[f64],
    place: String,
) -> Result<Transform<To, From>, Malformed> {
    if numbers.len() != 16 {
        let problem = format!("{} numbers where a 4x4 matrix has 16", numbers.len());
        return Err(Malformed::new(place, problem, REMEDY));
    }
    Transform::from_matrix(&Matrix4::from_row_slice(numbers)).map_err(|e| not_rigid(place, &e))
}

fn of_rigid<To: FrameTag, From: FrameTag>(
    rigid: &Rigid,
    place: String,
) -> Result<Transform<To, From>, Malformed> {
    let (t, q) = (&rigid.translation, &rigid.rotation);
    Transform::from_quaternion([t.x, t.y, t.z], [q.x, q.y, q.z, q.w])
        .map_err(|e| not_rigid(place, &e))
}
