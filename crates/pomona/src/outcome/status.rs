use serde::{Deserialize, Serialize};

/// What became of an apple.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Status {
    /// It has a direction.
    Picked,
    /// Depth says that its box, a detector's, holds no apple; the box's mark says why.
    Implausible,
    /// Its box holds no depth reading.
    NoDepth,
    /// Its box holds fewer readings than make an apple.
    TooFewPoints,
    /// No sphere within the radius bounds has enough support.
    NoSphere,
    /// The least-squares sphere of the best support leaves the radius bounds.
    ImplausibleRadius,
    /// What was fitted is more probably no apple than one.
    NoApple,
    /// No line at an allowed distance has enough support.
    NoBranch,
    /// Several branches in different directions are as likely as each other.
    AmbiguousBranch,
    /// What is most like a branch has the width and the ends of leaves.
    LeafLike,
    /// Things in front hide too much of the apple or of what may be its branch.
    Occluded,
}

impl Status {
    /// Its name in `picks.json`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Picked => "picked",
            Self::Implausible => "implausible",
            Self::NoDepth => "no_depth",
            Self::TooFewPoints => "too_few_points",
            Self::NoSphere => "no_sphere",
            Self::ImplausibleRadius => "implausible_radius",
            Self::NoApple => "no_apple",
            Self::NoBranch => "no_branch",
            Self::AmbiguousBranch => "ambiguous_branch",
            Self::LeafLike => "leaf_like",
            Self::Occluded => "occluded",
        }
    }
}
