use crate::outcome::{ApplePlan, NearestObstacle, PlannedApproach, PlannedTurn};
use nalgebra::{Isometry3, Vector3};
use pomona_approach::{Obstacle, Path, PathPoint, Refusal};
use pomona_transforms::canonical_xyzw;
use serde::{Deserialize, Serialize};

/// What the robot's side adds to a pick, in the robot's frame; absent where no robot was configured,
/// or where it is not known. Metres, radians, seconds.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[non_exhaustive]
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
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[cfg_attr(test, schemars(deny_unknown_fields))]
#[non_exhaustive]
pub struct PoseRecord {
    /// Place of the origin.
    pub position: [f64; 3],
    /// Orientation of the axes, x y z w with w ≥ 0.
    #[cfg_attr(test, schemars(with = "pomona_schema::UnitQuaternion"))]
    pub quaternion_xyzw: [f64; 4],
}

impl From<&Isometry3<f64>> for PoseRecord {
    fn from(pose: &Isometry3<f64>) -> Self {
        Self {
            position: pose.translation.vector.into(),
            quaternion_xyzw: canonical_xyzw(&pose.rotation),
        }
    }
}

/// Where the gripper holds the apple.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[cfg_attr(test, schemars(deny_unknown_fields))]
#[non_exhaustive]
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
    #[cfg_attr(test, schemars(extend("exclusiveMinimum" = 0)))]
    pub needed_width: f64,
    /// Opening of the gripper.
    #[cfg_attr(test, schemars(extend("exclusiveMinimum" = 0)))]
    pub width: f64,
}

