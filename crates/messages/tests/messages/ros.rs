//! Messages field by field against the definitions of ROS 2 and `MoveIt`.

use crate::lab::{config, lab, planned};
use pomona_messages::ros;
use serde_json::Value;

/// Public definitions of ROS 2 (`common_interfaces`, `rcl_interfaces`, `moveit_msgs`, Jazzy): the
/// message, then type and name of each field.
const DEFINITIONS: &[(&str, &[(&str, &str)])] = &[
    ("Time", &[("int32", "sec"), ("uint32", "nanosec")]),
    ("Duration", &[("int32", "sec"), ("uint32", "nanosec")]),
    ("Header", &[("Time", "stamp"), ("string", "frame_id")]),
    (
        "Point",
        &[("float64", "x"), ("float64", "y"), ("float64", "z")],
    ),
    (
        "Point32",
        &[("float32", "x"), ("float32", "y"), ("float32", "z")],
    ),
    (
        "Vector3",
        &[("float64", "x"), ("float64", "y"), ("float64", "z")],
    ),
    (
        "Quaternion",
        &[
            ("float64", "x"),
            ("float64", "y"),
            ("float64", "z"),
            ("float64", "w"),
        ],
    ),
    (
        "Pose",
        &[("Point", "position"), ("Quaternion", "orientation")],
    ),
    ("PoseStamped", &[("Header", "header"), ("Pose", "pose")]),
    ("PoseArray", &[("Header", "header"), ("Pose[]", "poses")]),
    (
        "Vector3Stamped",
        &[("Header", "header"), ("Vector3", "vector")],
    ),
    ("Polygon", &[("Point32[]", "points")]),
    (
        "JointTrajectoryPoint",
        &[
            ("float64[]", "positions"),
            ("float64[]", "velocities"),
            ("float64[]", "accelerations"),
            ("float64[]", "effort"),
            ("Duration", "time_from_start"),
        ],
    ),
    (
        "JointTrajectory",
        &[
            ("Header", "header"),
            ("string[]", "joint_names"),
            ("JointTrajectoryPoint[]", "points"),
        ],
    ),
    (
        "GripperTranslation",
        &[
            ("Vector3Stamped", "direction"),
            ("float32", "desired_distance"),
            ("float32", "min_distance"),
        ],
    ),
    (
        "Grasp",
        &[
            ("string", "id"),
            ("JointTrajectory", "pre_grasp_posture"),
            ("JointTrajectory", "grasp_posture"),
            ("PoseStamped", "grasp_pose"),
            ("float64", "grasp_quality"),
            ("GripperTranslation", "pre_grasp_approach"),
            ("GripperTranslation", "post_grasp_retreat"),
            ("GripperTranslation", "post_place_retreat"),
            ("float32", "max_contact_force"),
            ("string[]", "allowed_touch_objects"),
        ],
    ),
    ("ObjectType", &[("string", "key"), ("string", "db")]),
    (
        "SolidPrimitive",
        &[
            ("uint8", "type"),
            ("float64[<=3]", "dimensions"),
            ("Polygon", "polygon"),
        ],
    ),
    (
        "CollisionObject",
        &[
            ("Header", "header"),
            ("Pose", "pose"),
            ("string", "id"),
            ("ObjectType", "type"),
            ("SolidPrimitive[]", "primitives"),
            ("Pose[]", "primitive_poses"),
            ("Mesh[]", "meshes"),
            ("Pose[]", "mesh_poses"),
            ("Plane[]", "planes"),
            ("Pose[]", "plane_poses"),
            ("string[]", "subframe_names"),
            ("Pose[]", "subframe_poses"),
            ("byte", "operation"),
        ],
    ),
    // Of these two what a diff sets; the others keep their defaults.
    (
        "PlanningSceneWorld",
        &[("CollisionObject[]", "collision_objects")],
    ),
    (
        "PlanningScene",
        &[("PlanningSceneWorld", "world"), ("bool", "is_diff")],
    ),
];

