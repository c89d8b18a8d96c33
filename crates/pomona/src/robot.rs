use crate::{
    ApproachRecord, ClearanceRecord, GripperRecord, OrderRecord, Outcome, Pick, PickError,
    PlanRecord, RobotFromCamera,
};
use nalgebra::{Isometry3, Point3, Quaternion, Translation3, UnitQuaternion, Vector3};
use pomona_approach::{
    ApproachConfig, ConfigError, ObstacleMap, Order, Planner, Refusal, StartPose, Target,
    pick_order,
};
use pomona_cloud::{DepthPoints, Frame, PixelWindow};
use pomona_geometry::{Capsule, Segment, Sphere};
use pomona_transforms::{CameraFrame, Direction, RobotFrame};

/// How far before the camera the tool starts where no start is configured, metres.
const START_AHEAD_M: f64 = 0.25;

/// The stage after picking: how a robot gets to each apple of a frame, and in which order.
#[derive(Clone, Debug)]
pub struct Robot {
    planner: Planner,
}

/// What was planned for a frame, in the robot's frame.
#[derive(Clone, Debug)]
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

    /// Plans the picks of a frame, and adds gripper, approach, clearance and order to their records.
    ///
    /// Every fitted apple and branch of the record is an obstacle, picked or not; so is the cloud. A
    /// branch reaches as far as the points that support it.
    ///
    /// # Errors
    ///
    /// [`PickError::Frame`] where the depth image contradicts the camera. An apple that cannot be
    /// approached is no error.
    pub fn plan(
        &self,
        frame: &Frame,
        outcome: &mut Outcome,
        robot_from_camera: &RobotFromCamera,
    ) -> Result<RobotPlan, PickError> {
        let config = self.planner.config();
        let to_robot = robot_from_camera.transform.isometry();
        let window = PixelWindow::full(frame.depth.width, frame.depth.height);
        let mut points = DepthPoints::new();
        points
            .fill(&frame.depth, &frame.camera, window)
            .map_err(|source| PickError::Frame {
                frame: frame.id.clone(),
                source: Box::new(source),
            })?;
        let cloud: Vec<_> = (0..points.len())
            .map(|i| to_robot * points.point(i))
            .collect();

        let picks = &outcome.record.picks;
        let (mut apples, mut apple_ids) = (Vec::new(), Vec::new());
        let (mut branches, mut branch_ids) = (Vec::new(), Vec::new());
        let (mut targets, mut target_ids) = (Vec::new(), Vec::new());
        for (pick, evidence) in picks.iter().zip(&outcome.evidence) {
            let fitted = pick.candidates.first().map(|best| best.radius);
            let radius = fitted.unwrap_or(config.clearance.branch_radius_m);
            if let Some(branch) = branch_of(pick, &evidence.branch, &points, radius) {
                branches.push(moved(&branch, &to_robot));
                branch_ids.push(pick.id);
            }
            let Some(apple) = sphere_of(pick) else {
                continue;
            };
            let number = apples.len();
            apples.push(Sphere {
                center: to_robot * apple.center,
                ..apple
            });
            apple_ids.push(pick.id);
            if let Some(direction) = direction_of(pick, robot_from_camera) {
                let mut target = Target::new(number, direction);
                target
                    .directions
                    .extend(others(pick, &apple, robot_from_camera));
                target.direction_uncertainty_rad = pick
                    .direction_sd
                    .unwrap_or(config.search.direction_uncertainty_rad);
                target.confidence = pick.confidence.unwrap_or(1.0);
                target.branch = pick
                    .branch
                    .as_ref()
                    .map(|b| to_robot * Vector3::from(b.direction));
                targets.push(target);
                target_ids.push(pick.id);
            }
        }
        let scene = ObstacleMap::new(apples, branches, &cloud, &config.clearance);
        let start = self.start(&to_robot);
        let order = pick_order(&self.planner, &scene, &targets, &start);
        let plan = RobotPlan {
            frame_id: robot_from_camera.to.clone(),
            scene,
            order,
            targets: target_ids,
            apples: apple_ids,
            branches: branch_ids,
            start,
        };
        for pick in &mut outcome.record.picks {
            pick.plan = self.record(&plan, pick);
        }
        Ok(plan)
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

    fn record(&self, plan: &RobotPlan, pick: &Pick) -> PlanRecord {
        let Some(target) = plan.targets.iter().position(|&id| id == pick.id) else {
            return PlanRecord::default();
        };
        let clearance = |c| ClearanceRecord::new(c, &plan.apples, &plan.branches);
        match &plan.order.approaches[target] {
            Ok(approach) => {
                let radius = plan.scene.apples()[approach.apple].radius;
                let gripper = &self.config().gripper;
                let mut ranks = plan.order.ranks.iter().enumerate();
                let rank = ranks.find(|(_, rank)| rank.target == target);
                PlanRecord {
                    gripper: Some(GripperRecord::new(
                        approach,
                        gripper,
                        radius,
                        &plan.frame_id,
                    )),
                    approach: Some(ApproachRecord::new(approach, self.config().motion.samples)),
                    clearance: Some(clearance(&approach.clearance)),
                    order: rank.map(|(i, rank)| OrderRecord::new(i, rank, &plan.targets)),
                }
            }
            Err(refusal) => PlanRecord {
                approach: Some(ApproachRecord::refused(refusal)),
                clearance: match refusal {
                    Refusal::Collision(found) => Some(clearance(found)),
                    _ => None,
                },
                ..PlanRecord::default()
            },
        }
    }
}

