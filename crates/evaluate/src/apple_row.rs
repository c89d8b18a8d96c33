use crate::robot::BaseRow;
use nalgebra::{Point3, Vector3};
use pomona::AppleAnswer;
use pomona::record::StageTimesRecord;
use pomona_geometry::angle_between;
use pomona_scenes::AppleTruth;
use serde::{Deserialize, Serialize};

/// Least share of an apple's silhouette that must show for it to count as visible.
const VISIBLE_APPLE_SHARE: f64 = 0.1;

/// Least length of a branch that must show within 3 radii for it to count as visible, metres.
///
/// Twice the inlier band of the published method: less does not tell a direction.
const VISIBLE_BRANCH_LENGTH_M: f64 = 0.010;

/// Least pixels of a branch that must show within 3 radii for it to count as visible.
const VISIBLE_BRANCH_PIXELS: usize = 20;

/// Status of an apple for which the frame had no box.
pub const NO_BOX: &str = "no_box";

/// One apple under one method: what was said, how far it is off, and how hard it was.
///
/// Metres and radians; what is not known is absent.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct AppleRow {
    /// Suite, or folder of frames.
    pub suite: String,
    /// Scene or frame.
    pub case: String,
    /// Number of the case in its suite.
    pub case_number: usize,
    /// Name of the apple's box.
    pub apple: String,
    /// Method.
    pub method: String,
    /// Whether the scene was made for this apple; only such apples enter the statistics.
    pub target: bool,
    /// `picked`, the reason of refusal, or [`NO_BOX`].
    pub status: String,
    /// Angle between the direction given and the true one.
    pub angle_error: Option<f64>,
    /// Distance between the centre given and the true one.
    pub center_error: Option<f64>,
    /// Centre given less the true one, in the camera's frame.
    pub center_offset: Option<[f64; 3]>,
    /// Radius given less the true one.
    pub radius_error: Option<f64>,
    /// Distance between the foot given and the true nearest point of the branch's axis.
    pub foot_error: Option<f64>,
    /// Radius given.
    pub radius: Option<f64>,
    /// Centre given: the paper's O.
    pub center: Option<[f64; 3]>,
    /// Foot given: the paper's C.
    pub foot: Option<[f64; 3]>,
    /// Direction given: the paper's OC, a unit vector.
    pub direction: Option<[f64; 3]>,
    /// Probability, as the method says, that its direction is at most 20° off; also of refused apples that it
    /// weighed.
    #[serde(default)]
    pub confidence: Option<f64>,
    /// Standard deviation of the direction, as the method says.
    #[serde(default)]
    pub direction_sd: Option<f64>,
    /// True centre.
    pub true_center: [f64; 3],
    /// True radius.
    pub true_radius: f64,
    /// True direction; absent where no branch is near.
    pub true_direction: Option<[f64; 3]>,
    /// Distance of the true centre from the camera.
    pub distance: f64,
    /// Visible share of the apple's silhouette.
    pub visible_share: Option<f64>,
    /// Radius of the true branch.
    pub branch_radius: Option<f64>,
    /// Length of the true branch that shows within 3 radii.
    pub visible_branch_length: Option<f64>,
    /// Leaves of the scene within 3 radii.
    pub leaves: Option<f64>,
    /// Whether the camera could see apple and branch: a tenth of the silhouette, and 10 mm and 20 pixels of the branch within
    /// 3 radii; absent where the truth does not say.
    pub answerable: Option<bool>,
    /// The gripper in the base's frame, where a robot was simulated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub base: Option<BaseRow>,
    /// Milliseconds of each stage.
    pub timing_ms: Option<StageTimesRecord>,
}

impl AppleRow {
    /// Compares one apple's truth with its answer.
    pub(crate) fn new(
        suite: &str,
        case: &str,
        case_number: usize,
        method: &str,
        truth: &AppleTruth,
        answer: Option<&AppleAnswer>,
    ) -> Self {
        let true_center = Point3::from(truth.center);
        let apple = answer.and_then(|a| a.apple);
        let center = apple.map(|a| a.center.point());
        let offset = center.map(|center| center - true_center);
        let pick = answer.and_then(|a| a.pick);
        let direction = pick.map(|p| p.direction.vector());
        let foot = pick.map(|p| p.foot.point());
        let branch = truth.branch.as_ref();
        Self {
            suite: suite.to_owned(),
            case: case.to_owned(),
            case_number,
            apple: truth.bounds.name.clone(),
            method: method.to_owned(),
            target: truth.target.unwrap_or(true),
            status: answer.map_or(NO_BOX, |a| a.status.name()).to_owned(),
            angle_error: direction
                .zip(truth.direction)
                .and_then(|(given, right)| angle_between(&given, &Vector3::from(right))),
            center_error: offset.map(|o| o.norm()),
            center_offset: offset.map(Into::into),
            radius_error: apple.map(|a| a.radius_m - truth.radius),
            foot_error: foot
                .zip(branch)
                .map(|(foot, b)| (foot - Point3::from(b.point)).norm()),
            radius: apple.map(|a| a.radius_m),
            center: center.map(Into::into),
            foot: foot.map(Into::into),
            direction: direction.map(Into::into),
            confidence: answer.and_then(|a| a.confidence),
            direction_sd: pick.and_then(|p| p.sd_rad),
            true_center: truth.center,
            true_radius: truth.radius,
            true_direction: truth.direction,
            distance: true_center.coords.norm(),
            visible_share: truth.visible_share,
            branch_radius: branch.map(|b| b.radius),
            visible_branch_length: branch.and_then(|b| b.visible_length),
            leaves: truth.leaves.map(|n| n as f64),
            answerable: answerable(truth),
            base: None,
            timing_ms: answer.map(|a| StageTimesRecord::from(&a.times)),
        }
    }

