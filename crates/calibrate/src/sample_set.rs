use crate::{PointSample, PoseSample};
use pomona_files::Warning;

/// Name and version of the form of a JSON file of samples.
pub const SAMPLES_SCHEMA: &str = "pomona.calibration-samples/1";

/// The samples of a file, and the names of the frames where it gives them.
///
/// JSON, with the ids of the frames optional:
///
/// ```json
/// { "schema": "pomona.calibration-samples/1",
///   "robot_frame": "base_link", "camera_frame": "camera_color_optical_frame",
///   "flange_frame": "tool0", "target_frame": "marker_7",
///   "poses": [
///     { "id": "stop-01",
///       "robot_from_flange":  { "translation_m": [0.6, 0.1, 0.5], "quaternion_xyzw": [0, 0.7071068, 0, 0.7071068] },
///       "camera_from_target": { "translation_m": [0.0, 0.1, 0.8], "quaternion_xyzw": [1, 0, 0, 0] } } ] }
/// ```
///
/// or, in place of `poses`, `"points": [{ "id": "p1", "camera_m": [x, y, z], "robot_m": [x, y, z] }]`. A pose may give
/// `"matrix"`, four rows of four, in place of translation and quaternion.
///
/// CSV, told by its first line; columns may stand in any order:
///
/// ```text
/// id,camera_x_m,camera_y_m,camera_z_m,robot_x_m,robot_y_m,robot_z_m
/// ```
///
/// for points, and for poses `id` with, for each of `robot_from_flange` and `camera_from_target`, the columns
/// `…_x_m`, `…_y_m`, `…_z_m`, `…_qx`, `…_qy`, `…_qz`, `…_qw`.
///
/// Metres; quaternions in the order x y z w; transforms destination first.
///
/// CSV with the columns of other programs is read too: parted by `;` or tabs, with decimal commas; lengths in
/// millimetres (`…_mm`, or told by their size); a rotation as `a b c` (KUKA), `roll pitch yaw`, `w p r` (FANUC), or as
/// [`SampleOptions`](crate::SampleOptions) name it. So are the samples of `MoveIt`'s hand-eye calibration and of
/// `easy_handeye`, in YAML.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct SampleSet {
    /// The samples.
    pub samples: Samples,
    /// Ids of the frames.
    pub frames: FrameIds,
    /// What was assumed about the file.
    pub warnings: Vec<Warning>,
}

/// Samples of one kind.
#[derive(Clone, Debug, PartialEq)]
pub enum Samples {
    /// Places.
    Points(Vec<PointSample>),
    /// Poses.
    Poses(Vec<PoseSample>),
}

/// Ids of the frames, as the robot's programs know them.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct FrameIds {
    /// The robot's base.
    pub robot: Option<String>,
    /// The camera.
    pub camera: Option<String>,
    /// The flange.
    pub flange: Option<String>,
    /// The target.
    pub target: Option<String>,
}
