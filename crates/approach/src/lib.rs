//! How a gripper reaches an apple and retreats: pose, path, clearance, refusals, order of picking.
//!
//! ```
//! use nalgebra::{Point3, Vector3};
//! use pomona_approach::{ApproachConfig, Planner, ObstacleMap, StartPose, Target, pick_order};
//! use pomona_geometry::{Capsule, Segment, Sphere};
//! use pomona_transforms::Direction;
//!
//! // An apple 0.8 m in front of the base, hanging below a branch that runs along y.
//! let apple = Sphere::new(Point3::new(0.8, 0.0, 0.5), 0.035).unwrap();
//! let axis = Segment::new(Point3::new(0.8, -0.3, 0.55), Point3::new(0.8, 0.3, 0.55)).unwrap();
//! let branch = Capsule::new(axis, 0.005).unwrap();
//! let upwards = Direction::new(Vector3::z()).unwrap();
//!
//! let planner = Planner::new(ApproachConfig::default())?;
//! let scene = ObstacleMap::new(vec![apple], vec![branch], &[], &planner.config().clearance);
//! let mut target = Target::new(0, upwards);
//! target.branch = Some(Vector3::y());
//! let start = StartPose::looking_along_x(Point3::new(0.3, 0.0, 0.4));
//!
//! let approach = planner.plan(&scene, &target, &start)?;
//! assert!((approach.direction.vector() - Vector3::z()).norm() < 1e-12);
//! assert!(approach.clearance.distance_m > 0.0);
//! // The tool comes from below, arrives at the centre, and rests there.
//! let grasp = approach.path.sample(approach.path.grasp_s());
//! assert!((grasp.position - apple.center).norm() < 1e-9 && grasp.velocity.norm() < 1e-9);
//!
//! let order = pick_order(&planner, &scene, &[target], &start);
//! assert_eq!(order.ranks[0].target, 0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Concepts
//!
//! - All positions and directions are in the robot's base frame: z up, metres, radians, seconds.
//! - The *tool frame* has its origin, the tool centre point, between the fingers, where the apple's centre comes to
//!   rest; the gripper approaches along +x and opens along ±y. A [`Gripper`] is two fingers, a palm and a wrist, each
//!   a capsule.
//! - A [`Target`] is an apple with one or more directions OC, from its centre to the foot of the
//!   perpendicular on its branch. The gripper moves *along* +OC, from the far side of the fruit towards the branch
//!   (Gao et al. 2022, Section 2.2.5).
//! - A [`Path`] has three stages: the transit from the current pose to the pre-grasp, a standoff before the apple;
//!   the straight final approach; the straight retreat. It is made of [`Quintic`]s that agree in position, velocity
//!   and acceleration where they meet. The paper calls its path a polynomial, but gives neither degree nor
//!   coefficients; five is the lowest degree that matches all three at both ends.
//! - A [`ObstacleMap`] holds the obstacles: apples, branches of the extent that was seen, and the
//!   points of the cloud that neither explains. [`Clearance`] is the signed distance of the
//!   gripper from the nearest of these along the whole path, not only at samples: between samples it is bounded by
//!   the speed of the gripper's fastest point, and the straight stages are tested as swept volumes.
//! - A [`Planner`] tries the directions in order, each with tilts within its uncertainty and with the allowed rolls,
//!   and returns the first [`Approach`] that is free, or the [`Refusal`] of the first one tried.
//! - [`pick_order`] ranks the targets of a frame, with reasons.
//!
//! # Not here
//!
//! How the apple was found; the arm's joints (a pose within reach may have no inverse-kinematics solution, or one in
//! which the arm collides); what the camera has not seen, which is never an obstacle; grasp forces; files and
//! messages of robot programs.
//!
//! # References
//!
//! - Gao, Zhou, Cao, Jiang 2022, "An Algorithm for Calculating Apple Picking Direction Based on
//!   3D Vision", Agriculture 12(8), 1170, doi 10.3390/agriculture12081170: the direction of
//!   approach, Figure 3b.
//! - Flash, Hogan 1985, "The coordination of arm movements", The Journal of Neuroscience 5(7),
//!   doi `10.1523/JNEUROSCI.05-07-01688.1985`: quintics minimise the jerk.
//! - Mirtich 1996, "Impulse-based Dynamic Simulation of Rigid Body Systems", thesis, University of
//!   California, Section 2.3.2: conservative advancement.
//! - Ericson 2005, "Real-Time Collision Detection", Section 5.1.9: distance of two segments.
//! - Farouki 2012, "The Bernstein polynomial basis", CAGD 29(6), 379–419,
//!   doi 10.1016/j.cagd.2012.03.001: a polynomial lies within the hull of its coefficients.

mod approach;
mod attempt;
mod clearance;
mod collision_check;
mod config;
mod error;
mod gripper;
mod obstacle_map;
mod obstacles;
mod order;
mod outline;
mod path;
mod planner;
mod point_tree;
mod pose;
mod quintic;
mod shape;
mod straight_motion;
mod swept_volume;
mod target;
mod transit;

pub use approach::Approach;
pub use clearance::{Clearance, Obstacle, Stage};
pub use config::{ApproachConfig, ClearanceConfig, MotionConfig, ReachConfig, Roll, SearchConfig};
pub use error::{ReachLimit, Refusal};
pub use gripper::Gripper;
pub use obstacle_map::ObstacleMap;
pub use order::{Order, Rank, Reason, pick_order};
pub use path::{Path, PathPoint, PathSegment};
pub use planner::Planner;
pub use point_tree::PointTree;
pub use pomona_settings::ConfigError;
pub use pose::tool_rotation;
pub use quintic::{Quintic, State};
pub use target::{StartPose, Target};
