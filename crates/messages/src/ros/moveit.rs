//! Messages of `trajectory_msgs`, `shape_msgs`, `object_recognition_msgs` and `moveit_msgs`, each with all the fields of
//! its definition, unless it says otherwise.

use super::geometry::{Duration, Header, Polygon, Pose, PoseStamped, Vector3Stamped};
use nalgebra::Isometry3;
use serde::Serialize;

/// When a gripper has reached the position of its only trajectory point, seconds after the start.
const POSTURE_TIME_S: i32 = 1;

/// `trajectory_msgs/JointTrajectoryPoint`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct JointTrajectoryPoint {
    /// One for each joint.
    pub positions: Vec<f64>,
    /// None here.
    pub velocities: Vec<f64>,
    /// None here.
    pub accelerations: Vec<f64>,
    /// None here.
    pub effort: Vec<f64>,
    /// Since the start.
    pub time_from_start: Duration,
}

impl JointTrajectoryPoint {
    /// One joint at a position, a second after the start.
    pub fn at(position: f64) -> Self {
        Self {
            positions: vec![position],
            velocities: Vec::new(),
            accelerations: Vec::new(),
            effort: Vec::new(),
            time_from_start: Duration {
                sec: POSTURE_TIME_S,
                nanosec: 0,
            },
        }
    }
}

/// `trajectory_msgs/JointTrajectory`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct JointTrajectory {
    /// Frame and time.
    pub header: Header,
    /// The joints.
    pub joint_names: Vec<String>,
    /// The positions.
    pub points: Vec<JointTrajectoryPoint>,
}

/// `moveit_msgs/GripperTranslation`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct GripperTranslation {
    /// In which direction.
    pub direction: Vector3Stamped,
    /// How far, metres.
    pub desired_distance: f64,
    /// How far at least, metres.
    pub min_distance: f64,
}

/// `moveit_msgs/Grasp`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Grasp {
    /// Its name.
    pub id: String,
    /// The open gripper.
    pub pre_grasp_posture: JointTrajectory,
    /// The closed gripper.
    pub grasp_posture: JointTrajectory,
    /// The wrist link at the apple.
    pub grasp_pose: PoseStamped,
    /// How good it is.
    pub grasp_quality: f64,
    /// The straight approach.
    pub pre_grasp_approach: GripperTranslation,
    /// The retreat with the apple.
    pub post_grasp_retreat: GripperTranslation,
    /// The retreat after letting go.
    pub post_place_retreat: GripperTranslation,
    /// 0: not limited.
    pub max_contact_force: f64,
    /// What may be touched.
    pub allowed_touch_objects: Vec<String>,
}

/// `object_recognition_msgs/ObjectType`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ObjectType {
    /// Name in a database.
    pub key: String,
    /// The database.
    pub db: String,
}

/// `shape_msgs/SolidPrimitive`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SolidPrimitive {
    /// [`SPHERE`](Self::SPHERE) or [`CYLINDER`](Self::CYLINDER).
    #[serde(rename = "type")]
    pub kind: u8,
    /// Radius of a sphere; height and radius of a cylinder along z.
    pub dimensions: Vec<f64>,
    /// For prisms.
    pub polygon: Polygon,
}

impl SolidPrimitive {
    /// Type of a sphere.
    pub const SPHERE: u8 = 2;
    /// Type of a cylinder.
    pub const CYLINDER: u8 = 3;

    fn new(kind: u8, dimensions: Vec<f64>) -> Self {
        let polygon = Polygon { points: Vec::new() };
        Self {
            kind,
            dimensions,
            polygon,
        }
    }

    /// A sphere of this radius, metres.
    pub fn sphere(radius: f64) -> Self {
        Self::new(Self::SPHERE, vec![radius])
    }

    /// A cylinder along z, metres.
    pub fn cylinder(height: f64, radius: f64) -> Self {
        Self::new(Self::CYLINDER, vec![height, radius])
    }
}

/// `shape_msgs/Mesh`; none is ever written.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Mesh {}

/// `shape_msgs/Plane`; none is ever written.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Plane {}

/// `moveit_msgs/CollisionObject`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CollisionObject {
    /// Frame and time.
    pub header: Header,
    /// Where the object is.
    pub pose: Pose,
    /// Its name.
    pub id: String,
    /// Its type.
    #[serde(rename = "type")]
    pub object_type: ObjectType,
    /// Its solid shapes.
    pub primitives: Vec<SolidPrimitive>,
    /// Where they are in the object.
    pub primitive_poses: Vec<Pose>,
    /// None here.
    pub meshes: Vec<Mesh>,
    /// None here.
    pub mesh_poses: Vec<Pose>,
    /// None here.
    pub planes: Vec<Plane>,
    /// None here.
    pub plane_poses: Vec<Pose>,
    /// None here.
    pub subframe_names: Vec<String>,
    /// None here.
    pub subframe_poses: Vec<Pose>,
    /// [`ADD`](Self::ADD).
    pub operation: u8,
}

impl CollisionObject {
    /// Operation that adds the object to the scene.
    pub const ADD: u8 = 0;

    /// An object of one shape, to be added.
    pub fn solid(header: Header, id: String, pose: Pose, shape: SolidPrimitive) -> Self {
        Self {
            header,
            pose,
            id,
            object_type: ObjectType {
                key: String::new(),
                db: String::new(),
            },
            primitives: vec![shape],
            primitive_poses: vec![Pose::from(&Isometry3::identity())],
            meshes: Vec::new(),
            mesh_poses: Vec::new(),
            planes: Vec::new(),
            plane_poses: Vec::new(),
            subframe_names: Vec::new(),
            subframe_poses: Vec::new(),
            operation: Self::ADD,
        }
    }
}

/// `moveit_msgs/PlanningSceneWorld`, without its octomap, which stays as it is.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PlanningSceneWorld {
    /// The objects.
    pub collision_objects: Vec<CollisionObject>,
}

/// `moveit_msgs/PlanningScene`, without the fields that a diff leaves as they are.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PlanningScene {
    /// What is added.
    pub world: PlanningSceneWorld,
    /// True: nothing else changes.
    pub is_diff: bool,
}
