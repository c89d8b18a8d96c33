use crate::error::EvaluateError;
use nalgebra::{Isometry3, Point3, Quaternion, Translation3, UnitQuaternion, Vector3};
use pomona_calibrate::{CalibrateError, Options, PoseSample, calibrate_eye_to_hand};
use pomona_transforms::{CameraFrame, RobotFrame, Transform, TransformError, UncertainTransform};
use rand_chacha::ChaCha8Rng;
use rand_core::{Rng, SeedableRng};
use serde::{Deserialize, Serialize};
use std::f64::consts::{FRAC_PI_3, PI, TAU};

/// About where the camera stands: behind and above the base, metres.
const PLACE_M: [f64; 3] = [-0.3, 0.0, 0.6];
/// Half the range of its position along each axis, metres.
const PLACE_RANGE_M: f64 = 0.1;
/// Half the range of its turn from looking ahead, about each axis, radians.
const TURN_RANGE_RAD: f64 = 0.2;
/// Distance from the camera at which the target is shown to it, metres.
const WORKSPACE_M: f64 = 0.8;
/// Half the range of the flange's places about there, along each axis, metres.
const WORKSPACE_RANGE_M: f64 = 0.25;
/// Largest turn of the flange from facing the camera, radians.
const FLANGE_TURN_RAD: f64 = FRAC_PI_3;
/// Where the target is fixed on the flange, metres.
const TARGET_M: [f64; 3] = [0.03, -0.02, 0.08];
/// Half the range of its turn about each axis of the flange, radians.
const TARGET_TURN_RANGE_RAD: f64 = 0.5;
/// Largest number of poses that is simulated.
const POSES_MAX: usize = 1000;
/// Tolerance of the consensus search in standard deviations of the noise, where that exceeds the default.
const TOLERANCE_SIGMAS: f64 = 5.0;

/// What a simulated eye-to-hand calibration is made from.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct CalibrationNoise {
    /// Robot poses at which the target is observed.
    pub poses: usize,
    /// Root mean square error of the target's observed rotation, radians.
    pub rotation_rad: f64,
    /// Root mean square error of the target's observed position, metres.
    pub translation_m: f64,
}

impl Default for CalibrationNoise {
    /// That of the figures in `docs/calibration.md`: 15 poses, 0.2° and 1 mm.
    fn default() -> Self {
        Self {
            poses: 15,
            rotation_rad: 0.2_f64.to_radians(),
            translation_m: 0.001,
        }
    }
}

/// Where a camera is, and where its calibration says that it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Mounting {
    /// Its true place, `robot_from_camera`.
    pub(crate) truth: Transform<RobotFrame, CameraFrame>,
    /// What was estimated, with the covariance that the estimate states.
    pub(crate) estimate: UncertainTransform<RobotFrame, CameraFrame>,
}

/// Why no mounting could be made.
#[derive(Debug)]
pub(crate) enum MountingError {
    Noise {
        name: &'static str,
        value: f64,
        rule: &'static str,
    },
    Calibration(CalibrateError),
    Transform(TransformError),
}

impl MountingError {
    /// The same of a frame.
    pub(crate) fn of(self, case: &str) -> EvaluateError {
        let case = case.to_owned();
        match self {
            Self::Noise { name, value, rule } => EvaluateError::Noise { name, value, rule },
            Self::Calibration(source) => EvaluateError::Calibration {
                case,
                source: Box::new(source),
            },
            Self::Transform(source) => EvaluateError::Calibration {
                case,
                source: Box::new(source),
            },
        }
    }
}

impl Mounting {
    /// A camera that looks ahead from behind the base, and its eye-to-hand calibration by `pomona-calibrate` from
    /// noisy samples: the flange shows a target 0.8 m ahead of the camera, moved within ±0.25 m and turned by up to
    /// 60°.
    /// Both are drawn from `seed` alone.
    pub(crate) fn calibrated(seed: u64, noise: &CalibrationNoise) -> Result<Self, MountingError> {
        noise.check()?;
        let mut draws = MountingDraws(ChaCha8Rng::seed_from_u64(seed));
        // x right, y down, z forward for the camera; x forward, y left, z up for the base.
        let ahead = UnitQuaternion::new_unchecked(Quaternion::new(0.5, -0.5, 0.5, -0.5));
        let robot_from_camera = Isometry3::from_parts(
            Translation3::from(Vector3::from(PLACE_M) + draws.within(PLACE_RANGE_M)),
            UnitQuaternion::from_scaled_axis(draws.within(TURN_RANGE_RAD)) * ahead,
        );
        let samples = samples(&robot_from_camera, noise, &mut draws)?;
        let mut options = Options::default();
        options.translation_tolerance_m = options
            .translation_tolerance_m
            .max(TOLERANCE_SIGMAS * noise.translation_m);
        options.rotation_tolerance_rad = options
            .rotation_tolerance_rad
            .max(TOLERANCE_SIGMAS * noise.rotation_rad);
        let found = calibrate_eye_to_hand(&samples, &options, &mut draws.0)
            .map_err(MountingError::Calibration)?;
        Ok(Self {
            truth: transform(&robot_from_camera)?,
            estimate: found.camera,
        })
    }
}

impl CalibrationNoise {
    fn check(&self) -> Result<(), MountingError> {
        for (name, value) in [
            ("rotation in radians", self.rotation_rad),
            ("translation in metres", self.translation_m),
        ] {
            if !(0.0..=1.0).contains(&value) {
                return Err(MountingError::Noise {
                    name,
                    value,
                    rule: "from 0 to 1",
                });
            }
        }
        if self.poses > POSES_MAX {
            return Err(MountingError::Noise {
                name: "poses",
                value: self.poses as f64,
                rule: "at most 1000",
            });
        }
        Ok(())
    }
}

