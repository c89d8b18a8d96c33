use crate::outcome::{NearestObstacle, PlannedTurn};
use pomona_approach::{Clearance, Obstacle, ObstacleMap, Order, StartPose};

/// What was planned for a frame, in the robot's frame.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct RobotPlan {
    /// Name of the robot's frame.
    pub frame_id: String,
    /// What is in the way.
    pub scene: ObstacleMap,
    /// The order, and the approach or refusal of each target.
    pub order: Order,
    /// The id of the pick that each target comes from.
    pub targets: Vec<usize>,
    /// The id of the pick that each apple of the scene comes from.
    pub apples: Vec<usize>,
    /// The id of the pick that each branch of the scene comes from.
    pub branches: Vec<usize>,
    /// Where the tool starts.
    pub start: StartPose,
}

impl RobotPlan {
    /// A clearance with the id of the answer whose apple or branch it is measured to.
    pub(super) fn nearest(&self, clearance: &Clearance) -> NearestObstacle {
        let id = match clearance.obstacle {
            Some(Obstacle::Apple(i)) => self.apples.get(i),
            Some(Obstacle::Branch(i)) => self.branches.get(i),
            Some(Obstacle::Cloud) | None => None,
        };
        NearestObstacle {
            clearance: *clearance,
            id: id.copied(),
        }
    }

    /// The place of a target in the order.
    pub(super) fn turn(&self, target: usize) -> Option<PlannedTurn> {
        let mut ranks = self.order.ranks.iter().enumerate();
        let (rank, entry) = ranks.find(|(_, rank)| rank.target == target)?;
        let id = |&target: &usize| self.targets.get(target).copied();
        Some(PlannedTurn {
            rank,
            reason: entry.reason,
            blockers: entry.blockers.iter().filter_map(id).collect(),
        })
    }
}
