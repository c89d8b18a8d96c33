use crate::{
    CalibrateError, FrameIds, MotionSpread, Options, PoseCalibration, PoseSolver, Quality,
    SampleSet, Samples, calibrate_eye_in_hand, calibrate_eye_to_hand, calibrate_points,
    calibrate_robot_world,
};
use pomona_transforms::{
    CameraFrame, FlangeFrame, FrameTag, NamedTransform, RobotFrame, TransformFileError,
    UncertainTransform,
};
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use serde::Serialize;
use std::path::Path;

/// Name and version of the form of a record.
pub const RECORD_SCHEMA: &str = "pomona.calibration/1";

/// What is calibrated from which samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum CalibrationKind {
    /// A fixed camera, from point pairs: [`calibrate_points`].
    Points,
    /// A fixed camera and a target on the flange, AX = XB: [`calibrate_eye_to_hand`].
    EyeToHand,
    /// A camera on the flange and a fixed target, AX = XB: [`calibrate_eye_in_hand`].
    EyeInHand,
    /// A fixed camera and a target on the flange, AX = ZB: [`calibrate_robot_world`].
    RobotWorld,
}

impl CalibrationKind {
    /// Its name on the command line and in records.
    pub fn name(self) -> &'static str {
        match self {
            Self::Points => "points",
            Self::EyeToHand => "eye-to-hand",
            Self::EyeInHand => "eye-in-hand",
            Self::RobotWorld => "robot-world",
        }
    }

    /// The kind that samples are for where none is named: points, or eye-to-hand for poses.
    pub fn of(samples: &Samples) -> Self {
        match samples {
            Samples::Points(_) => Self::Points,
            Samples::Poses(_) => Self::EyeToHand,
        }
    }
}

/// A calibration in the form of its two files: the transform for the robot's programs, and the record for people.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Calibration {
    /// Where the camera is.
    pub camera: CameraMount,
    /// What was found, and how good it is.
    pub record: CalibrationRecord,
}

/// Where the camera is, by what it is fixed to.
#[derive(Clone, Debug, PartialEq)]
pub enum CameraMount {
    /// It is fixed: `robot_from_camera`, which `pomona pick --transform` reads.
    OnBase(NamedTransform<RobotFrame, CameraFrame>),
    /// It is on the flange: `flange_from_camera`, to be joined with the flange's pose of the moment.
    OnFlange(NamedTransform<FlangeFrame, CameraFrame>),
}

impl CameraMount {
    /// Writes the transform's file, as [`NamedTransform::write`] does.
    ///
    /// # Errors
    ///
    /// Those of [`NamedTransform::write`].
    pub fn write(&self, path: impl AsRef<Path>) -> Result<(), TransformFileError> {
        match self {
            Self::OnBase(named) => named.write(path),
            Self::OnFlange(named) => named.write(path),
        }
    }
}

/// The record of a calibration, as JSON.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct CalibrationRecord {
    /// [`RECORD_SCHEMA`].
    pub schema: &'static str,
    /// What was calibrated.
    pub kind: CalibrationKind,
    /// Seed of the search.
    pub seed: u64,
    /// The answer.
    pub camera: TransformRecord,
    /// Where the target is, for poses.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub target: Option<TransformRecord>,
    /// The minimal solver whose model was refined, for poses.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub solver: Option<PoseSolver>,
    /// How far the robot turned, for poses.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub motions: Option<MotionSpread>,
    /// Distances in the robot's frame over those in the camera's, for points.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scale: Option<f64>,
    /// How good it is.
    #[serde(flatten)]
    pub quality: Quality,
}

/// A transform in a record, with the covariance of [`UncertainTransform`].
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct TransformRecord {
    /// Id of the frame it leads to.
    pub to: String,
    /// Id of the frame it starts in.
    pub from: String,
    /// Metres.
    pub translation_m: [f64; 3],
    /// In the order x y z w.
    pub quaternion_xyzw: [f64; 4],
    /// Standard deviations of the rotation about the axes of `to`, rad.
    pub sigma_rotation_rad: [f64; 3],
    /// Standard deviations of the translation along the axes of `to`, m.
    pub sigma_translation_m: [f64; 3],
    /// Of a left perturbation, rotation first, in the axes of `to`: rad², rad·m, m².
    pub covariance_left_rotation_translation: [[f64; 6]; 6],
}

impl TransformRecord {
    fn new<To: FrameTag, From: FrameTag>(
        uncertain: &UncertainTransform<To, From>,
        to: &str,
        from: &str,
    ) -> Self {
        let (t, c) = (uncertain.transform, uncertain.covariance);
        let roots = |m: nalgebra::Matrix3<f64>| m.diagonal().map(|v| v.max(0.0).sqrt()).into();
        Self {
            to: to.to_owned(),
            from: from.to_owned(),
            translation_m: t.translation_m().into(),
            quaternion_xyzw: t.quaternion_xyzw(),
            sigma_rotation_rad: roots(uncertain.rotation_covariance_rad2()),
            sigma_translation_m: roots(uncertain.translation_covariance_m2()),
            covariance_left_rotation_translation: std::array::from_fn(|i| {
                std::array::from_fn(|j| c[(i, j)])
            }),
        }
    }
}

