//! A frame's plan as messages of ROS 2 and `MoveIt`, in YAML that `ros2 topic pub` takes.
//!
//! ```sh
//! ros2 topic pub -1 /pomona/grasps geometry_msgs/msg/PoseArray "$(cat out/ros-grasps.yaml)"
//! ros2 topic pub -1 /planning_scene moveit_msgs/msg/PlanningScene "$(cat out/ros-scene.yaml)"
//! ```
//!
//! Time stamps are 0, which means 'latest' to tf2: a file does not know when it is published. Poses are
//! those of the wrist link, which is what arms are commanded by; lengths in metres, in the
//! robot's frame.

mod geometry;
mod moveit;
mod yaml;

pub use geometry::{
    Duration, Header, Point, Polygon, Pose, PoseArray, PoseStamped, Quaternion, Time, Vector3,
    Vector3Stamped,
};
pub use moveit::{
    CollisionObject, Grasp, GripperTranslation, JointTrajectory, JointTrajectoryPoint, Mesh,
    ObjectType, Plane, PlanningScene, PlanningSceneWorld, SolidPrimitive,
};
pub use yaml::to_yaml;

use crate::order::ranked;
use crate::pose::along_z;
use nalgebra::Isometry3;
use pomona::RobotPlan;
use pomona_approach::{Approach, ApproachConfig};

/// One message as a file.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct MessageFile {
    /// Name, such as `ros-grasp-3.yaml`.
    pub name: String,
    /// The message in YAML.
    pub text: String,
}

/// All messages of a plan as files.
///
/// `ros-grasps.yaml` (`geometry_msgs/PoseArray`: the grasps in the picking order),
/// `ros-scene.yaml` (`moveit_msgs/PlanningScene`, a diff that adds apples and branches), and for each
/// ranked pick with id N `ros-pregrasp-N.yaml` and `ros-pose-N.yaml` (`geometry_msgs/PoseStamped`) and
/// `ros-grasp-N.yaml` (`moveit_msgs/Grasp`).
pub fn files(plan: &RobotPlan, config: &ApproachConfig) -> Vec<MessageFile> {
    let file = |name: &str, text: String| MessageFile {
        name: format!("ros-{name}.yaml"),
        text,
    };
    let mut files = vec![
        file("grasps", to_yaml(&grasps(plan, config))),
        file("scene", to_yaml(&planning_scene(plan))),
    ];
    for (id, approach) in ranked(plan) {
        let pose = |pose| to_yaml(&pose_stamped(plan, &config.gripper.wrist_pose(pose)));
        files.push(file(&format!("pregrasp-{id}"), pose(&approach.pre_grasp)));
        files.push(file(&format!("pose-{id}"), pose(&approach.grasp)));
        let grasp = grasp(plan, id, approach, config);
        files.push(file(&format!("grasp-{id}"), to_yaml(&grasp)));
    }
    files
}

/// The wrist's poses at the apples, in the picking order.
pub fn grasps(plan: &RobotPlan, config: &ApproachConfig) -> PoseArray {
    let poses = ranked(plan).map(|(_, a)| Pose::from(&config.gripper.wrist_pose(&a.grasp)));
    PoseArray {
        header: header(plan),
        poses: poses.collect(),
    }
}

/// One pose in the robot's frame.
pub fn pose_stamped(plan: &RobotPlan, pose: &Isometry3<f64>) -> PoseStamped {
    PoseStamped {
        header: header(plan),
        pose: Pose::from(pose),
    }
}

/// A `MoveIt` grasp of the pick with this id.
///
/// The postures move one joint, `gripper`, whose position is the opening in metres: rename and
/// scale it to that of your gripper. The quality is the slack of the clearance over its cutoff, 0 to 1.
pub fn grasp(plan: &RobotPlan, id: usize, approach: &Approach, config: &ApproachConfig) -> Grasp {
    let along: [f64; 3] = approach.direction.vector().into();
    let radius = plan
        .scene
        .apples()
        .get(approach.apple)
        .map_or(0.0, |apple| apple.radius);
    let translation = |sign: f64, distance: f64| GripperTranslation {
        direction: Vector3Stamped {
            header: header(plan),
            vector: Vector3::from(along.map(|c| sign * c)),
        },
        desired_distance: distance,
        // The path is free over its whole length, and a shorter one does not detach an apple.
        min_distance: distance,
    };
    let posture = |opening: f64| JointTrajectory {
        header: header(plan),
        joint_names: vec!["gripper".to_owned()],
        points: vec![JointTrajectoryPoint::at(opening)],
    };
    let back = translation(-1.0, config.motion.retreat_m);
    let quality = approach.clearance.slack_m() / config.clearance.cutoff_m;
    Grasp {
        id: format!("apple_{id}"),
        pre_grasp_posture: posture(config.gripper.jaw_width_m),
        grasp_posture: posture(2.0 * radius),
        grasp_pose: pose_stamped(plan, &config.gripper.wrist_pose(&approach.grasp)),
        grasp_quality: quality.clamp(0.0, 1.0),
        pre_grasp_approach: translation(1.0, approach.standoff_m),
        post_grasp_retreat: back.clone(),
        post_place_retreat: back,
        max_contact_force: 0.0,
        allowed_touch_objects: vec![format!("apple_{id}")],
    }
}

/// The apples as spheres and the branches as cylinders, to be added to a planning scene.
pub fn planning_scene(plan: &RobotPlan) -> PlanningScene {
    let mut collision_objects = Vec::new();
    for (apple, id) in plan.scene.apples().iter().zip(&plan.apples) {
        let pose = Isometry3::from_parts(apple.center.coords.into(), nalgebra::one());
        collision_objects.push(CollisionObject::solid(
            header(plan),
            format!("apple_{id}"),
            Pose::from(&pose),
            SolidPrimitive::sphere(apple.radius),
        ));
    }
    for (branch, id) in plan.scene.branches().iter().zip(&plan.branches) {
        let (pose, length) = along_z(&branch.segment.start, &branch.segment.end);
        collision_objects.push(CollisionObject::solid(
            header(plan),
            format!("branch_{id}"),
            Pose::from(&pose),
            // A branch has hemispheres at its ends, which the cylinder covers.
            SolidPrimitive::cylinder(length + 2.0 * branch.radius, branch.radius),
        ));
    }
    PlanningScene {
        is_diff: true,
        world: PlanningSceneWorld { collision_objects },
    }
}

fn header(plan: &RobotPlan) -> Header {
    Header {
        stamp: Time { sec: 0, nanosec: 0 },
        frame_id: plan.frame_id.clone(),
    }
}
