use nalgebra::{Isometry3, Vector3};
use pomona_approach::{Approach, Clearance, Gripper, Obstacle, Path, Rank, Refusal};
use serde::{Deserialize, Serialize};

/// What the robot's side adds to a pick, in the robot's frame; absent where no robot was configured,
/// or where it is not known. Metres, radians, seconds.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PlanRecord {
    /// Where the gripper holds the apple.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gripper: Option<GripperRecord>,
    /// How it gets there and away, or why it does not.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub approach: Option<ApproachRecord>,
    /// What it comes nearest to, or collides with.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clearance: Option<ClearanceRecord>,
    /// When its turn comes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub order: Option<OrderRecord>,
}

/// A pose in the robot's frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PoseRecord {
    /// Place of the origin.
    pub position: [f64; 3],
    /// Orientation of the axes, x y z w with w ≥ 0.
    pub quaternion_xyzw: [f64; 4],
}

impl From<&Isometry3<f64>> for PoseRecord {
    fn from(pose: &Isometry3<f64>) -> Self {
        Self {
            position: pose.translation.vector.into(),
            quaternion_xyzw: canonical(pose.rotation.coords.into()),
        }
    }
}

/// Of the two quaternions of a rotation the one with w ≥ 0.
fn canonical(q: [f64; 4]) -> [f64; 4] {
    let leading = [q[3], q[0], q[1], q[2]].into_iter().find(|c| *c != 0.0);
    if leading.is_some_and(|c| c < 0.0) {
        q.map(|c| 0.0 - c)
    } else {
        q
    }
}

/// Where the gripper holds the apple.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GripperRecord {
    /// Name of the robot's frame.
    pub frame_id: String,
    /// Pose of the tool frame: its origin at the apple's centre, +x the approach, y the opening.
    pub tool: PoseRecord,
    /// Pose of the wrist link.
    pub wrist: PoseRecord,
    /// Turn of the tool about its approach, from the orientation with RX = 0.
    pub roll: f64,
    /// Opening that the apple needs, margins included.
    pub needed_width: f64,
    /// Opening of the gripper.
    pub width: f64,
}

/// How the gripper gets to the apple and away, or why it does not.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ApproachRecord {
    /// `free`; `blocked` where apples must go first that cannot; or the reason of refusal:
    /// `unreachable_from_behind`, `out_of_reach`, `collision`, `gripper_too_small`.
    pub status: String,
    /// The refusal in words.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
    /// The way; absent where refused.
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    pub way: Option<WayRecord>,
}

/// The way to an apple and back.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct WayRecord {
    /// Direction of approach, a unit vector: the pick's, tilted.
    pub direction: [f64; 3],
    /// Which candidate direction it comes from.
    pub candidate: usize,
    /// Angle to that candidate.
    pub tilt: f64,
    /// How many ways were tried.
    pub tried: usize,
    /// From pre-grasp to grasp.
    pub standoff: f64,
    /// Pose of the tool before the straight approach.
    pub pre_grasp: PoseRecord,
    /// And after the retreat.
    pub retreat: PoseRecord,
    /// The path of the tool.
    pub path: PathRecord,
}

/// A path of quintics.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PathRecord {
    /// When the tool passes the pre-grasp.
    pub pre_grasp_s: f64,
    /// When it rests at the apple.
    pub grasp_s: f64,
    /// When it rests after the retreat.
    pub duration_s: f64,
    /// Its parts, each continuing the one before to the second derivative.
    pub pieces: Vec<PieceRecord>,
    /// The place and orientation at equal steps of time.
    pub samples: Vec<SampleRecord>,
}

/// One quintic: the position is Σ `coefficients[k]` (t − `start_s`)ᵏ.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PieceRecord {
    /// `transit`, `approach` or `retreat`.
    pub stage: String,
    /// When it begins.
    pub start_s: f64,
    /// How long it takes.
    pub duration_s: f64,
    /// Six vectors, in metres per secondᵏ.
    pub coefficients: [[f64; 3]; 6],
}

/// The tool at one time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SampleRecord {
    /// Since the start of the path.
    pub time_s: f64,
    /// Place of the tool's origin.
    pub position: [f64; 3],
    /// Per second.
    pub velocity: [f64; 3],
    /// Per second squared.
    pub acceleration: [f64; 3],
    /// Orientation, x y z w; of the two signs the one nearer to the sample before.
    pub quaternion_xyzw: [f64; 4],
    /// Radians per second, in the robot's frame.
    pub angular_velocity: [f64; 3],
}

