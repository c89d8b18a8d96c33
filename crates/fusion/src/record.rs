use serde::{Deserialize, Serialize};

/// Name and version of the form of [`FusedRecord`].
pub const FUSED_SCHEMA: &str = "pomona.fused/1";

/// What `fused.json` holds: the apples of one tree from several frames. Lengths in metres, angles in radians; positions
/// and directions in the robot's frame. What is not known is absent.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[cfg_attr(test, schemars(deny_unknown_fields))]
pub struct FusedRecord {
    /// [`FUSED_SCHEMA`].
    #[cfg_attr(test, schemars(extend("const" = FUSED_SCHEMA)))]
    pub schema: String,
    /// Name of the frame that positions and directions are given in: the robot's.
    pub frame_id: String,
    /// The frames, in the order in which they were given.
    #[cfg_attr(test, schemars(length(min = 2)))]
    pub frames: Vec<FusedFrame>,
    /// One entry for each apple, in the order in which the frames show them first.
    pub apples: Vec<FusedApple>,
}

/// One of the frames.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[cfg_attr(test, schemars(deny_unknown_fields))]
pub struct FusedFrame {
    /// Its id.
    pub id: String,
    /// The camera's frame.
    pub frame_id: String,
    /// Apples with a sphere.
    pub apples: usize,
    /// Of these, those that another frame shows in the same place.
    pub shared: usize,
    /// How far everything in it stands off from the first frame, at the middle of the tree: sway of the tree, or an error
    /// of the poses. Absent for the first frame and where no apple is shared.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shift: Option<ShiftRecord>,
}

/// A shift that all apples of a frame have in common.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[cfg_attr(test, schemars(deny_unknown_fields))]
pub struct ShiftRecord {
    /// The way from the place in the first frame to that in this one.
    pub by: [f64; 3],
    /// Its length.
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub distance: f64,
    /// Standard deviation of the shift, the mean over the axes.
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub sd: f64,
    /// Whether noise and the stated errors of the poses explain it at the rate of `fusion.moved_rate` only.
    pub significant: bool,
}

/// What became of a fused apple.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum FusedStatus {
    /// It has a direction.
    Picked,
    /// No frame gives it a direction.
    NoDirection,
    /// The frames' directions contradict each other, and none is sure enough.
    Contradiction,
    /// There is a direction, but it is not sure enough.
    Unsure,
}

impl FusedStatus {
    /// Its name in `fused.json`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Picked => "picked",
            Self::NoDirection => "no_direction",
            Self::Contradiction => "contradiction",
            Self::Unsure => "unsure",
        }
    }
}

/// An apple of the tree; what is not known is absent.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[cfg_attr(
    test,
    schemars(
        deny_unknown_fields,
        extend(
            "if" = { "properties": { "status": { "const": "picked" } } },
            "then" = {
                "required": ["direction", "direction_sd", "confidence", "quaternion_xyzw"],
                "properties": { "view_from": false }
            },
            "else" = {
                "properties": { "direction": false, "direction_sd": false, "foot": false, "quaternion_xyzw": false }
            }
        )
    )
)]
pub struct FusedApple {
    /// Its number, from 0.
    pub id: usize,
    /// What became of it.
    pub status: FusedStatus,
    /// Its centre; of a moved apple that of the last frame that shows it.
    pub center: [f64; 3],
    /// Covariance of the centre, square metres, errors of the poses included.
    pub center_covariance: [[f64; 3]; 3],
    /// Its radius.
    #[cfg_attr(test, schemars(extend("exclusiveMinimum" = 0)))]
    pub radius: f64,
    /// Standard deviation of the radius.
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub radius_sd: f64,
    /// Direction of approach, a unit vector.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "pomona_schema::UnitVector"))]
    pub direction: Option<[f64; 3]>,
    /// Standard deviation of the direction as an angle.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub direction_sd: Option<f64>,
    /// Probability that the direction is at most 20 degrees off; below the settings' least it is refused.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(range(min = 0.0, max = 1.0)))]
    pub confidence: Option<f64>,
    /// Where the status and the confidence come from, in words.
    pub reason: String,
    /// The place of the branch nearest to the centre.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub foot: Option<[f64; 3]>,
    /// Orientation of a tool that approaches along its +x axis, x y z w with w ≥ 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(with = "pomona_schema::UnitQuaternion"))]
    pub quaternion_xyzw: Option<[f64; 4]>,
    /// How it was found to have moved between frames.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub moved: Option<MovedRecord>,
    /// For an apple without a direction: unit vectors from its centre towards where another look would help, one for
    /// each frame that says so.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[cfg_attr(test, schemars(with = "Vec<pomona_schema::UnitVector>"))]
    pub view_from: Vec<[f64; 3]>,
    /// Where it is seen, in the order of the frames.
    #[cfg_attr(test, schemars(length(min = 1)))]
    pub sightings: Vec<SightingRecord>,
}

/// A movement of one apple, beyond the shift that all have in common.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[cfg_attr(test, schemars(deny_unknown_fields))]
pub struct MovedRecord {
    /// Its other place.
    pub from: [f64; 3],
    /// The way from there to its centre.
    pub by: [f64; 3],
    /// Length of the way.
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub distance: f64,
    /// Standard deviation along the way.
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub sd: f64,
    /// Indices of the frames that show it at its other place.
    #[cfg_attr(test, schemars(length(min = 1)))]
    pub frames: Vec<usize>,
}

/// What became of the place where one frame shows an apple.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum PlaceUse {
    /// It is one of those that agree.
    Used,
    /// The apple has moved: it stood there in that frame.
    Elsewhere,
    /// It contradicts a place that is better seen, and counts for nothing.
    Misfit,
}

/// What became of one frame's direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum DirectionUse {
    /// There is none.
    None,
    /// It is one of those that agree.
    Used,
    /// It contradicts them.
    Outlier,
    /// It is of a place that is not the apple's any more, or never was.
    Stale,
}

/// One apple as one frame shows it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[cfg_attr(test, schemars(deny_unknown_fields))]
pub struct SightingRecord {
    /// Index of the frame.
    pub frame: usize,
    /// The pick there.
    pub pick: usize,
    /// The pick's status.
    #[cfg_attr(test, schemars(with = "String"))]
    pub status: pomona::Status,
    /// What became of that place.
    pub place: PlaceUse,
    /// Distance of that centre, the common shift taken off, from the fused one; of a moved apple from that of its place then.
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub residual: f64,
    /// What became of its direction.
    pub direction: DirectionUse,
    /// Angle of its direction to the fused one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[cfg_attr(test, schemars(range(min = 0.0)))]
    pub direction_off: Option<f64>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_schema_in_the_docs_is_that_of_the_types() {
        pomona_schema::assert_in_docs::<FusedRecord>(FUSED_SCHEMA, "fused.schema.json");
    }
}