/// How the gripper gets to the apple and away, or why it does not.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[cfg_attr(
    test,
    schemars(
        deny_unknown_fields,
        extend(
            "if" = { "properties": { "status": { "enum": ["free", "blocked"] } } },
            "then" = { "required": [
                "direction", "candidate", "tilt", "tried", "standoff", "pre_grasp", "retreat", "path"
            ] },
            "else" = { "required": ["reason"], "properties": { "path": false } }
        )
    )
)]
#[non_exhaustive]
pub struct ApproachRecord {
    /// `free`; `blocked` where apples must go first that cannot; or the reason of refusal:
    /// `unreachable_from_behind`, `out_of_reach`, `collision`, `gripper_too_small`.
    #[cfg_attr(test, schemars(extend("enum" = ["free", "blocked", "unreachable_from_behind", "out_of_reach", "collision", "gripper_too_small", "no_target", "no_start"])))]
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
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct WayRecord {
    /// Direction of approach, a unit vector: the pick's, tilted.
    #[cfg_attr(test, schemars(with = "pomona_schema::UnitVector"))]
    pub direction: [f64; 3],
    /// Which candidate direction it comes from.
    pub candidate: usize,
    /// Angle to that candidate.
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub tilt: f64,
    /// How many ways were tried.
    #[cfg_attr(test, schemars(range(min = 1)))]
    pub tried: usize,
    /// From pre-grasp to grasp.
    #[cfg_attr(test, schemars(extend("exclusiveMinimum" = 0)))]
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
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[cfg_attr(test, schemars(deny_unknown_fields))]
#[non_exhaustive]
pub struct PathRecord {
    /// When the tool passes the pre-grasp.
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub pre_grasp_s: f64,
    /// When it rests at the apple.
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub grasp_s: f64,
    /// When it rests after the retreat.
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub duration_s: f64,
    /// Its parts, each continuing the one before to the second derivative.
    #[cfg_attr(test, schemars(length(min = 3)))]
    pub pieces: Vec<PieceRecord>,
    /// The place and orientation at equal steps of time.
    #[cfg_attr(test, schemars(length(min = 2)))]
    pub samples: Vec<SampleRecord>,
}

/// One quintic: the position is Σ `coefficients[k]` (t − `start_s`)ᵏ.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[cfg_attr(test, schemars(deny_unknown_fields))]
#[non_exhaustive]
pub struct PieceRecord {
    /// `transit`, `approach` or `retreat`.
    #[cfg_attr(test, schemars(extend("enum" = ["transit", "approach", "retreat"])))]
    pub stage: String,
    /// When it begins.
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub start_s: f64,
    /// How long it takes.
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub duration_s: f64,
    /// Six vectors, in metres per secondᵏ.
    pub coefficients: [[f64; 3]; 6],
}

/// The tool at one time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[cfg_attr(test, schemars(deny_unknown_fields))]
#[non_exhaustive]
pub struct SampleRecord {
    /// Since the start of the path.
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub time_s: f64,
    /// Place of the tool's origin.
    pub position: [f64; 3],
    /// Per second.
    pub velocity: [f64; 3],
    /// Per second squared.
    pub acceleration: [f64; 3],
    /// Orientation, x y z w; of the two signs the one nearer to the sample before.
    #[cfg_attr(test, schemars(with = "pomona_schema::UnitQuaternion"))]
    pub quaternion_xyzw: [f64; 4],
    /// Radians per second, in the robot's frame.
    pub angular_velocity: [f64; 3],
}

/// What the gripper comes nearest to, over the whole path.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[cfg_attr(test, schemars(deny_unknown_fields))]
#[non_exhaustive]
pub struct ClearanceRecord {
    /// Signed distance of the surfaces, negative where they overlap; for a free path a lower bound.
    pub distance: f64,
    /// The least distance that was asked for.
    pub margin: f64,
    /// `apple`, `branch`, `cloud`, or `none` where nothing is near.
    #[cfg_attr(test, schemars(extend("enum" = ["apple", "branch", "cloud", "none"])))]
    pub obstacle: String,
    /// The pick whose apple or branch it is.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub id: Option<usize>,
    /// Its nearest point: at its centre, on its axis, or in the cloud.
    pub point: [f64; 3],
    /// When, since the start of the path.
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub time_s: f64,
    /// `transit`, `approach` or `retreat`.
    #[cfg_attr(test, schemars(extend("enum" = ["transit", "approach", "retreat"])))]
    pub stage: String,
}

/// The place of a pick in the order.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[cfg_attr(test, schemars(deny_unknown_fields))]
#[non_exhaustive]
pub struct OrderRecord {
    /// From 0, the first to be picked.
    pub rank: usize,
    /// `unobstructed`, `after_blockers` or `cycle_broken`.
    #[cfg_attr(test, schemars(extend("enum" = ["unobstructed", "after_blockers", "cycle_broken"])))]
    pub reason: String,
    /// Ids of the picks that must go before.
    pub blockers: Vec<usize>,
}

impl From<&ApplePlan> for PlanRecord {
    fn from(plan: &ApplePlan) -> Self {
        let approach = plan.approach.as_ref();
        Self {
            gripper: approach
                .ok()
                .map(|planned| GripperRecord::new(planned, &plan.frame_id)),
            approach: Some(match approach {
                Ok(planned) => ApproachRecord::from(planned),
                Err(refusal) => ApproachRecord::from(refusal),
            }),
            clearance: plan.nearest.as_ref().map(ClearanceRecord::from),
            order: plan.turn.as_ref().map(OrderRecord::from),
        }
    }
}

impl GripperRecord {
    fn new(planned: &PlannedApproach, frame_id: &str) -> Self {
        Self {
            frame_id: frame_id.to_owned(),
            tool: PoseRecord::from(&planned.approach.grasp),
            wrist: PoseRecord::from(&planned.wrist),
            roll: planned.approach.roll_rad,
            needed_width: planned.needed_width_m,
            width: planned.jaw_width_m,
        }
    }
}

impl From<&Refusal> for ApproachRecord {
    fn from(refusal: &Refusal) -> Self {
        Self {
            status: refusal.name().to_owned(),
            reason: Some(refusal.to_string()),
            way: None,
        }
    }
}

impl From<&PlannedApproach> for ApproachRecord {
    fn from(planned: &PlannedApproach) -> Self {
        let approach = &planned.approach;
        Self {
            status: planned.status().to_owned(),
            reason: None,
            way: Some(WayRecord {
                direction: approach.direction.vector().into(),
                candidate: approach.candidate,
                tilt: approach.tilt_rad,
                tried: approach.tried,
                standoff: approach.standoff_m,
                pre_grasp: PoseRecord::from(&approach.pre_grasp),
                retreat: PoseRecord::from(&approach.retreat),
                path: PathRecord::new(&approach.path, &planned.samples),
            }),
        }
    }
}

impl PathRecord {
    fn new(path: &Path, samples: &[PathPoint]) -> Self {
        let pieces = path.pieces().iter().map(|piece| PieceRecord {
            stage: piece.stage.name().to_owned(),
            start_s: piece.start_s,
            duration_s: piece.curve.duration_s,
            coefficients: piece.curve.coefficients.map(|c| Vector3::from(c).into()),
        });
        Self {
            pre_grasp_s: path.pre_grasp_s(),
            grasp_s: path.grasp_s(),
            duration_s: path.duration_s(),
            pieces: pieces.collect(),
            samples: sample_records(samples),
        }
    }
}

/// The samples, each with that of its two quaternions which is nearer to the one before.
fn sample_records(samples: &[PathPoint]) -> Vec<SampleRecord> {
    let mut before: Option<[f64; 4]> = None;
    let records = samples.iter().map(|sample| {
        let q: [f64; 4] = sample.rotation.coords.into();
        let q = match before {
            Some(b) if q.iter().zip(b).map(|(a, b)| a * b).sum::<f64>() < 0.0 => q.map(|c| -c),
            Some(_) => q,
            None => canonical_xyzw(&sample.rotation),
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
    records.collect()
}

impl From<&NearestObstacle> for ClearanceRecord {
    fn from(nearest: &NearestObstacle) -> Self {
        let clearance = &nearest.clearance;
        let obstacle = match clearance.obstacle {
            Some(Obstacle::Apple(_)) => "apple",
            Some(Obstacle::Branch(_)) => "branch",
            Some(Obstacle::Cloud) => "cloud",
            None => "none",
        };
        Self {
            distance: clearance.distance_m,
            margin: clearance.margin_m,
            obstacle: obstacle.to_owned(),
            id: nearest.id,
            point: clearance.point_m,
            time_s: clearance.time_s,
            stage: clearance.stage.name().to_owned(),
        }
    }
}

impl From<&PlannedTurn> for OrderRecord {
    fn from(turn: &PlannedTurn) -> Self {
        Self {
            rank: turn.rank,
            reason: turn.reason.name().to_owned(),
            blockers: turn.blockers.clone(),
        }
    }
}
