use serde::{Deserialize, Serialize};

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
