//! Coordinate frames as types, rigid transforms between them with their uncertainty, and the orientation of a tool
//! that approaches along a direction.
//!
//! ```
//! use nalgebra::{Point3, Vector3};
//! use pomona_transforms::{
//!     CameraFrame, Direction, NamedTransform, Position, RobotFrame, ToolOrientation, Transform,
//! };
//!
//! // The camera looks along the robot's x axis, half a metre above its base.
//! let robot_from_camera = Transform::<RobotFrame, CameraFrame>::from_quaternion(
//!     [0.0, 0.0, 0.5],
//!     [0.5, -0.5, 0.5, -0.5],
//! )?;
//!
//! // An apple 0.8 m in front of the camera, to be picked upwards (y points down there).
//! let center = Position::new(Point3::new(0.0, 0.0, 0.8));
//! let upwards = Direction::new(Vector3::new(0.0, -1.0, 0.0)).unwrap();
//!
//! let center = robot_from_camera.position(&center);
//! let upwards = robot_from_camera.direction(&upwards);
//! assert!((center.point() - Point3::new(0.8, 0.0, 0.5)).norm() < 1e-12);
//! assert!((upwards.vector() - Vector3::z()).norm() < 1e-12);
//!
//! // Straight up, the rotation about z is arbitrary, and the answer says so.
//! let tool = ToolOrientation::along(&upwards);
//! assert!(tool.singular && tool.euler.rz == 0.0);
//!
//! // The transform as a file, with the names that the robot's programs use.
//! # let folder = tempfile::tempdir()?;
//! # let path = folder.path().join("robot_from_camera.json");
//! let named = NamedTransform::new(robot_from_camera, "base_link", "camera_color_optical_frame");
//! named.write(&path)?;
//! assert_eq!(NamedTransform::read(&path)?, named);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Concepts
//!
//! - A frame is a type that implements [`FrameTag`]: [`CameraFrame`], [`RobotFrame`], or your own. [`Position`] and
//!   [`Direction`] carry it, so that a position in the camera frame cannot be mistaken for one in the robot's.
//! - A [`Transform<To, From>`](Transform) is named destination first: `robot_from_camera` takes camera coordinates to
//!   robot coordinates. Positions are rotated and translated, directions only rotated. Transforms compose if the
//!   inner frames agree; anything else does not compile.
//! - A [`NamedTransform`] adds the frame ids that a camera and a robot have at run time, and is what
//!   `robot_from_camera.json` holds.
//! - A [`ToolOrientation`] rotates a tool that points along +x into a direction, as a quaternion and as [`EulerZyx`]
//!   angles; it reports the singularity along ±z. A [`ToolModel`] defines which axis of the tool approaches, and the
//!   pose of the tool on the flange.
//! - An [`UncertainTransform`] propagates a 6×6 covariance through products and inverses, to positions and directions.
//! - [`formats`] reads and writes the formats of other programs.
//!
//! # Units and signs
//!
//! Metres and radians. Right-handed frames; the camera's is REP-103 optical (x right, y down,
//! z forward). Quaternions are written x y z w, and exported with w ≥ 0.
//!
//! # Not here
//!
//! Estimating the transform (`pomona-calibrate`), camera pixels (`pomona-cloud`), primitives and their distances
//! (`pomona-geometry`), the path of a tool and obstacles (`pomona-approach`).
//!
//! # References
//!
//! - Gao, Zhou, Cao, Jiang 2022, "An Algorithm for Calculating Apple Picking Direction Based on
//!   3D Vision", Agriculture 12(8), 1170, Eq. 11, doi 10.3390/agriculture12081170: the tool's
//!   angles.
//! - Higham 1986, "Computing the polar decomposition, with applications", SIAM J. Sci. Stat.
//!   Comput. 7(4), doi 10.1137/0907079: the rotation nearest to a matrix.
//! - REP 103, "Standard Units of Measure and Coordinate Conventions": the axes of the frames.

mod any_form;
mod direction;
mod error;
mod euler;
pub mod formats;
mod frame;
mod json;
mod matrix;
mod named;
mod position;
mod position_covariance;
mod quaternion;
mod schema;
mod tool;
mod tool_model;
mod transform;
pub mod twist;
mod uncertain;

pub use any_form::AnyTransform;
pub use direction::Direction;
pub use error::{CovarianceError, TransformContentError, TransformError, TransformFileError};
pub use euler::EulerZyx;
pub use frame::{CameraFrame, FlangeFrame, FrameTag, RobotFrame, TargetFrame, ToolFrame};
pub use named::NamedTransform;
pub use pomona_files::FileError;
pub use position::Position;
pub use position_covariance::PositionCovariance;
pub use quaternion::canonical_xyzw;
pub use schema::{MAX_TRANSLATION_M, SCHEMA};
pub use tool::{SINGULAR_ANGLE_RAD, ToolOrientation, paper_as_printed_euler};
pub use tool_model::{ToolModel, UNKNOWN_ANGLE_SIGMA_RAD, UncertainToolOrientation};
pub use transform::Transform;
pub use uncertain::{UncertainDirection, UncertainPosition, UncertainTransform};
