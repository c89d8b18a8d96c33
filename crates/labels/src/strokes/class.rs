use serde::Serialize;

/// What a stroke lies on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum StrokeClass {
    /// Trunk, limb, branch, twig or spur.
    Wood,
    /// Wood of a tree behind: it need not be found, and is not wrong where it is.
    Far,
    /// The stalk of a fruit.
    Peduncle,
    /// Whatever is man-made and long.
    Post,
}

impl StrokeClass {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Wood, Self::Far, Self::Peduncle, Self::Post];

    /// Its name in a file of strokes.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Wood => "wood",
            Self::Far => "far",
            Self::Peduncle => "peduncle",
            Self::Post => "post",
        }
    }
}
