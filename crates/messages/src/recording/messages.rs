//! The messages' content.

use crate::ros;
use nalgebra::{Isometry3, Point3, UnitQuaternion, Vector3};
use pomona::{CheckedFrame, Robot, RobotPlan};
use serde_json::{Value, json};
use std::f64::consts::PI;

/// Apples pink, boxes blue, branches green, paths yellow, grippers pale blue.
const APPLE: [f64; 4] = [1.0, 0.35, 0.75, 0.8];
const BOX: [f64; 4] = [0.16, 0.47, 1.0, 0.15];
const BRANCH: [f64; 4] = [0.12, 0.92, 0.24, 1.0];
const PATH: [f64; 4] = [1.0, 0.87, 0.0, 1.0];
const GRIPPER: [f64; 4] = [0.59, 0.92, 1.0, 0.5];
/// Thickness of a path's line, metres.
const LINE_M: f64 = 0.004;
/// Numeric types of a packed field.
const UINT8: u8 = 1;
const FLOAT32: u8 = 7;

pub(super) fn nanoseconds(seconds: f64) -> u64 {
    (seconds * 1e9).round() as u64
}

fn time(seconds: f64) -> Value {
    let all = nanoseconds(seconds);
    json!({"sec": all / 1_000_000_000, "nsec": all % 1_000_000_000})
}

fn vector(v: &Vector3<f64>) -> Value {
    json!({"x": v.x, "y": v.y, "z": v.z})
}

fn quaternion(q: &UnitQuaternion<f64>) -> Value {
    json!({"x": q.i, "y": q.j, "z": q.k, "w": q.w})
}

fn pose(pose: &Isometry3<f64>) -> Value {
    json!({"position": vector(&pose.translation.vector), "orientation": quaternion(&pose.rotation)})
}

fn color([r, g, b, a]: [f64; 4]) -> Value {
    json!({"r": r, "g": g, "b": b, "a": a})
}

pub(super) fn frame_transform(
    time_s: f64,
    parent: &str,
    child: &str,
    child_in_parent: &Isometry3<f64>,
) -> Value {
    json!({
        "timestamp": time(time_s),
        "parent_frame_id": parent,
        "child_frame_id": child,
        "translation": vector(&child_in_parent.translation.vector),
        "rotation": quaternion(&child_in_parent.rotation),
    })
}

/// x y z as 32-bit floats, then red green blue alpha as bytes.
pub(super) fn cloud(frame: &CheckedFrame<'_>) -> Value {
    let (points, frame) = (frame.points(), frame.frame());
    let mut data = Vec::with_capacity(points.len() * 16);
    for i in 0..points.len() {
        for c in [points.x[i], points.y[i], points.z[i]] {
            data.extend_from_slice(&c.to_le_bytes());
        }
        let pixel = points.pixel[i] as usize;
        let [r, g, b] = frame.color.pixels.get(pixel).copied().unwrap_or([0; 3]);
        data.extend_from_slice(&[r, g, b, 255]);
    }
    let field =
        |name: &str, offset: u8, kind: u8| json!({"name": name, "offset": offset, "type": kind});
    json!({
        "timestamp": time(0.0),
        "frame_id": frame.camera.frame_id,
        "pose": pose(&Isometry3::identity()),
        "point_stride": 16,
        "fields": [
            field("x", 0, FLOAT32), field("y", 4, FLOAT32), field("z", 8, FLOAT32),
            field("red", 12, UINT8), field("green", 13, UINT8), field("blue", 14, UINT8), field("alpha", 15, UINT8),
        ],
        "data": base64(&data),
    })
}

/// RFC 4648, section 4.
fn base64(bytes: &[u8]) -> String {
    const ALPHABET: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for chunk in bytes.chunks(3) {
        let byte = |i: usize| u32::from(chunk.get(i).copied().unwrap_or(0));
        let bits = byte(0) << 16 | byte(1) << 8 | byte(2);
        for i in 0..4 {
            if i <= chunk.len() {
                let index = bits >> (18 - 6 * i) & 63;
                text.push(char::from(ALPHABET[index as usize]));
            } else {
                text.push('=');
            }
        }
    }
    text
}

