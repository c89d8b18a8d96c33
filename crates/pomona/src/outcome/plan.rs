use nalgebra::Isometry3;
use pomona_approach::{Approach, Clearance, PathPoint, Reason, Refusal};

/// How a robot gets to one apple, or why it does not; in the robot's frame.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct ApplePlan {
    /// Name of the robot's frame.
    pub frame_id: String,
    /// The approach, or why there is none.
    pub approach: Result<PlannedApproach, Refusal>,
    /// What the gripper comes nearest to on its way, or what it would collide with.
    pub nearest: Option<NearestObstacle>,
    /// The apple's place in the picking order.
    pub turn: Option<PlannedTurn>,
}

/// A way to an apple and back.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct PlannedApproach {
    /// The approach itself.
    pub approach: Approach,
    /// Pose of the wrist link when the gripper holds the apple.
    pub wrist: Isometry3<f64>,
    /// Opening that the apple needs, margins included, metres.
    pub needed_width_m: f64,
    /// Opening of the gripper, metres.
    pub jaw_width_m: f64,
    /// The tool at equal steps of time.
    pub samples: Vec<PathPoint>,
}

impl ApplePlan {
    /// `free`; `blocked` where apples must go first that cannot; or the reason of the refusal.
    pub fn status(&self) -> &'static str {
        match &self.approach {
            Ok(planned) => planned.status(),
            Err(refusal) => refusal.name(),
        }
    }
}

impl PlannedApproach {
    /// `free`, or `blocked` where apples must go first that cannot.
    pub fn status(&self) -> &'static str {
        if self.approach.clearance.slack_m() >= 0.0 {
            "free"
        } else {
            "blocked"
        }
    }
}

/// What the gripper comes nearest to.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct NearestObstacle {
    /// The clearance; its obstacle is numbered as in the planner's scene.
    pub clearance: Clearance,
    /// Id of the answer whose apple or branch it is; `None` for the cloud.
    pub id: Option<usize>,
}

/// The place of an apple in the picking order.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct PlannedTurn {
    /// From 0, the first to be picked.
    pub rank: usize,
    /// Why it is here.
    pub reason: Reason,
    /// Ids of the answers whose apples must go before.
    pub blockers: Vec<usize>,
}
