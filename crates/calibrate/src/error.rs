use thiserror::Error;

/// Why samples do not give a calibration.
///
/// Every message says what is wrong and what to do about it.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum CalibrateError {
    /// A setting that makes no sense.
    #[error("`{setting}` is {value} but must be positive and finite; leave it out for the default")]
    Setting {
        /// Its name.
        setting: &'static str,
        /// Its value.
        value: f64,
    },
    /// The samples are not for what is to be calibrated.
    #[error(
        "the samples are {found}, but `{kind}` needs the others; give points for `points`, poses for the other kinds"
    )]
    OtherSamples {
        /// What was to be calibrated.
        kind: &'static str,
        /// What the samples are.
        found: &'static str,
    },
    /// There are fewer samples than the unknowns and one check need.
    #[error("{found} samples are too few: {needed} at least, better 12 to 20; take more")]
    TooFew {
        /// Samples there are.
        found: usize,
        /// Samples needed.
        needed: usize,
    },
    /// Two samples have one id.
    #[error("the id `{id}` is given twice; give each sample an id of its own")]
    SameId {
        /// The id.
        id: String,
    },
    /// A number is not finite.
    #[error(
        "sample `{id}`: `{field}` contains a number that is not finite; take the sample again, or leave it out"
    )]
    NotFinite {
        /// The sample.
        id: String,
        /// The field.
        field: &'static str,
    },
    /// A length that no arm spans.
    #[error("sample `{id}`: `{field}` is {length_m:.1} m away, more than {limit_m} m; give metres: it looks like millimetres", limit_m = pomona_transforms::MAX_TRANSLATION_M)]
    TooFar {
        /// The sample.
        id: String,
        /// The field.
        field: &'static str,
        /// Its length, taken as metres.
        length_m: f64,
    },
    /// The robot hardly turned.
    #[error(
        "the motions do not determine the answer: the largest rotation between two samples is {largest_deg:.1} degrees, 3 at least are needed; turn the flange by 30 degrees and more, about axes that differ"
    )]
    MotionsTooSmall {
        /// The largest rotation, degrees.
        largest_deg: f64,
    },
    /// The robot turned about one axis only.
    #[error(
        "the motions do not determine the answer: all rotations are about one axis within {across_deg:.1} degrees, and the position along it is undetermined; turn the flange about a second axis as well, by 30 degrees and more"
    )]
    OneAxis {
        /// The largest part of a rotation that is not about that axis, degrees.
        across_deg: f64,
    },
    /// All points lie on a line.
    #[error(
        "the points do not determine the answer: they lie on one line within {across_mm:.1} mm, and the rotation about it is undetermined; take points away from the line, by 100 mm and more"
    )]
    Collinear {
        /// Root mean square distance from the line, mm.
        across_mm: f64,
    },
    /// The distances between points differ by a factor between the two frames.
    #[error(
        "distances in the robot's frame are {scale:.4} times those in the camera's, but must be the same: {cause}"
    )]
    Scale {
        /// Robot's distances over camera's.
        scale: f64,
        /// What is likely the matter, and what to do.
        cause: &'static str,
    },
    /// The points fit after a reflection only.
    #[error(
        "the points fit after a reflection and not without: one of the frames is left-handed, or an axis has the wrong sign; negate that axis in the file"
    )]
    Mirrored,
    /// The samples agree only after the poses of one side have been inverted.
    #[error(
        "the samples agree when the poses of one side are inverted, and not as they are: `robot_from_flange` holds `flange_from_robot`, or `camera_from_target` holds `target_from_camera`, or the kind is eye-in-hand in place of eye-to-hand, or the reverse; turn the poses round, or name the other kind"
    )]
    Inverted,
    /// The samples agree only with w as the first component of quaternions.
    #[error(
        "the samples agree when w comes first in the quaternions of {sides}, and not as they are; write them x y z w, or name their order (`--rotations quaternion-wxyz`)"
    )]
    WFirst {
        /// Which poses.
        sides: &'static str,
    },
    /// The samples agree only with the rows of one side moved.
    #[error(
        "the samples agree when the poses of the target are moved {direction} by {rows} against those of the flange, and not as they are; pair each pose of the flange with the image that was taken there"
    )]
    Shifted {
        /// By how many rows.
        rows: usize,
        /// `up` or `down`.
        direction: &'static str,
    },
    /// Too few samples agree on any answer.
    #[error(
        "no consensus: {agreeing} of {samples} samples agree within {tolerance}, more than half is needed; check that the ids belong together and that camera and target are fixed, or allow a larger tolerance"
    )]
    NoConsensus {
        /// Samples that agree on the best answer.
        agreeing: usize,
        /// Samples there are.
        samples: usize,
        /// The tolerance, with units.
        tolerance: String,
    },
    /// The equations are underdetermined for another reason.
    #[error(
        "the samples do not determine the answer; take more of them, with rotations of 30 degrees and more about axes that differ"
    )]
    Undetermined,
}
