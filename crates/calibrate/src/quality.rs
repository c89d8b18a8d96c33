use nalgebra::{Isometry3, Matrix3, Vector3};
use pomona_files::Warning;
use serde::Serialize;

/// How good a calibration is, judged by its own samples.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Quality {
    /// Every sample, in the order given.
    pub samples: Vec<SampleQuality>,
    /// Standard deviation of one component of a sample's translation or place, m.
    pub noise_translation_m: f64,
    /// Standard deviation of one component of a target's rotation, rad; `None` for point pairs.
    pub noise_rotation_rad: Option<f64>,
    /// The fruit's distance, m, for which the next numbers hold.
    pub fruit_distance_m: f64,
    /// Standard deviation of a place at the fruit's distance straight ahead due to the calibration, m: root of the
    /// trace of its 3×3 covariance.
    pub sigma_at_fruit_m: f64,
    /// Standard deviation of the rotation due to the calibration, rad: root of the trace.
    pub sigma_rotation_rad: f64,
    /// Leave-one-out errors.
    pub leave_one_out: LeaveOneOut,
    /// What is doubtful about the samples.
    pub warnings: Vec<Warning>,
}

/// One sample against the calibration.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct SampleQuality {
    /// Its id.
    pub id: String,
    /// How far it is off in place, m.
    pub translation_m: f64,
    /// How far it is off in rotation, rad; `None` for point pairs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rotation_rad: Option<f64>,
    /// Its offset in units of the noise: about the root of the number of components, 1.7 for a
    /// place and 2.4 for a pose.
    pub sigmas: f64,
    /// Weight in the fit, about 1; 0 where it is rejected.
    pub weight: f64,
    /// Why it is rejected; `None` where it is not.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rejected: Option<Rejection>,
    /// How far off it is from the calibration made without it, m and rad; `None` where it is rejected.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub left_out: Option<LeftOut>,
}

/// Why a sample is an outlier.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Rejection {
    /// The likely cause.
    pub cause: RejectionCause,
    /// The same in a sentence, with numbers.
    pub reason: String,
}

/// The likely cause of a large residual.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum RejectionCause {
    /// The target's rotation is far off: a marker seen flipped, mirrored, or mistaken for another.
    TargetFlipped,
    /// The place is far off: the robot or target moved in between, or its id belongs to another place.
    PlaceFarOff,
    /// Off by more than the noise of the others explains.
    BeyondNoise,
}

/// A sample against the calibration that was made without it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct LeftOut {
    /// How far the sample is off in place, m.
    pub translation_m: f64,
    /// How far it is off in rotation, rad; `None` for point pairs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rotation_rad: Option<f64>,
    /// How far the calibration without it moves a fruit at the fruit's distance, m.
    pub shift_at_fruit_m: f64,
}

/// The calibrations that leave out one sample each.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct LeaveOneOut {
    /// Root mean square of how far left-out samples are off in place, m.
    pub translation_rms_m: f64,
    /// The same in rotation, rad; `None` for point pairs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rotation_rms_rad: Option<f64>,
    /// Standard deviation at the fruit's distance by the jackknife, m: √((n − 1)/n Σ ‖shift‖²) (Tukey 1958;
    /// Efron and Stein 1981, doi 10.1214/aos/1176345462).
    pub sigma_at_fruit_m: f64,
    /// Largest shift at the fruit's distance that a single sample makes, m.
    pub largest_shift_at_fruit_m: f64,
}

impl LeaveOneOut {
    pub(crate) fn of(samples: &[SampleQuality]) -> Self {
        let left_out: Vec<LeftOut> = samples.iter().filter_map(|s| s.left_out).collect();
        let n = left_out.len() as f64;
        let mean =
            |f: &dyn Fn(&LeftOut) -> f64| left_out.iter().map(|l| f(l).powi(2)).sum::<f64>() / n;
        let rotations = left_out.iter().all(|l| l.rotation_rad.is_some());
        Self {
            translation_rms_m: mean(&|l| l.translation_m).sqrt(),
            rotation_rms_rad: (rotations && !left_out.is_empty())
                .then(|| mean(&|l| l.rotation_rad.unwrap_or(0.0)).sqrt()),
            sigma_at_fruit_m: ((n - 1.0) * mean(&|l| l.shift_at_fruit_m)).sqrt(),
            largest_shift_at_fruit_m: left_out
                .iter()
                .map(|l| l.shift_at_fruit_m)
                .fold(0.0, f64::max),
        }
    }
}

/// A fruit straight ahead of the camera.
pub(crate) fn fruit(distance_m: f64) -> nalgebra::Point3<f64> {
    nalgebra::Point3::new(0.0, 0.0, distance_m)
}

/// How far two calibrations put that fruit apart, m.
pub(crate) fn shift_at(a: &Isometry3<f64>, b: &Isometry3<f64>, distance_m: f64) -> f64 {
    let fruit = fruit(distance_m);
    nalgebra::distance(&(a * fruit), &(b * fruit))
}

/// Root of the trace of a covariance.
pub(crate) fn spread(covariance: &Matrix3<f64>) -> f64 {
    covariance.trace().max(0.0).sqrt()
}

/// The likely cause of a residual of this size.
pub(crate) fn rejection(
    place_m: f64,
    rotation: Option<Vector3<f64>>,
    sigmas: f64,
    tolerance_m: f64,
) -> Rejection {
    let degrees = rotation.map_or(0.0, |r| r.norm().to_degrees());
    let off = match rotation {
        Some(_) => format!("{degrees:.1} degrees and {:.1} mm off", place_m * 1e3),
        None => format!("{:.1} mm off", place_m * 1e3),
    };
    // A flip turns by far more than any noise does.
    let (cause, guess) = if degrees > 10.0 {
        (
            RejectionCause::TargetFlipped,
            "the target was probably seen flipped or mistaken for another, or its id belongs to another pose; look at the image, or leave it out",
        )
    } else if place_m > 2.0 * tolerance_m {
        (
            RejectionCause::PlaceFarOff,
            "the robot or the target probably moved between the two readings, or the id belongs to another place; take it again, or leave it out",
        )
    } else {
        (
            RejectionCause::BeyondNoise,
            "more than the noise of the others explains; take it again, or leave it out",
        )
    };
    Rejection {
        cause,
        reason: format!("{off}, {sigmas:.0} times the noise: {guess}"),
    }
}