/// The stops: the flange as the robot tells it, and the target as the camera sees it, with noise.
fn samples(
    robot_from_camera: &Isometry3<f64>,
    noise: &CalibrationNoise,
    draws: &mut MountingDraws,
) -> Result<Vec<PoseSample>, MountingError> {
    let flange_from_target = Isometry3::from_parts(
        Translation3::from(Vector3::from(TARGET_M)),
        UnitQuaternion::from_scaled_axis(draws.within(TARGET_TURN_RANGE_RAD)),
    );
    // The root mean square of a vector's length is √3 times that of each component.
    let share = 3.0_f64.sqrt().recip();
    let middle = robot_from_camera * Point3::new(0.0, 0.0, WORKSPACE_M);
    // The flange's z against the line of sight.
    let facing =
        robot_from_camera.rotation * UnitQuaternion::from_axis_angle(&Vector3::x_axis(), PI);
    (0..noise.poses)
        .map(|number| {
            let turn = draws.direction() * (draws.unit() * FLANGE_TURN_RAD);
            let flange = Isometry3::from_parts(
                Translation3::from(middle.coords + draws.within(WORKSPACE_RANGE_M)),
                UnitQuaternion::from_scaled_axis(turn) * facing,
            );
            let seen = robot_from_camera.inv_mul(&(flange * flange_from_target));
            let shift = draws.normal(share * noise.translation_m);
            let turn = UnitQuaternion::from_scaled_axis(draws.normal(share * noise.rotation_rad));
            let seen = Isometry3::from_parts(
                Translation3::from(seen.translation.vector + shift),
                turn * seen.rotation,
            );
            Ok(PoseSample::new(
                format!("pose-{number}"),
                transform(&flange)?,
                transform(&seen)?,
            ))
        })
        .collect()
}

fn transform<To, From>(isometry: &Isometry3<f64>) -> Result<Transform<To, From>, MountingError>
where
    To: pomona_transforms::FrameTag,
    From: pomona_transforms::FrameTag,
{
    Transform::from_isometry(isometry).map_err(MountingError::Transform)
}

/// Random numbers of one mounting.
struct MountingDraws(ChaCha8Rng);

impl MountingDraws {
    /// Uniform in 0..1.
    fn unit(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Uniform within a cube about 0 of this half side.
    fn within(&mut self, half: f64) -> Vector3<f64> {
        Vector3::from_fn(|_, _| half * (2.0 * self.unit() - 1.0))
    }

    /// Normal in each component (Box and Muller 1958, doi 10.1214/aoms/1177706645).
    fn normal(&mut self, sd: f64) -> Vector3<f64> {
        Vector3::from_fn(|_, _| {
            let (u, v) = (self.unit(), self.unit());
            sd * (-2.0 * (1.0 - u).ln()).sqrt() * (TAU * v).cos()
        })
    }

    /// A unit vector, uniform over the sphere.
    fn direction(&mut self) -> Vector3<f64> {
        self.normal(1.0)
            .try_normalize(1e-9)
            .unwrap_or_else(Vector3::x)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pomona_transforms::Position;

    const EXACT: CalibrationNoise = CalibrationNoise {
        poses: 15,
        rotation_rad: 0.0,
        translation_m: 0.0,
    };

    #[test]
    fn without_noise_the_place_is_found_and_with_it_about_as_far_off_as_measured() {
        let apple = Position::new(Point3::new(0.1, -0.1, 0.9));
        let off = |seed, noise: &CalibrationNoise| {
            let m = Mounting::calibrated(seed, noise).unwrap();
            let (seen, true_place) = (
                m.estimate.transform.position(&apple),
                m.truth.position(&apple),
            );
            seen.distance(&true_place)
        };
        for seed in 0..5 {
            assert!(off(seed, &EXACT) < 1e-9, "{}", off(seed, &EXACT));
        }
        // docs/calibration.md: 0.52 mm in the median at the middle of the workspace.
        let mut noisy: Vec<f64> = (0..9)
            .map(|seed| off(seed, &CalibrationNoise::default()))
            .collect();
        let median = pomona_statistics::median(&mut noisy).unwrap();
        assert!((0.2e-3..1.2e-3).contains(&median), "{noisy:?}");
    }

    #[test]
    fn a_seed_is_a_mounting() {
        let noise = CalibrationNoise::default();
        let [a, b, c] = [1, 1, 2].map(|seed| Mounting::calibrated(seed, &noise).unwrap());
        assert_eq!(a, b);
        assert!((a.truth.matrix() - c.truth.matrix()).amax() > 1e-3);
    }

    #[test]
    fn nonsense_is_refused_with_the_number() {
        for (poses, rotation_rad, translation_m, word) in [
            (15, f64::NAN, 0.0, "rotation"),
            (15, 0.0, -0.1, "translation"),
            (100_000, 0.0, 0.0, "poses"),
            (3, 0.0, 0.0, "orchard-007"),
        ] {
            let noise = CalibrationNoise {
                poses,
                rotation_rad,
                translation_m,
            };
            let error = Mounting::calibrated(0, &noise).unwrap_err();
            let message = error.of("orchard-007").to_string();
            assert!(message.contains(word), "{message}");
        }
    }
}