/// The frames' ids, each with its usual name where none is given.
struct Names<'a> {
    robot: &'a str,
    camera: &'a str,
    flange: &'a str,
    target: &'a str,
}

impl<'a> Names<'a> {
    fn of(frames: &'a FrameIds) -> Self {
        let or = |id: &'a Option<String>, usual: &'a str| id.as_deref().unwrap_or(usual);
        Self {
            robot: or(&frames.robot, "base_link"),
            camera: or(&frames.camera, "camera_color_optical_frame"),
            flange: or(&frames.flange, "flange"),
            target: or(&frames.target, "target"),
        }
    }
}

/// Calibrates from a set of samples. The same set, options and seed give the same outcome, bit for bit.
///
/// Frames without an id get `base_link`, `camera_color_optical_frame`, `flange` and `target`.
///
/// # Errors
///
/// Those of the function of the `kind`; [`CalibrateError::OtherSamples`] where the samples are not
/// for it.
pub fn calibrate(
    set: &SampleSet,
    kind: CalibrationKind,
    options: &Options,
    seed: u64,
) -> Result<Calibration, CalibrateError> {
    let mut calibration = of_kind(set, kind, options, seed)?;
    let quality = &mut calibration.record.quality;
    quality.warnings.splice(..0, set.warnings.iter().cloned());
    Ok(calibration)
}

fn of_kind(
    set: &SampleSet,
    kind: CalibrationKind,
    options: &Options,
    seed: u64,
) -> Result<Calibration, CalibrateError> {
    let rng = &mut ChaCha8Rng::seed_from_u64(seed);
    let names = Names::of(&set.frames);
    match (kind, &set.samples) {
        (CalibrationKind::Points, Samples::Points(samples)) => {
            let found = calibrate_points(samples, options, rng)?;
            let camera = TransformRecord::new(&found.camera, names.robot, names.camera);
            Ok(Calibration {
                camera: CameraMount::OnBase(named(&found.camera, &camera)),
                record: CalibrationRecord {
                    schema: RECORD_SCHEMA,
                    kind,
                    seed,
                    camera,
                    target: None,
                    solver: None,
                    motions: None,
                    scale: Some(found.scale),
                    quality: found.quality,
                },
            })
        }
        (CalibrationKind::EyeToHand | CalibrationKind::RobotWorld, Samples::Poses(samples)) => {
            let found = if kind == CalibrationKind::EyeToHand {
                calibrate_eye_to_hand(samples, options, rng)?
            } else {
                calibrate_robot_world(samples, options, rng)?
            };
            let camera = TransformRecord::new(&found.camera, names.robot, names.camera);
            let target = TransformRecord::new(&found.target, names.flange, names.target);
            Ok(Calibration {
                camera: CameraMount::OnBase(named(&found.camera, &camera)),
                record: of_poses(kind, seed, camera, target, found),
            })
        }
        (CalibrationKind::EyeInHand, Samples::Poses(samples)) => {
            let found = calibrate_eye_in_hand(samples, options, rng)?;
            let camera = TransformRecord::new(&found.camera, names.flange, names.camera);
            let target = TransformRecord::new(&found.target, names.robot, names.target);
            Ok(Calibration {
                camera: CameraMount::OnFlange(named(&found.camera, &camera)),
                record: of_poses(kind, seed, camera, target, found),
            })
        }
        (_, samples) => Err(CalibrateError::OtherSamples {
            kind: kind.name(),
            found: match samples {
                Samples::Points(_) => "points",
                Samples::Poses(_) => "poses",
            },
        }),
    }
}

fn named<To: FrameTag, From: FrameTag>(
    uncertain: &UncertainTransform<To, From>,
    record: &TransformRecord,
) -> NamedTransform<To, From> {
    NamedTransform {
        covariance: Some(uncertain.covariance),
        ..NamedTransform::new(uncertain.transform, &record.to, &record.from)
    }
}

fn of_poses<Carrier: FrameTag, Other: FrameTag>(
    kind: CalibrationKind,
    seed: u64,
    camera: TransformRecord,
    target: TransformRecord,
    found: PoseCalibration<Carrier, Other>,
) -> CalibrationRecord {
    CalibrationRecord {
        schema: RECORD_SCHEMA,
        kind,
        seed,
        camera,
        target: Some(target),
        solver: Some(found.solver),
        motions: Some(found.motions),
        scale: None,
        quality: found.quality,
    }
}
