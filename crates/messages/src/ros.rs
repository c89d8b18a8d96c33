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

mod messages;
mod yaml;

pub use messages::{
    CollisionObject, Duration, Grasp, GripperTranslation, Header, JointTrajectory,
    JointTrajectoryPoint, Mesh, ObjectType, Plane, PlanningScene, PlanningSceneWorld, Point,
    Polygon, Pose, PoseArray, PoseStamped, Quaternion, SolidPrimitive, Time, Vector3,
    Vector3Stamped,
};
pub use yaml::to_yaml;

use nalgebra::{Isometry3, UnitQuaternion};
use pomona::RobotPlan;
use pomona_approach::{Approach, ApproachConfig};

/// One file: its name and its text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct File {
    /// Name, such as `ros-grasp-3.yaml`.
    pub name: String,
    /// The message in YAML.
    pub text: String,
}

/// All messages of a plan as files.
///
/// `ros-grasps.yaml` (`geometry_msgs/PoseArray`: the grasps in the order of picking),
/// `ros-scene.yaml` (`moveit_msgs/PlanningScene`, a diff that adds apples and branches), and for each
/// ranked pick with id N `ros-pregrasp-N.yaml` and `ros-pose-N.yaml` (`geometry_msgs/PoseStamped`) and
/// `ros-grasp-N.yaml` (`moveit_msgs/Grasp`).
pub fn files(plan: &RobotPlan, config: &ApproachConfig) -> Vec<File> {
    let file = |name: &str, text: String| File {
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

/// The picks' ids and approaches in the order of picking.
pub fn ranked(plan: &RobotPlan) -> impl Iterator<Item = (usize, &Approach)> {
    plan.order.ranks.iter().filter_map(|rank| {
        let approach = plan.order.approaches.get(rank.target)?.as_ref().ok()?;
        Some((*plan.targets.get(rank.target)?, approach))
    })
}

/// The wrist's poses at the apples, in the order of picking.
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
/// scale it to the gripper's own. The quality is the slack of the clearance over its cutoff, 0 to 1.
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
        // The way is known to be free over its whole length, and to no less an apple comes off.
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
        let place = Isometry3::translation(apple.center.x, apple.center.y, apple.center.z);
        collision_objects.push(CollisionObject::solid(
            header(plan),
            format!("apple_{id}"),
            Pose::from(&place),
            SolidPrimitive::sphere(apple.radius),
        ));
    }
    for (branch, id) in plan.scene.branches().iter().zip(&plan.branches) {
        let along = branch.segment.end - branch.segment.start;
        // Cylinders stand along z; a half turn about x where the branch points straight down.
        let rotation = UnitQuaternion::rotation_between(&nalgebra::Vector3::z(), &along)
            .unwrap_or_else(|| {
                UnitQuaternion::from_axis_angle(&nalgebra::Vector3::x_axis(), std::f64::consts::PI)
            });
        let middle = nalgebra::center(&branch.segment.start, &branch.segment.end);
        let place = Isometry3::from_parts(middle.coords.into(), rotation);
        collision_objects.push(CollisionObject::solid(
            header(plan),
            format!("branch_{id}"),
            Pose::from(&place),
            SolidPrimitive::cylinder(along.norm() + 2.0 * branch.radius, branch.radius),
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
