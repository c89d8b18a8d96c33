//! What `fused.json` holds, made from the typed result.

use crate::answer::{
    DirectionUse, FrameShift, FusedApple, FusedFrame, FusedObservation, FusedStatus, FusedTree,
    Movement, PositionUse,
};
use pomona::Status;
use pomona_transforms::ToolOrientation;
#[cfg(test)]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Name and version of the form of [`FusedRecord`].
pub const FUSED_SCHEMA: &str = "pomona.fused/1";

/// The apples of one tree from several frames, as `pomona pick --fuse` writes them to fused.json. Lengths in metres,
/// angles in radians; positions and directions in the robot's frame. What is not known is absent.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema), schemars(deny_unknown_fields))]
#[non_exhaustive]
pub struct FusedRecord {
    /// Name and version of this form.
    #[cfg_attr(test, schemars(extend("const" = FUSED_SCHEMA)))]
    pub schema: String,
    /// Name of the robot's frame.
    pub frame_id: String,
    /// The frames, in the order in which they were given.
    #[cfg_attr(test, schemars(length(min = 2)))]
    pub frames: Vec<FusedFrameRecord>,
    /// One entry for each apple, in the order in which the frames show them first.
    pub apples: Vec<FusedAppleRecord>,
}

/// One of the frames.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema), schemars(deny_unknown_fields))]
#[non_exhaustive]
pub struct FusedFrameRecord {
    /// The name of the frame's folder.
    pub id: String,
    /// Name of the camera's frame.
    pub frame_id: String,
    /// Number of apples with a sphere.
    pub apples: usize,
    /// Of these, the number that another frame shows at the same position.
    pub shared: usize,
    /// Shift of all apples of the frame from the first frame, at the centroid of the tree: sway of the tree, or an error of
    /// the poses. Absent for the first frame and where no apple is shared.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shift: Option<ShiftRecord>,
}

/// A shift that all apples of a frame have in common.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema), schemars(deny_unknown_fields))]
#[non_exhaustive]
pub struct ShiftRecord {
    /// From the position in the first frame to that in this one.
    pub by: [f64; 3],
    /// Its length.
    #[cfg_attr(test, schemars(range(min = 0)))]
    pub distance: f64,
    /// Standard deviation of the shift, the mean over the axes.
    #[cfg_attr(test, schemars(range(min = 0)))]
    pub sd: f64,
    /// Whether noise and the stated errors of the poses explain it at the rate of `fusion.moved_rate` only.
    pub significant: bool,
}

/// An apple of the tree.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(
    test,
    derive(JsonSchema),
    schemars(
        deny_unknown_fields,
        extend(
            "if" = {"properties": {"status": {"const": "picked"}}},
            "then" = {
                "required": ["direction", "direction_sd", "confidence", "quaternion_xyzw"],
                "properties": {"view_from": false}
            },
            "else" = {
                "properties": {"direction": false, "direction_sd": false, "foot": false, "quaternion_xyzw": false}
            }
        )
    )
)]
#[non_exhaustive]
pub struct FusedAppleRecord {
    /// Number of the apple, from 0.
    pub id: usize,
    /// What became of it: `picked`, or the reason of the refusal.
    pub status: FusedStatus,
    /// Its centre; of an apple that has moved that in the last frame that shows it.
    pub center: [f64; 3],
    /// Covariance of the centre, square metres; errors of the poses included.
    pub center_covariance: [[f64; 3]; 3],
    /// Its radius.
    #[cfg_attr(test, schemars(extend("exclusiveMinimum" = 0)))]
    pub radius: f64,
    /// Standard deviation of the radius.
    #[cfg_attr(test, schemars(range(min = 0)))]
    pub radius_sd: f64,
    /// Direction of approach, a unit vector.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "pomona_schema::UnitVector"))]
    pub direction: Option<[f64; 3]>,
    /// Standard deviation of the direction as an angle.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(range(min = 0)))]
    pub direction_sd: Option<f64>,
    /// Probability that the direction is at most 20 degrees off.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(range(min = 0, max = 1)))]
    pub confidence: Option<f64>,
    /// Where status and confidence come from, in words.
    pub reason: String,
    /// Foot of the perpendicular from the centre on the branch.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub foot: Option<[f64; 3]>,
    /// Orientation of a tool that approaches along its +x axis, x y z w with w ≥ 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "pomona_schema::UnitQuaternion"))]
    pub quaternion_xyzw: Option<[f64; 4]>,
    /// A movement of this apple between frames, beyond the shift that all have in common.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub moved: Option<MovedRecord>,
    /// For an apple without a direction: unit vectors from its centre towards where a camera would see it less occluded,
    /// one for each frame that says so.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[cfg_attr(test, schemars(with = "Vec<pomona_schema::UnitVector>"))]
    pub view_from: Vec<[f64; 3]>,
    /// The frames' observations of it, in the order of the frames.
    #[cfg_attr(test, schemars(length(min = 1)))]
    pub sightings: Vec<SightingRecord>,
}