/// Holds a value against a type's definition, field by field.
fn check(value: &Value, kind: &str, place: &str) {
    if let Some((element, bound)) = kind.split_once('[') {
        let list = value
            .as_array()
            .unwrap_or_else(|| panic!("{place}: no list"));
        if let Some(most) = bound.trim_end_matches(']').strip_prefix("<=") {
            assert!(list.len() <= most.parse().unwrap(), "{place}");
        }
        for (i, value) in list.iter().enumerate() {
            check(value, element, &format!("{place}/{i}"));
        }
        return;
    }
    let fits = match kind {
        // A float with a point: rosidl refuses an integer for a float.
        "float64" | "float32" => value.is_f64(),
        "int32" => value.as_i64().is_some_and(|v| i32::try_from(v).is_ok()),
        "uint32" => value.as_u64().is_some_and(|v| u32::try_from(v).is_ok()),
        "uint8" | "byte" => value.as_u64().is_some_and(|v| v < 256),
        "string" => value.is_string(),
        "bool" => value.is_boolean(),
        _ => {
            let (_, fields) = DEFINITIONS
                .iter()
                .find(|(name, _)| *name == kind)
                .unwrap_or_else(|| panic!("{place}: {kind}"));
            let map = value
                .as_object()
                .unwrap_or_else(|| panic!("{place}: no map"));
            let mut found: Vec<_> = map.keys().map(String::as_str).collect();
            let mut wanted: Vec<_> = fields.iter().map(|(_, name)| *name).collect();
            found.sort_unstable();
            wanted.sort_unstable();
            assert_eq!(found, wanted, "{place}");
            for (kind, name) in *fields {
                check(&map[*name], kind, &format!("{place}/{name}"));
            }
            true
        }
    };
    assert!(fits, "{place}: {value} is no {kind}");
}

#[test]
fn messages_have_the_fields_of_their_definitions() {
    let config = config();
    let (_, plan) = planned(&lab(), &config);
    let (id, approach) = pomona_messages::ranked(&plan).next().unwrap();
    let value = |m: Result<Value, serde_json::Error>| m.unwrap();
    let grasp = ros::grasp(&plan, id, approach, &config);
    check(&value(serde_json::to_value(&grasp)), "Grasp", "grasp");
    let poses = ros::grasps(&plan, &config);
    check(&value(serde_json::to_value(&poses)), "PoseArray", "grasps");
    let pose = ros::pose_stamped(&plan, &approach.grasp);
    check(&value(serde_json::to_value(&pose)), "PoseStamped", "pose");
    let scene = ros::planning_scene(&plan);
    check(
        &value(serde_json::to_value(&scene)),
        "PlanningScene",
        "scene",
    );
    assert_eq!(
        scene.world.collision_objects.len(),
        2,
        "the apple and its branch"
    );
    assert_eq!(scene.world.collision_objects[1].primitives[0].kind, 3);
}

#[test]
fn a_refused_apple_has_no_grasp() {
    let mut small = config();
    small.gripper.jaw_width_m = 0.04;
    let (_, plan) = planned(&lab(), &small);
    assert!(ros::grasps(&plan, &small).poses.is_empty());
}

#[test]
fn files_say_the_same_as_the_messages() {
    let config = config();
    let (answer, plan) = planned(&lab(), &config);
    let files = ros::files(&plan, &config);
    let names: Vec<_> = files.iter().map(|f| f.name.as_str()).collect();
    let wanted = [
        "ros-grasps.yaml",
        "ros-scene.yaml",
        "ros-pregrasp-0.yaml",
        "ros-pose-0.yaml",
        "ros-grasp-0.yaml",
    ];
    assert_eq!(names, wanted);
    let apple = answer.apples[0].plan.as_ref().unwrap();
    let wrist = &apple.approach.as_ref().unwrap().wrist.translation.vector;
    for (axis, value) in ["x", "y", "z"].iter().zip(wrist.iter()) {
        let numbers: Vec<f64> = files[3]
            .text
            .lines()
            .filter_map(|l| l.trim().strip_prefix(&format!("{axis}: ")))
            .map(|n| n.parse().unwrap())
            .collect();
        assert!(numbers.iter().any(|n| (n - value).abs() < 1e-8), "{axis}");
    }
    for file in &files {
        assert!(
            !file.text.contains("e-") && !file.text.contains("null"),
            "{}",
            file.name
        );
    }
}
