//! The messages, each with all the fields of its definition, unless it says otherwise.

use nalgebra::Isometry3;
use serde::Serialize;

/// `builtin_interfaces/Time`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Time {
    /// Seconds.
    pub sec: i32,
    /// Nanoseconds.
    pub nanosec: u32,
}

/// `builtin_interfaces/Duration`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Duration {
    /// Seconds.
    pub sec: i32,
    /// Nanoseconds.
    pub nanosec: u32,
}

/// `std_msgs/Header`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Header {
    /// Time.
    pub stamp: Time,
    /// Frame of the data.
    pub frame_id: String,
}

/// `geometry_msgs/Point`, metres.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Point {
    /// x.
    pub x: f64,
    /// y.
    pub y: f64,
    /// z.
    pub z: f64,
}

/// `geometry_msgs/Vector3`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Vector3 {
    /// x.
    pub x: f64,
    /// y.
    pub y: f64,
    /// z.
    pub z: f64,
}

impl From<[f64; 3]> for Vector3 {
    fn from([x, y, z]: [f64; 3]) -> Self {
        Self { x, y, z }
    }
}

/// `geometry_msgs/Quaternion`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Quaternion {
    /// x.
    pub x: f64,
    /// y.
    pub y: f64,
    /// z.
    pub z: f64,
    /// w.
    pub w: f64,
}

/// `geometry_msgs/Pose`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Pose {
    /// Place.
    pub position: Point,
    /// Orientation.
    pub orientation: Quaternion,
}

impl From<&Isometry3<f64>> for Pose {
    fn from(pose: &Isometry3<f64>) -> Self {
        let (t, q) = (pose.translation.vector, pose.rotation.coords);
        Self {
            position: Point {
                x: t.x,
                y: t.y,
                z: t.z,
            },
            orientation: Quaternion {
                x: q.x,
                y: q.y,
                z: q.z,
                w: q.w,
            },
        }
    }
}

/// `geometry_msgs/PoseStamped`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PoseStamped {
    /// Frame and time.
    pub header: Header,
    /// The pose.
    pub pose: Pose,
}

/// `geometry_msgs/PoseArray`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PoseArray {
    /// Frame and time.
    pub header: Header,
    /// The poses.
    pub poses: Vec<Pose>,
}

/// `geometry_msgs/Vector3Stamped`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Vector3Stamped {
    /// Frame and time.
    pub header: Header,
    /// The vector.
    pub vector: Vector3,
}

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
    /// One joint at a position, after a second.
    pub fn at(position: f64) -> Self {
        Self {
            positions: vec![position],
            velocities: Vec::new(),
            accelerations: Vec::new(),
            effort: Vec::new(),
            time_from_start: Duration { sec: 1, nanosec: 0 },
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
    /// Whereto.
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

/// `geometry_msgs/Polygon`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Polygon {
    /// None here.
    pub points: Vec<Point>,
}

/// `shape_msgs/SolidPrimitive`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SolidPrimitive {
    /// 2 for a sphere, 3 for a cylinder.
    #[serde(rename = "type")]
    pub kind: u8,
    /// Radius of a sphere; height and radius of a cylinder along z.
    pub dimensions: Vec<f64>,
    /// For prisms.
    pub polygon: Polygon,
}

impl SolidPrimitive {
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
        Self::new(2, vec![radius])
    }

    /// A cylinder along z, metres.
    pub fn cylinder(height: f64, radius: f64) -> Self {
        Self::new(3, vec![height, radius])
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
    /// 0: add.
    pub operation: u8,
}

impl CollisionObject {
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
            operation: 0,
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
