use serde::{Deserialize, Serialize};

/// Settings of what is given in place of a direction that is refused.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct FallbackConfig {
    /// `none`, `surface_normal` or `away_from_obstacle`. Default none. Others give refused apples with a sphere
    /// a way to come in, labelled as such; the apple stays refused.
    pub kind: FallbackKind,
}

/// What is given in place of a direction that is refused.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum FallbackKind {
    /// Nothing.
    #[default]
    None,
    /// Against the mean normal of the visible cap: from the side that shows, into the apple.
    SurfaceNormal,
    /// From the side that faces away from the nearest obstacle, towards it; where nothing is near, as `SurfaceNormal`.
    AwayFromObstacle,
}

/// Where a direction that is no branch's comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum DirectionSource {
    /// The mean normal of the visible cap.
    SurfaceNormal,
    /// The nearest obstacle.
    AwayFromObstacle,
}

impl DirectionSource {
    /// Its name in `picks.json`.
    pub fn name(self) -> &'static str {
        match self {
            Self::SurfaceNormal => "surface_normal",
            Self::AwayFromObstacle => "away_from_obstacle",
        }
    }
}