pub(super) fn grasps(plan: &RobotPlan, robot: &Robot) -> Value {
    let gripper = &robot.config().gripper;
    let poses: Vec<Value> = ros::ranked(plan)
        .map(|(_, approach)| pose(&gripper.wrist_pose(&approach.grasp)))
        .collect();
    json!({"timestamp": time(0.0), "frame_id": plan.frame_id, "poses": poses})
}

/// An entity with its primitives of one kind.
fn entity(frame: &str, id: &str, kind: &str, primitives: Vec<Value>) -> Value {
    let mut entity = json!({
        "timestamp": time(0.0), "frame_id": frame, "id": id, "lifetime": time(0.0),
        "frame_locked": true, "metadata": [], "arrows": [], "cubes": [], "spheres": [],
        "cylinders": [], "lines": [], "triangles": [], "texts": [], "models": [],
    });
    entity[kind] = Value::Array(primitives);
    entity
}

/// A cylinder about the segment.
fn rod(start: &Point3<f64>, end: &Point3<f64>, radius: f64, rgba: [f64; 4]) -> Value {
    let along = end - start;
    let rotation = UnitQuaternion::rotation_between(&Vector3::z(), &along)
        .unwrap_or_else(|| UnitQuaternion::from_axis_angle(&Vector3::x_axis(), PI));
    let place = Isometry3::from_parts(nalgebra::center(start, end).coords.into(), rotation);
    json!({
        "pose": pose(&place),
        "size": vector(&Vector3::new(2.0 * radius, 2.0 * radius, along.norm())),
        "bottom_scale": 1.0, "top_scale": 1.0,
        "color": color(rgba),
    })
}

pub(super) fn scene(plan: &RobotPlan, robot: &Robot) -> Value {
    let mut entities = Vec::new();
    let frame = &plan.frame_id;
    for (apple, id) in plan.scene.apples().iter().zip(&plan.apples) {
        let place = Isometry3::translation(apple.center.x, apple.center.y, apple.center.z);
        let size = Vector3::repeat(2.0 * apple.radius);
        let solid =
            |rgba| json!({"pose": pose(&place), "size": vector(&size), "color": color(rgba)});
        entities.push(entity(
            frame,
            &format!("apple_{id}"),
            "spheres",
            vec![solid(APPLE)],
        ));
        entities.push(entity(
            frame,
            &format!("box_{id}"),
            "cubes",
            vec![solid(BOX)],
        ));
    }
    for (branch, id) in plan.scene.branches().iter().zip(&plan.branches) {
        let rod = rod(
            &branch.segment.start,
            &branch.segment.end,
            branch.radius,
            BRANCH,
        );
        entities.push(entity(
            frame,
            &format!("branch_{id}"),
            "cylinders",
            vec![rod],
        ));
    }
    for (id, approach) in ros::ranked(plan) {
        let samples = approach.path.samples(robot.config().motion.samples);
        let points: Vec<Value> = samples.iter().map(|s| vector(&s.position.coords)).collect();
        let line = json!({
            "type": 0, "pose": pose(&Isometry3::identity()), "thickness": LINE_M, "scale_invariant": false,
            "points": points, "color": color(PATH), "colors": [], "indices": [],
        });
        entities.push(entity(frame, &format!("path_{id}"), "lines", vec![line]));
        let parts = robot.config().gripper.capsules();
        let rods = parts
            .iter()
            .map(|(start, end, radius)| rod(start, end, *radius, GRIPPER));
        let tool = format!("tool_{id}");
        entities.push(entity(
            &tool,
            &format!("gripper_{id}"),
            "cylinders",
            rods.collect(),
        ));
    }
    json!({"deletions": [], "entities": entities})
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_of_the_standard() {
        // RFC 4648, section 10.
        for (text, code) in [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foo", "Zm9v"),
            ("foobar", "Zm9vYmFy"),
        ] {
            assert_eq!(base64(text.as_bytes()), code);
        }
    }

    #[test]
    fn times_are_split() {
        assert_eq!(time(1.25), json!({"sec": 1, "nsec": 250_000_000}));
    }
}
