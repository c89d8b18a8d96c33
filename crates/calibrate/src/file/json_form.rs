use super::checks::{check_ids, not_rigid};
use crate::{FrameIds, PointSample, PoseSample, SAMPLES_SCHEMA, SampleSet, Samples};
use nalgebra::{Matrix4, Point3};
use pomona_files::Malformed;
use pomona_transforms::{FrameTag, Position, Transform};
use serde::Deserialize;
use serde_json::Value;

const REMEDY: &str = "give schema, optionally robot_frame, camera_frame, flange_frame, target_frame, and either points (id, camera_m, robot_m) or poses (id, robot_from_flange, camera_from_target)";

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    #[serde(rename = "schema")]
    _schema: String,
    robot_frame: Option<String>,
    camera_frame: Option<String>,
    flange_frame: Option<String>,
    target_frame: Option<String>,
    points: Option<Vec<Point>>,
    poses: Option<Vec<Pose>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Point {
    id: String,
    camera_m: [f64; 3],
    robot_m: [f64; 3],
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Pose {
    id: String,
    robot_from_flange: Rigid,
    camera_from_target: Rigid,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Rigid {
    translation_m: Option<[f64; 3]>,
    quaternion_xyzw: Option<[f64; 4]>,
    matrix: Option<[[f64; 4]; 4]>,
}

pub(super) fn parse(bytes: &[u8]) -> Result<SampleSet, Malformed> {
    let syntax = |e: serde_json::Error| {
        let place = format!(" at line {} column {}", e.line(), e.column());
        let text = e.to_string();
        let problem = text.strip_suffix(&place).unwrap_or(&text);
        Malformed::new(place.trim_start_matches(" at "), problem, REMEDY)
    };
    let value: Value = serde_json::from_slice(bytes).map_err(syntax)?;
    // The schema first: in a file of another one, its fields are not what is wrong.
    match value.get("schema") {
        Some(found) if found == SAMPLES_SCHEMA => {}
        found => {
            let found = found.map_or("missing".to_owned(), Value::to_string);
            let remedy = format!("give a file of samples, with \"schema\": \"{SAMPLES_SCHEMA}\"");
            return Err(Malformed::new("schema", format!("it is {found}"), remedy));
        }
    }
    let document: Document = serde_json::from_slice(bytes).map_err(syntax)?;
    let samples = match (document.points, document.poses) {
        (Some(points), None) => Samples::Points(of_points(points)?),
        (None, Some(poses)) => Samples::Poses(of_poses(poses)?),
        (Some(_), Some(_)) => {
            return Err(Malformed::new(
                "points, poses",
                "both are given",
                "give each a file of its own",
            ));
        }
        (None, None) => return Err(Malformed::new("points, poses", "there is neither", REMEDY)),
    };
    Ok(SampleSet {
        samples,
        frames: FrameIds {
            robot: document.robot_frame,
            camera: document.camera_frame,
            flange: document.flange_frame,
            target: document.target_frame,
        },
        warnings: Vec::new(),
    })
}

fn of_points(points: Vec<Point>) -> Result<Vec<PointSample>, Malformed> {
    let ids = points.iter().enumerate();
    let ids: Vec<_> = ids
        .map(|(i, p)| (format!("points[{i}]"), p.id.as_str()))
        .collect();
    check_ids(&ids)?;
    let sample = |p: Point| PointSample {
        id: p.id,
        camera: Position::new(Point3::from(p.camera_m)),
        robot: Position::new(Point3::from(p.robot_m)),
    };
    Ok(points.into_iter().map(sample).collect())
}

fn of_poses(poses: Vec<Pose>) -> Result<Vec<PoseSample>, Malformed> {
    let ids = poses.iter().enumerate();
    let ids: Vec<_> = ids
        .map(|(i, p)| (format!("poses[{i}]"), p.id.as_str()))
        .collect();
    check_ids(&ids)?;
    let sample = |p: Pose| {
        Ok(PoseSample {
            robot_from_flange: transform(&p.robot_from_flange, &p.id, "robot_from_flange")?,
            camera_from_target: transform(&p.camera_from_target, &p.id, "camera_from_target")?,
            id: p.id,
        })
    };
    poses.into_iter().map(sample).collect()
}

fn transform<To: FrameTag, From: FrameTag>(
    rigid: &Rigid,
    id: &str,
    field: &str,
) -> Result<Transform<To, From>, Malformed> {
    let place = format!("sample `{id}`: {field}");
    let found = match (rigid.translation_m, rigid.quaternion_xyzw, rigid.matrix) {
        (Some(t), Some(q), None) => Transform::from_quaternion(t, q),
        (None, None, Some(m)) => Transform::from_matrix(&Matrix4::from_fn(|i, j| m[i][j])),
        _ => {
            let problem = "it is given in part, or twice";
            let remedy = "give translation_m and quaternion_xyzw, or matrix in their place";
            return Err(Malformed::new(place, problem, remedy));
        }
    };
    found.map_err(|e| not_rigid(place, &e))
}