fn sphere_of(pick: &Pick) -> Option<Sphere> {
    let apple = pick.apple.as_ref()?;
    Sphere::new(Point3::from(apple.center), apple.radius)
}

fn direction_of(pick: &Pick, transform: &RobotFromCamera) -> Option<Direction<RobotFrame>> {
    let direction = Direction::<CameraFrame>::new(Vector3::from(pick.direction?))?;
    Some(transform.transform.direction(&direction))
}

/// The directions to the other candidates that are nearly as good as the best, and elsewhere.
fn others(
    pick: &Pick,
    apple: &Sphere,
    transform: &RobotFromCamera,
) -> impl Iterator<Item = Direction<RobotFrame>> {
    /// By how much less than the best a candidate may score, and how far its direction is from that of the best.
    const WORSE: f64 = 0.3;
    const APART_RAD: f64 = 0.2;
    let towards = |foot: [f64; 3]| Point3::from(foot) - apple.center;
    let best = pick.candidates.first();
    let close = pick.candidates.iter().skip(1).filter(move |other| {
        best.is_some_and(|best| {
            other.score >= best.score - WORSE
                && towards(other.foot).angle(&towards(best.foot)) > APART_RAD
        })
    });
    close
        .filter_map(move |other| Direction::<CameraFrame>::new(towards(other.foot)))
        .map(|direction| transform.transform.direction(&direction))
}

/// The branch as far as its supporting pixels see it, in the camera's frame.
fn branch_of(pick: &Pick, pixels: &[u32], points: &DepthPoints, radius: f64) -> Option<Capsule> {
    let branch = pick.branch.as_ref()?;
    let (point, along) = (Point3::from(branch.point), Vector3::from(branch.direction));
    // The points of a whole image stand in the order of their pixels.
    let (low, high) = pixels
        .iter()
        .filter_map(|pixel| points.pixel.binary_search(pixel).ok())
        .map(|i| (points.point(i) - point).dot(&along))
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), t| {
            (low.min(t), high.max(t))
        });
    if low > high {
        return None;
    }
    Capsule::new(
        Segment::new(point + along * low, point + along * high)?,
        radius,
    )
}

fn moved(capsule: &Capsule, pose: &Isometry3<f64>) -> Capsule {
    let Segment { start, end } = capsule.segment;
    Capsule {
        segment: Segment {
            start: pose * start,
            end: pose * end,
        },
        ..*capsule
    }
}
