//! What the messages of a recording say.

use super::foxglove::{
    Color, Cylinder, FrameTransform, Line, NumericType, PackedElementField, PointCloud, Pose,
    PosesInFrame, SceneEntity, SceneUpdate, Solid, Time,
};
use crate::order::ranked;
use crate::pose::along_z;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use nalgebra::{Isometry3, Point3, Vector3};
use pomona::{CheckedFrame, Robot, RobotPlan};

const APPLE: Color = rgba(1.0, 0.35, 0.75, 0.8);
const BOX: Color = rgba(0.16, 0.47, 1.0, 0.15);
const BRANCH: Color = rgba(0.12, 0.92, 0.24, 1.0);
const PATH: Color = rgba(1.0, 0.87, 0.0, 1.0);
const GRIPPER: Color = rgba(0.59, 0.92, 1.0, 0.5);

/// Thickness of the line that shows a path, metres.
const PATH_THICKNESS_M: f64 = 0.004;

/// Bytes of a packed point: three 32-bit floats and four bytes of colour.
const POINT_STRIDE: u32 = 16;

const fn rgba(r: f64, g: f64, b: f64, a: f64) -> Color {
    Color { r, g, b, a }
}

/// The pose of frame `child` in frame `parent`.
pub(super) fn frame_transform(
    timestamp: Time,
    parent: &str,
    child: &str,
    child_in_parent: &Isometry3<f64>,
) -> FrameTransform {
    FrameTransform {
        timestamp,
        parent_frame_id: parent.to_owned(),
        child_frame_id: child.to_owned(),
        translation: child_in_parent.translation.vector.into(),
        rotation: child_in_parent.rotation.into(),
    }
}

/// The points of a frame: x y z as 32-bit floats, then red green blue alpha as bytes.
pub(super) fn cloud(frame: &CheckedFrame<'_>) -> PointCloud {
    let (points, frame) = (frame.points(), frame.frame());
    let mut data = Vec::with_capacity(points.len() * POINT_STRIDE as usize);
    for i in 0..points.len() {
        for coordinate in [points.x[i], points.y[i], points.z[i]] {
            data.extend_from_slice(&coordinate.to_le_bytes());
        }
        let pixel = points.pixel[i] as usize;
        let [r, g, b] = frame.color.pixels.get(pixel).copied().unwrap_or([0; 3]);
        data.extend_from_slice(&[r, g, b, 255]);
    }
    let field = |name: &str, offset: u32, numeric_type: NumericType| PackedElementField {
        name: name.to_owned(),
        offset,
        numeric_type,
    };
    PointCloud {
        timestamp: Time::default(),
        frame_id: frame.camera.frame_id.clone(),
        pose: Pose::from(&Isometry3::identity()),
        point_stride: POINT_STRIDE,
        fields: vec![
            field("x", 0, NumericType::Float32),
            field("y", 4, NumericType::Float32),
            field("z", 8, NumericType::Float32),
            field("red", 12, NumericType::Uint8),
            field("green", 13, NumericType::Uint8),
            field("blue", 14, NumericType::Uint8),
            field("alpha", 15, NumericType::Uint8),
        ],
        data: STANDARD.encode(&data),
    }
}

/// The wrist's poses at the apples, in the picking order.
pub(super) fn grasps(plan: &RobotPlan, robot: &Robot) -> PosesInFrame {
    let gripper = &robot.config().gripper;
    let poses = ranked(plan).map(|(_, approach)| Pose::from(&gripper.wrist_pose(&approach.grasp)));
    PosesInFrame {
        timestamp: Time::default(),
        frame_id: plan.frame_id.clone(),
        poses: poses.collect(),
    }
}

/// Apples with boxes about them, branches, and for each planned apple the path and the gripper.
pub(super) fn scene(plan: &RobotPlan, robot: &Robot) -> SceneUpdate {
    let mut entities = Vec::new();
    let apples = plan.scene.apples().iter().zip(&plan.apples);
    for (apple, id) in apples {
        let center = Isometry3::from_parts(apple.center.coords.into(), nalgebra::one());
        let solid = |color| Solid {
            pose: Pose::from(&center),
            size: Vector3::repeat(2.0 * apple.radius).into(),
            color,
        };
        entities.push(SceneEntity {
            spheres: vec![solid(APPLE)],
            ..entity(&plan.frame_id, format!("apple_{id}"))
        });
        entities.push(SceneEntity {
            cubes: vec![solid(BOX)],
            ..entity(&plan.frame_id, format!("box_{id}"))
        });
    }
    let branches = plan.scene.branches().iter().zip(&plan.branches);
    entities.extend(branches.map(|(branch, id)| {
        let (start, end) = (&branch.segment.start, &branch.segment.end);
        SceneEntity {
            cylinders: vec![cylinder(start, end, branch.radius, BRANCH)],
            ..entity(&plan.frame_id, format!("branch_{id}"))
        }
    }));
    for (id, approach) in ranked(plan) {
        let samples = approach.path.samples(robot.config().motion.samples);
        let points = samples.iter().map(|s| s.position.coords.into());
        entities.push(SceneEntity {
            lines: vec![line(points.collect(), PATH)],
            ..entity(&plan.frame_id, format!("path_{id}"))
        });
        let parts = robot.config().gripper.capsules();
        let cylinders = parts
            .iter()
            .map(|(start, end, radius)| cylinder(start, end, *radius, GRIPPER));
        entities.push(SceneEntity {
            cylinders: cylinders.collect(),
            ..entity(&tool_frame(id), format!("gripper_{id}"))
        });
    }
    SceneUpdate {
        deletions: Vec::new(),
        entities,
    }
}

/// Name of the frame that moves with the tool on its way to a pick.
pub(super) fn tool_frame(pick: usize) -> String {
    format!("tool_{pick}")
}

/// An entity without shapes, which moves with its frame.
fn entity(frame_id: &str, id: String) -> SceneEntity {
    SceneEntity {
        frame_id: frame_id.to_owned(),
        id,
        frame_locked: true,
        ..SceneEntity::default()
    }
}

/// A cylinder about the segment from `start` to `end`.
fn cylinder(start: &Point3<f64>, end: &Point3<f64>, radius: f64, color: Color) -> Cylinder {
    let (pose, length) = along_z(start, end);
    Cylinder {
        pose: Pose::from(&pose),
        size: Vector3::new(2.0 * radius, 2.0 * radius, length).into(),
        bottom_scale: 1.0,
        top_scale: 1.0,
        color,
    }
}

fn line(points: Vec<super::foxglove::Vector3>, color: Color) -> Line {
    Line {
        kind: 0,
        pose: Pose::from(&Isometry3::identity()),
        thickness: PATH_THICKNESS_M,
        scale_invariant: false,
        points,
        color,
        colors: Vec::new(),
        indices: Vec::new(),
    }
}