    /// Whether it was answered with a direction.
    pub fn is_answered(&self) -> bool {
        self.direction.is_some()
    }
}

/// The known values of a field, each with its case.
pub(crate) fn values(
    rows: &[&AppleRow],
    field: impl Fn(&AppleRow) -> Option<f64>,
) -> Vec<(usize, f64)> {
    rows.iter()
        .filter_map(|row| Some((row.case_number, field(row)?)))
        .collect()
}

/// The mean of each coordinate; `None` where there are no points.
pub(crate) fn mean_of(points: &[[f64; 3]]) -> Option<[f64; 3]> {
    let n = points.len() as f64;
    (!points.is_empty())
        .then(|| [0, 1, 2].map(|axis| points.iter().map(|p| p[axis]).sum::<f64>() / n))
}

/// Whether the camera could see the apple and its branch; `None` where the truth does not say.
fn answerable(truth: &AppleTruth) -> Option<bool> {
    if truth
        .visible_share
        .is_some_and(|share| share < VISIBLE_APPLE_SHARE)
    {
        return Some(false);
    }
    let Some(branch) = &truth.branch else {
        return Some(false);
    };
    let long = branch
        .visible_length
        .map(|length| length >= VISIBLE_BRANCH_LENGTH_M);
    let large = branch
        .visible_pixels
        .map(|pixels| pixels >= VISIBLE_BRANCH_PIXELS);
    match (long, large) {
        (Some(false), _) | (_, Some(false)) => Some(false),
        (None, None) => None,
        _ => Some(true),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pomona::{FittedApple, PickDirection, Status};
    use pomona_transforms::{Direction, Position};
    use serde_json::json;

    fn truth(visible_length: f64, visible_share: f64) -> AppleTruth {
        serde_json::from_value(json!({
            "box": {"name": "0", "x_min": 0, "y_min": 0, "x_max": 9, "y_max": 9, "score": 1.0},
            "center": [0.0, 0.0, 0.8], "radius": 0.04, "visible_share": visible_share,
            "branch": {"point": [0.0, -0.05, 0.8], "direction": [1.0, 0.0, 0.0], "radius": 0.005,
                       "visible_length": visible_length, "visible_pixels": 500},
            "direction": [0.0, -1.0, 0.0]
        }))
        .unwrap()
    }

    fn answer() -> AppleAnswer {
        let center = Position::new(Point3::new(0.0, 0.003, 0.804));
        let mut answer = AppleAnswer::new(0, truth(0.1, 1.0).bounds, Status::Picked);
        answer.apple = Some(FittedApple::new(center, 0.041, 9, 0.0));
        let along_x = Direction::new(Vector3::x()).unwrap();
        let mut pick = PickDirection::new(&center, center.moved(&along_x, 0.05)).unwrap();
        pick.foot = Position::new(Point3::new(0.05, 0.0, 0.8));
        answer.pick = Some(pick);
        answer
    }

    #[test]
    fn errors_are_against_the_truth() {
        let row = AppleRow::new("s", "c", 0, "m", &truth(0.1, 1.0), Some(&answer()));
        assert!((row.angle_error.unwrap() - std::f64::consts::FRAC_PI_2).abs() < 1e-12);
        assert!((row.center_error.unwrap() - 0.005).abs() < 1e-12);
        assert!((row.radius_error.unwrap() - 0.001).abs() < 1e-12);
        assert!((row.foot_error.unwrap() - 0.05 * 2f64.sqrt()).abs() < 1e-12);
        assert_eq!(row.answerable, Some(true));
        assert!(row.is_answered());
    }

    #[test]
    fn a_refusal_keeps_its_sphere_and_has_no_direction() {
        let mut refused = answer();
        (refused.status, refused.pick) = (Status::NoBranch, None);
        let row = AppleRow::new("s", "c", 0, "m", &truth(0.1, 1.0), Some(&refused));
        assert!(row.center_error.is_some() && row.angle_error.is_none() && !row.is_answered());
        assert_eq!(
            AppleRow::new("s", "c", 0, "m", &truth(0.1, 1.0), None).status,
            NO_BOX
        );
    }

    #[test]
    fn what_the_camera_cannot_see_is_not_answerable() {
        assert_eq!(answerable(&truth(0.1, 0.5)), Some(true));
        assert_eq!(answerable(&truth(0.002, 1.0)), Some(false));
        assert_eq!(answerable(&truth(0.1, 0.05)), Some(false));
        let bare = AppleTruth {
            branch: None,
            direction: None,
            ..truth(0.1, 1.0)
        };
        assert_eq!(answerable(&bare), Some(false));
        let mut silent = truth(0.1, 1.0);
        let branch = silent.branch.as_mut().unwrap();
        (branch.visible_length, branch.visible_pixels) = (None, None);
        assert_eq!(answerable(&silent), None);
    }
}
