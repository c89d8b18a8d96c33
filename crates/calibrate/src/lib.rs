//! Hand–eye calibration: the transform from a camera to a robot, from samples with outliers, with its uncertainty.
//!
//! ```
//! use nalgebra::Point3;
//! use pomona_calibrate::{Options, PointSample, calibrate_points};
//! use pomona_transforms::{CameraFrame, Position, RobotFrame, Transform};
//! use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
//!
//! // Eight points that the camera measured and the robot touched; one was recorded wrongly.
//! let truth = Transform::<RobotFrame, CameraFrame>::from_quaternion([0.0, 0.0, 0.5], [0.5, -0.5, 0.5, -0.5])?;
//! let mut samples: Vec<PointSample> = (0..8)
//!     .map(|i| {
//!         let (i, id) = (f64::from(i), format!("p{i}"));
//!         let camera = Position::new(Point3::new(0.1 * i, 0.3 * (i * 2.0).sin(), 0.8 + 0.2 * i.cos()));
//!         PointSample::new(id, camera, truth.position(&camera))
//!     })
//!     .collect();
//! samples[3].robot = samples[4].robot;
//!
//! let found = calibrate_points(&samples, &Options::default(), &mut ChaCha8Rng::seed_from_u64(0))?;
//! assert!((found.camera.transform.matrix() - truth.matrix()).amax() < 1e-9);
//! assert!(found.quality.samples[3].rejected.is_some());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Concepts
//!
//! - [`PointSample`]: a point measured by the camera and touched by the robot; [`calibrate_points`].
//! - [`PoseSample`]: the pose of the flange and that of a target. The camera is fixed and the target is on the
//!   flange: [`calibrate_eye_to_hand`], [`calibrate_robot_world`]. The camera is on the flange and the target is
//!   fixed: [`calibrate_eye_in_hand`].
//! - A [`SampleSet`] is a file of samples: JSON or CSV, keyed by id, or a file of `MoveIt` or `easy_handeye`.
//!   [`SampleOptions`] name units and rotations that the file leaves open.
//! - The answer is an [`UncertainTransform`](pomona_transforms::UncertainTransform) with a 6×6 covariance, and a
//!   [`Quality`]: residual and weight of every sample, rejected ones with the reason, and the leave-one-out error at
//!   the fruit's distance.
//! - A [`CalibrateError`] refuses samples that do not determine the answer, and names the likely cause.
//!
//! # How
//!
//! Minimal solvers propose hypotheses from three samples within `pomona-ransac`; the consensus of more than half is
//! refined jointly, for pose pairs over both unknown transforms on SE(3), with the loss of a Student t, whose scales
//! (rotation and translation each) are estimated with it. The derivation of the joint refinement is in
//! `docs/calibration.md`, with a comparison with OpenCV.
//!
//! # Not here
//!
//! Detecting markers and boards in images, moving the robot, camera intrinsics, arm kinematics.
//!
//! # References
//!
//! Each method's source is cited at its function: Kabsch 1976, Umeyama 1991, Park and Martin 1994, Daniilidis 1999,
//! Shah 2013, Lange, Little and Taylor 1989.

mod error;
mod file;
mod options;
mod points;
mod poses;
mod quality;
mod record;
mod robust;
mod rotation_form;
mod sample_options;
mod sample_set;
mod samples;
mod units;

pub use error::CalibrateError;
pub use options::Options;
pub use points::{PointCalibration, calibrate_points};
pub use pomona_files::{FileError, Warning, WarningCode};
pub use poses::{
    MotionSpread, PoseCalibration, PoseSolver, calibrate_eye_in_hand, calibrate_eye_to_hand,
    calibrate_robot_world, solve_without_robustness,
};
pub use quality::{LeaveOneOut, LeftOut, Quality, Rejection, RejectionCause, SampleQuality};
pub use record::{
    Calibration, CalibrationKind, CalibrationRecord, CameraMount, RECORD_SCHEMA, TransformRecord,
    calibrate,
};
pub use rotation_form::{EulerAngles, RotationForm};
pub use sample_options::SampleOptions;
pub use sample_set::{FrameIds, SAMPLES_SCHEMA, SampleSet, Samples};
pub use samples::{PointSample, PoseSample};
pub use units::{AngleUnit, LengthUnit};
