use serde::{Deserialize, Serialize};

/// What depth says about a detector's box.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Mark {
    /// It shows a sphere of an apple's size, or too little to say that there is none.
    Plausible,
    /// Not looked at: the settings leave depth out.
    Unchecked,
    /// It holds too few readings to judge by. The method decides, as for any box.
    NoDepth,
    /// What it shows is farther off than apples are picked.
    TooFar,
    /// What is round in it is smaller than an apple.
    TooSmall,
    /// What is round in it, or the box itself at its depth, is larger than an apple.
    TooLarge,
    /// It shows a flat surface: a leaf, a wall, a picture of an apple.
    Flat,
    /// It shows a surface that bends in one direction only, as branches do, or no surface that holds together.
    NotRound,
    /// The apple that shows in it has a better box.
    OfAnother,
}

impl Mark {
    /// All of them.
    pub const ALL: [Self; 9] = [
        Self::Plausible,
        Self::Unchecked,
        Self::NoDepth,
        Self::TooFar,
        Self::TooSmall,
        Self::TooLarge,
        Self::Flat,
        Self::NotRound,
        Self::OfAnother,
    ];

    /// Its name in `picks.json`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Plausible => "plausible",
            Self::Unchecked => "unchecked",
            Self::NoDepth => "no_depth",
            Self::TooFar => "too_far",
            Self::TooSmall => "too_small",
            Self::TooLarge => "too_large",
            Self::Flat => "flat",
            Self::NotRound => "not_round",
            Self::OfAnother => "of_another",
        }
    }

    /// Whether it says that the box holds no apple to be picked.
    pub fn refuses(self) -> bool {
        !matches!(self, Self::Plausible | Self::Unchecked | Self::NoDepth)
    }
}