/// A movement of one apple.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema), schemars(deny_unknown_fields))]
#[non_exhaustive]
pub struct MovedRecord {
    /// Its other position.
    pub from: [f64; 3],
    /// From there to its centre.
    pub by: [f64; 3],
    /// Length of the movement.
    #[cfg_attr(test, schemars(range(min = 0)))]
    pub distance: f64,
    /// Standard deviation of the length.
    #[cfg_attr(test, schemars(range(min = 0)))]
    pub sd: f64,
    /// Indices of the frames that show it at its other position.
    #[cfg_attr(test, schemars(length(min = 1)))]
    pub frames: Vec<usize>,
}

/// One apple as one frame shows it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema), schemars(deny_unknown_fields))]
#[non_exhaustive]
pub struct SightingRecord {
    /// Index of the frame.
    pub frame: usize,
    /// Id of the pick in the frame's picks.json.
    pub pick: usize,
    /// The pick's status.
    #[cfg_attr(test, schemars(with = "String"))]
    pub status: Status,
    /// What became of its position.
    pub place: PositionUse,
    /// Distance of its centre, the frame's motion taken off, from the fused one; of an apple that has moved from that of its
    /// position then.
    #[cfg_attr(test, schemars(range(min = 0)))]
    pub residual: f64,
    /// What became of its direction.
    pub direction: DirectionUse,
    /// Angle of its direction to the fused one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(range(min = 0)))]
    pub direction_off: Option<f64>,
}

impl From<&FusedTree> for FusedRecord {
    fn from(tree: &FusedTree) -> Self {
        Self {
            schema: FUSED_SCHEMA.to_owned(),
            frame_id: tree.frame_id.clone(),
            frames: tree.frames.iter().map(Into::into).collect(),
            apples: tree.apples.iter().map(Into::into).collect(),
        }
    }
}

impl From<&FusedFrame> for FusedFrameRecord {
    fn from(frame: &FusedFrame) -> Self {
        Self {
            id: frame.id.clone(),
            frame_id: frame.camera_frame_id.clone(),
            apples: frame.apples,
            shared: frame.shared,
            shift: frame.shift.as_ref().map(Into::into),
        }
    }
}

impl From<&FrameShift> for ShiftRecord {
    fn from(shift: &FrameShift) -> Self {
        Self {
            by: shift.by.into(),
            distance: shift.by.norm(),
            sd: shift.sd_m,
            significant: shift.significant,
        }
    }
}

impl From<&FusedApple> for FusedAppleRecord {
    fn from(apple: &FusedApple) -> Self {
        let direction = apple.direction.as_ref();
        let tool = direction.map(|d| ToolOrientation::along(&d.direction));
        Self {
            id: apple.id,
            status: apple.status,
            center: apple.center.position.point().into(),
            center_covariance: apple.center.covariance_m2.into(),
            radius: apple.radius_m,
            radius_sd: apple.radius_sd_m,
            direction: direction.map(|d| d.direction.vector().into()),
            direction_sd: direction.map(|d| d.sd_rad),
            confidence: apple.confidence,
            reason: apple.reason.clone(),
            foot: direction
                .and_then(|d| d.foot)
                .map(|foot| foot.point().into()),
            quaternion_xyzw: tool.map(|t| t.quaternion_xyzw()),
            moved: apple.movement.as_ref().map(Into::into),
            view_from: apple
                .next_views
                .iter()
                .map(|view| view.vector().into())
                .collect(),
            sightings: apple.observations.iter().map(Into::into).collect(),
        }
    }
}

impl From<&Movement> for MovedRecord {
    fn from(movement: &Movement) -> Self {
        Self {
            from: movement.from.point().into(),
            by: movement.by.into(),
            distance: movement.by.norm(),
            sd: movement.sd_m,
            frames: movement.frames.clone(),
        }
    }
}

impl From<&FusedObservation> for SightingRecord {
    fn from(observation: &FusedObservation) -> Self {
        Self {
            frame: observation.frame,
            pick: observation.pick,
            status: observation.status,
            place: observation.position_use,
            residual: observation.residual_m,
            direction: observation.direction_use,
            direction_off: observation.direction_offset_rad,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_schema_in_the_docs_is_that_of_the_types() {
        pomona_schema::assert_in_docs::<FusedRecord>(FUSED_SCHEMA, "fused.schema.json");
    }
}
