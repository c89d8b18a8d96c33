use super::detection::BoxOriginRecord;
use super::fitted::{AppleRecord, BranchRecord, CandidateRecord};
use super::plan::PlanRecord;
use super::robot::{FallbackRecord, RobotRecord};
use super::times::milliseconds;
use crate::outcome::{AppleAnswer, StageTimes, Status};
use serde::{Deserialize, Serialize};

/// The answer for one box; what is not known is absent.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[cfg_attr(
    test,
    schemars(
        deny_unknown_fields,
        extend(
            "if" = { "properties": { "status": { "const": "picked" } } },
            "then" = { "required": ["apple", "branch", "foot", "direction"], "properties": { "fallback": false } },
            "else" = { "properties": { "direction": false, "robot": false } },
            "dependentRequired" = {
                "branch": ["apple"], "foot": ["branch"], "robot": ["direction"], "fallback": ["apple"],
                "approach": ["robot"], "gripper": ["approach", "clearance"], "clearance": ["approach"],
                "order": ["gripper"]
            }
        )
    )
)]
#[non_exhaustive]
pub struct PickRecord {
    /// Number of the box, from 0.
    pub id: usize,
    /// The box.
    #[serde(rename = "box")]
    pub pixel_box: BoxRecord,
    /// What became of it.
    pub status: Status,
    /// Probability that the box holds an apple; below one half it is refused. Method `robust`, where it checks boxes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(range(min = 0.0, max = 1.0)))]
    pub presence: Option<f64>,
    /// The apple's sphere.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub apple: Option<AppleRecord>,
    /// The line of the nearest branch.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub branch: Option<BranchRecord>,
    /// Foot of the perpendicular from the centre on the branch: the paper's C.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub foot: Option<[f64; 3]>,
    /// Unit vector from the centre to the foot: the direction of approach.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "pomona_schema::UnitVector"))]
    pub direction: Option<[f64; 3]>,
    /// Standard deviation of the direction as an angle, radians; method `robust`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub direction_sd: Option<f64>,
    /// Probability that the direction is at most 20 degrees off; below the settings' least it is refused. Method `robust`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(range(min = 0.0, max = 1.0)))]
    pub confidence: Option<f64>,
    /// Branches that were weighed against each other, the best first; method `robust`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub candidates: Vec<CandidateRecord>,
    /// For a refusal: unit vector from the apple's centre towards where a camera would see it past what hides it now.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "pomona_schema::UnitVector"))]
    pub view_from: Option<[f64; 3]>,
    /// For a refusal, where the settings ask for it: a fallback direction, not derived from a branch.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fallback: Option<FallbackRecord>,
    /// Position and direction in the robot's frame, where a transform was given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub robot: Option<RobotRecord>,
    /// How a robot gets there, where one was configured: `gripper`, `approach`, `clearance`, `order`.
    #[serde(flatten)]
    pub plan: PlanRecord,
    /// How long it took.
    pub timing_ms: StageTimesRecord,
}

/// A box of the colour image, in pixels: `x_min` <= x < `x_max`, and likewise y.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[cfg_attr(test, schemars(deny_unknown_fields, extend("dependentRequired" = { "found_by": ["mark"], "mark": ["found_by"], "merged": ["mark"] })))]
#[non_exhaustive]
pub struct BoxRecord {
    /// Name in the box file.
    pub name: String,
    /// Left edge.
    pub x_min: f64,
    /// Top edge.
    pub y_min: f64,
    /// Right edge.
    pub x_max: f64,
    /// Bottom edge.
    pub y_max: f64,
    /// Detection score, 0 to 1.
    #[cfg_attr(test, schemars(range(min = 0.0, max = 1.0)))]
    pub score: f64,
    /// How it was found and what depth says about it: `found_by`, `mark`, `merged`; absent for a box of a file.
    #[serde(flatten)]
    pub found: Option<BoxOriginRecord>,
}

/// Milliseconds of each stage: all that may differ between two runs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[cfg_attr(test, schemars(deny_unknown_fields))]
#[non_exhaustive]
pub struct StageTimesRecord {
    /// Cutting the box out of the depth image.
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub crop: f64,
    /// Fitting the sphere.
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub sphere: f64,
    /// Collecting the shell and fitting the branch.
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub branch: f64,
    /// All of it.
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub total: f64,
}

impl From<&AppleAnswer> for PickRecord {
    fn from(answer: &AppleAnswer) -> Self {
        let pick = answer.pick.as_ref();
        Self {
            id: answer.id,
            pixel_box: BoxRecord::from(answer),
            status: answer.status,
            presence: answer.presence,
            apple: answer.apple.as_ref().map(AppleRecord::from),
            branch: answer.branch.as_ref().map(BranchRecord::from),
            foot: pick.map(|p| p.foot.point().into()),
            direction: pick.map(|p| p.direction.vector().into()),
            direction_sd: pick.and_then(|p| p.sd_rad),
            confidence: answer.confidence,
            candidates: answer
                .candidates
                .iter()
                .map(CandidateRecord::from)
                .collect(),
            view_from: answer.view_from.map(|d| d.vector().into()),
            fallback: answer.fallback.as_ref().map(FallbackRecord::from),
            robot: answer.robot.as_ref().map(RobotRecord::from),
            plan: answer
                .plan
                .as_ref()
                .map(PlanRecord::from)
                .unwrap_or_default(),
            timing_ms: StageTimesRecord::from(&answer.times),
        }
    }
}

impl From<&AppleAnswer> for BoxRecord {
    fn from(answer: &AppleAnswer) -> Self {
        let bounds = &answer.bounds;
        Self {
            name: bounds.name.clone(),
            x_min: bounds.x_min,
            y_min: bounds.y_min,
            x_max: bounds.x_max,
            y_max: bounds.y_max,
            score: bounds.score,
            found: answer.origin.as_ref().map(BoxOriginRecord::from),
        }
    }
}

impl From<&StageTimes> for StageTimesRecord {
    fn from(times: &StageTimes) -> Self {
        Self {
            crop: milliseconds(times.crop),
            sphere: milliseconds(times.sphere),
            branch: milliseconds(times.branch),
            total: milliseconds(times.total),
        }
    }
}
