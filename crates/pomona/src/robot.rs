//! The stage after picking: how a robot gets to each apple.

mod plan;
mod task;

pub use plan::RobotPlan;

use crate::frame::CheckedFrame;
use crate::outcome::{ApplePlan, FrameAnswer, PlannedApproach, RobotFromCamera};
use nalgebra::{Isometry3, Point3, Quaternion, Translation3, UnitQuaternion};
use pomona_approach::{
    Approach, ApproachConfig, ConfigError, ObstacleMap, Planner, Refusal, StartPose, pick_order,
};
use task::Task;

/// How far before the camera the tool starts where no start is configured, metres.
const START_AHEAD_M: f64 = 0.25;

/// The stage after picking: how a robot gets to each apple of a frame, and in which order.
#[derive(Clone, Debug)]
pub struct Robot {
    planner: Planner,
}

impl Robot {
    /// A robot with these settings.
    ///
    /// # Errors
    ///
    /// [`ConfigError::Value`] names the setting that makes no sense.
    pub fn new(config: ApproachConfig) -> Result<Self, ConfigError> {
        Ok(Self {
            planner: Planner::new(config)?,
        })
    }

    /// Its settings.
    pub fn config(&self) -> &ApproachConfig {
        self.planner.config()
    }

    /// Plans the picks of a frame, and adds its plan to each answer.
    ///
    /// Every fitted apple and branch is an obstacle, picked or not; so is the cloud. A branch reaches as far as the
    /// points that support it. An apple that cannot be approached is no error: its plan says why.
    pub fn plan(
        &self,
        frame: &CheckedFrame<'_>,
        answer: &mut FrameAnswer,
        robot_from_camera: &RobotFromCamera,
    ) -> RobotPlan {
        let to_robot = robot_from_camera.transform.isometry();
        let points = frame.points();
        let cloud: Vec<_> = (0..points.len())
            .map(|i| to_robot * points.point(i))
            .collect();
        let mut task = Task::default();
        for apple in &answer.apples {
            task.add_branch(apple, points, robot_from_camera, self.config());
            task.add_apple(apple, robot_from_camera, self.config());
        }
        let clearance = &self.config().clearance;
        let scene = ObstacleMap::new(task.apples, task.branches, &cloud, clearance);
        let start = self.start(&to_robot);
        let order = pick_order(&self.planner, &scene, &task.targets, &start);
        let plan = RobotPlan {
            frame_id: robot_from_camera.to.clone(),
            scene,
            order,
            targets: task.target_ids,
            apples: task.apple_ids,
            branches: task.branch_ids,
            start,
        };
        for apple in &mut answer.apples {
            apple.plan = self.plan_of(&plan, apple.id);
        }
        plan
    }

    /// The configured start; else before the camera, where it looks.
    fn start(&self, to_robot: &Isometry3<f64>) -> StartPose {
        let motion = &self.planner.config().motion;
        let ahead = to_robot * Point3::new(0.0, 0.0, START_AHEAD_M);
        let place = motion.start_m.map_or(ahead, Point3::from);
        // The tool's x along the camera's z, its z along the camera's −y, which is up.
        let looking =
            to_robot.rotation * UnitQuaternion::new_unchecked(Quaternion::new(0.5, 0.5, -0.5, 0.5));
        let rotation = motion
            .start_quaternion_xyzw
            .map_or(looking, |[x, y, z, w]| {
                UnitQuaternion::new_normalize(Quaternion::new(w, x, y, z))
            });
        StartPose(Isometry3::from_parts(Translation3::from(place), rotation))
    }

    /// The plan of the apple with this id; `None` where it was no target.
    fn plan_of(&self, plan: &RobotPlan, id: usize) -> Option<ApplePlan> {
        let target = plan.targets.iter().position(|&other| other == id)?;
        let (approach, nearest) = match &plan.order.approaches[target] {
            Ok(approach) => (
                Ok(self.planned(plan, approach)),
                Some(plan.nearest(&approach.clearance)),
            ),
            Err(refusal) => (
                Err(*refusal),
                match refusal {
                    Refusal::Collision(clearance) => Some(plan.nearest(clearance)),
                    _ => None,
                },
            ),
        };
        Some(ApplePlan {
            frame_id: plan.frame_id.clone(),
            turn: plan.turn(target).filter(|_| approach.is_ok()),
            approach,
            nearest,
        })
    }

    fn planned(&self, plan: &RobotPlan, approach: &Approach) -> PlannedApproach {
        let gripper = &self.config().gripper;
        let radius = plan.scene.apples()[approach.apple].radius;
        PlannedApproach {
            wrist: gripper.wrist_pose(&approach.grasp),
            needed_width_m: gripper.needed_for(radius).0,
            jaw_width_m: gripper.jaw_width_m,
            samples: approach.path.samples(self.config().motion.samples),
            approach: approach.clone(),
        }
    }
}