/// What the gripper comes nearest to, over the whole path.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ClearanceRecord {
    /// Signed distance of the surfaces, negative where they overlap; for a free path a lower bound.
    pub distance: f64,
    /// The least distance that was asked for.
    pub margin: f64,
    /// `apple`, `branch`, `cloud`, or `none` where nothing is near.
    pub obstacle: String,
    /// The pick whose apple or branch it is.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub id: Option<usize>,
    /// Its nearest point: at its centre, on its axis, or in the cloud.
    pub point: [f64; 3],
    /// When, since the start of the path.
    pub time_s: f64,
    /// `transit`, `approach` or `retreat`.
    pub stage: String,
}

/// The place of a pick in the order.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct OrderRecord {
    /// From 0, the first to be picked.
    pub rank: usize,
    /// `unobstructed`, `after_blockers` or `cycle_broken`.
    pub reason: String,
    /// Ids of the picks that must go before.
    pub blockers: Vec<usize>,
}

impl GripperRecord {
    pub(crate) fn new(approach: &Approach, gripper: &Gripper, radius: f64, frame: &str) -> Self {
        Self {
            frame_id: frame.to_owned(),
            tool: PoseRecord::from(&approach.grasp),
            wrist: PoseRecord::from(&gripper.wrist_pose(&approach.grasp)),
            roll: approach.roll_rad,
            needed_width: gripper.needed_for(radius).0,
            width: gripper.jaw_width_m,
        }
    }
}

impl ApproachRecord {
    pub(crate) fn refused(refusal: &Refusal) -> Self {
        Self {
            status: refusal.name().to_owned(),
            reason: Some(refusal.to_string()),
            way: None,
        }
    }

    pub(crate) fn new(approach: &Approach, samples: usize) -> Self {
        let free = approach.clearance.slack_m() >= 0.0;
        Self {
            status: if free { "free" } else { "blocked" }.to_owned(),
            reason: None,
            way: Some(WayRecord {
                direction: approach.direction.vector().into(),
                candidate: approach.candidate,
                tilt: approach.tilt_rad,
                tried: approach.tried,
                standoff: approach.standoff_m,
                pre_grasp: PoseRecord::from(&approach.pre_grasp),
                retreat: PoseRecord::from(&approach.retreat),
                path: PathRecord::new(&approach.path, samples),
            }),
        }
    }
}

impl PathRecord {
    fn new(path: &Path, samples: usize) -> Self {
        let pieces = path.pieces().iter().map(|piece| PieceRecord {
            stage: piece.stage.name().to_owned(),
            start_s: piece.start_s,
            duration_s: piece.curve.duration_s,
            coefficients: piece.curve.coefficients.map(|c| Vector3::from(c).into()),
        });
        let mut before: Option<[f64; 4]> = None;
        let samples = path.samples(samples).into_iter().map(|sample| {
            let q: [f64; 4] = sample.rotation.coords.into();
            let q = match before {
                Some(b) if q.iter().zip(b).map(|(a, b)| a * b).sum::<f64>() < 0.0 => q.map(|c| -c),
                Some(_) => q,
                None => canonical(q),
            };
            before = Some(q);
            SampleRecord {
                time_s: sample.time_s,
                position: sample.position.into(),
                velocity: sample.velocity.into(),
                acceleration: sample.acceleration.into(),
                quaternion_xyzw: q,
                angular_velocity: sample.angular_velocity.into(),
            }
        });
        Self {
            pre_grasp_s: path.pre_grasp_s(),
            grasp_s: path.grasp_s(),
            duration_s: path.duration_s(),
            pieces: pieces.collect(),
            samples: samples.collect(),
        }
    }
}

impl ClearanceRecord {
    /// `apples` and `branches` are the picks that those of the scene come from.
    pub(crate) fn new(clearance: &Clearance, apples: &[usize], branches: &[usize]) -> Self {
        let (obstacle, id) = match clearance.obstacle {
            Some(Obstacle::Apple(i)) => ("apple", apples.get(i).copied()),
            Some(Obstacle::Branch(i)) => ("branch", branches.get(i).copied()),
            Some(Obstacle::Cloud) => ("cloud", None),
            None => ("none", None),
        };
        Self {
            distance: clearance.distance_m,
            margin: clearance.margin_m,
            obstacle: obstacle.to_owned(),
            id,
            point: clearance.point_m,
            time_s: clearance.time_s,
            stage: clearance.stage.name().to_owned(),
        }
    }
}

impl OrderRecord {
    /// `targets` are the picks that the order's targets come from.
    pub(crate) fn new(rank: usize, entry: &Rank, targets: &[usize]) -> Self {
        let id = |&target: &usize| targets.get(target).copied();
        Self {
            rank,
            reason: entry.reason.name().to_owned(),
            blockers: entry.blockers.iter().filter_map(id).collect(),
        }
    }
}
