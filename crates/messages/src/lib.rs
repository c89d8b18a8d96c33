//! A robot's plan in the formats of other programs: ROS 2 and `MoveIt` messages, and MCAP recordings.
//!
//! ```
//! use pomona::{ApproachConfig, CheckedFrame, Config, Picker, Robot, RobotFromCamera};
//! use pomona_messages::ros;
//! use pomona_scenes::Suite;
//! use pomona_transforms::Transform;
//!
//! // A rendered frame of one apple below a branch; the camera looks along the robot's x axis.
//! let case = Suite::Lab15.cases().find(|case| case.name.contains("x0")).unwrap();
//! let scene = case.scene();
//! let frame = CheckedFrame::new(&scene.frame)?;
//! let pose = Transform::from_quaternion([0.0, 0.0, 0.5], [-0.5, 0.5, -0.5, 0.5])?;
//! let robot_from_camera = RobotFromCamera::new(pose, "base_link", scene.frame.camera.frame_id.clone());
//!
//! let mut answer = Picker::new(Config::default())?.pick(&frame, 0, Some(&robot_from_camera))?;
//! let robot = Robot::new(ApproachConfig::default())?;
//! let plan = robot.plan(&frame, &mut answer, &robot_from_camera);
//!
//! let files = ros::files(&plan, robot.config());
//! assert_eq!(files[1].name, "ros-scene.yaml");
//! assert!(files[1].text.contains("frame_id: \"base_link\""));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Concepts
//!
//! - [`ros`] turns a [`RobotPlan`](pomona::RobotPlan) into messages of ROS 2 and `MoveIt`, each field as its public
//!   definition has it, and writes them as YAML that `ros2 topic pub` takes.
//! - `recording`, with the feature `mcap`, writes a frame and its plan as an MCAP file with Foxglove's schemas.
//! - [`ranked`] lists the approaches of a plan in the picking order, in which both write them.
//!
//! Metres, radians and seconds, in the robot's frame; poses are those of the wrist link.
//!
//! # Not here
//!
//! Planning (`pomona`, `pomona-approach`); ROS nodes and transports: the results are texts and bytes.
//!
//! # Features
//!
//! `mcap` (off by default): the module `recording`.
//!
//! # References
//!
//! Definitions of the messages: ROS 2 Jazzy (`common_interfaces`, `moveit_msgs`), <https://docs.ros.org/en/jazzy>.
//! Recordings: <https://mcap.dev/spec>, <https://docs.foxglove.dev/docs/sdk/schemas>.

mod order;
mod pose;
#[cfg(feature = "mcap")]
pub mod recording;
pub mod ros;

pub use order::ranked;
