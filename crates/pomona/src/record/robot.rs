use crate::outcome::{DirectionSource, FallbackDirection, RobotTarget};
use serde::{Deserialize, Serialize};

/// A direction of approach for an apple whose branch is not known: a guess from its surroundings, no answer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[cfg_attr(test, schemars(deny_unknown_fields))]
#[non_exhaustive]
pub struct FallbackRecord {
    /// Direction of approach, a unit vector.
    #[cfg_attr(test, schemars(with = "pomona_schema::UnitVector"))]
    pub direction: [f64; 3],
    /// Where it comes from.
    pub direction_source: DirectionSource,
    /// The same in the robot's frame, where a transform was given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub robot: Option<RobotRecord>,
}

/// An answer in the robot's frame, with the orientation of a tool that approaches along its +x axis.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[cfg_attr(test, schemars(deny_unknown_fields))]
#[non_exhaustive]
pub struct RobotRecord {
    /// Name of the robot's frame.
    pub frame_id: String,
    /// The apple's centre.
    pub center: [f64; 3],
    /// Direction of approach, a unit vector.
    #[cfg_attr(test, schemars(with = "pomona_schema::UnitVector"))]
    pub direction: [f64; 3],
    /// Orientation of the tool, x y z w with w ≥ 0.
    #[cfg_attr(test, schemars(with = "pomona_schema::UnitQuaternion"))]
    pub quaternion_xyzw: [f64; 4],
    /// The same as angles about x, y, z, applied in the order Z–Y–X (Eq. 11 of the paper); x is 0.
    pub euler_zyx: [f64; 3],
    /// Whether the direction lies along ±z, where the angle about z is not determined and set to 0.
    pub singular: bool,
}

impl From<&FallbackDirection> for FallbackRecord {
    fn from(fallback: &FallbackDirection) -> Self {
        Self {
            direction: fallback.direction.vector().into(),
            direction_source: fallback.source,
            robot: fallback.robot.as_ref().map(RobotRecord::from),
        }
    }
}

impl From<&RobotTarget> for RobotRecord {
    fn from(target: &RobotTarget) -> Self {
        let euler = &target.tool.euler;
        Self {
            frame_id: target.frame_id.clone(),
            center: target.center.point().into(),
            direction: target.direction.vector().into(),
            quaternion_xyzw: target.tool.quaternion_xyzw(),
            euler_zyx: [euler.rx, euler.ry, euler.rz],
            singular: target.tool.singular,
        }
    }
}
