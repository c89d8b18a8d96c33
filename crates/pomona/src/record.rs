//! The form of `picks.json`, `pomona.picks/1`: what is written from the answers, and read by other programs.
//!
//! The program's own stages read the answers ([`FrameAnswer`]), never a record.

mod detection;
mod fitted;
mod pick;
mod plan;
mod robot;
#[cfg(test)]
mod schema;
mod times;
mod warning;

pub use detection::{BoxOriginRecord, DetectionSummaryRecord, DetectionTimesRecord};
pub use fitted::{AppleRecord, BranchRecord, CandidateRecord};
pub use pick::{BoxRecord, PickRecord, StageTimesRecord};
pub use plan::{
    ApproachRecord, ClearanceRecord, GripperRecord, OrderRecord, PathRecord, PieceRecord,
    PlanRecord, PoseRecord, SampleRecord, WayRecord,
};
pub use robot::{FallbackRecord, RobotRecord};
pub use warning::WarningRecord;

use crate::outcome::FrameAnswer;
use serde::{Deserialize, Serialize};

/// Name and version of the form of [`PicksRecord`].
pub const SCHEMA: &str = "pomona.picks/1";

/// What `picks.json` holds: the answer for each box of one frame. Lengths in metres, angles in radians; positions and
/// directions in the camera's REP-103 optical frame (x right, y down, z forward). What is not known is absent.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[cfg_attr(test, schemars(deny_unknown_fields))]
#[non_exhaustive]
pub struct PicksRecord {
    /// [`SCHEMA`].
    #[cfg_attr(test, schemars(extend("const" = SCHEMA)))]
    pub schema: String,
    /// Name of the method.
    #[cfg_attr(test, schemars(extend("enum" = crate::config::Method::ALL.map(crate::config::Method::name))))]
    pub method: String,
    /// Seed of the run.
    pub seed: u64,
    /// The frame.
    pub frame: FrameRecord,
    /// What found the boxes; absent where they came with the frame or in a file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub detection: Option<DetectionSummaryRecord>,
    /// What was assumed about the input, or is doubtful about it; absent where nothing is.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[cfg_attr(test, schemars(length(min = 1)))]
    pub warnings: Vec<WarningRecord>,
    /// One entry for each box, in the boxes' order.
    pub picks: Vec<PickRecord>,
}

/// Which frame.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[cfg_attr(test, schemars(deny_unknown_fields))]
#[non_exhaustive]
pub struct FrameRecord {
    /// Its id: the name of its folder.
    pub id: String,
    /// The coordinate frame that positions and directions are given in: the camera's.
    pub frame_id: String,
}

impl From<&FrameAnswer> for PicksRecord {
    fn from(answer: &FrameAnswer) -> Self {
        Self {
            schema: SCHEMA.to_owned(),
            method: answer.method.name().to_owned(),
            seed: answer.seed,
            frame: FrameRecord {
                id: answer.id.clone(),
                frame_id: answer.camera_frame_id.clone(),
            },
            detection: answer.detection.as_ref().map(DetectionSummaryRecord::from),
            warnings: answer.warnings.iter().map(WarningRecord::from).collect(),
            picks: answer.apples.iter().map(PickRecord::from).collect(),
        }
    }
}

impl PicksRecord {
    /// The record with all timings set to 0: what is left is the same for the same
    /// input, seed and build.
    #[must_use]
    pub fn without_timing(mut self) -> Self {
        for pick in &mut self.picks {
            pick.timing_ms = StageTimesRecord::default();
        }
        if let Some(detection) = &mut self.detection {
            detection.timing_ms = DetectionTimesRecord {
                depth_search: detection.timing_ms.depth_search.map(|_| 0.0),
                ..DetectionTimesRecord::default()
            };
        }
        self
    }
}
