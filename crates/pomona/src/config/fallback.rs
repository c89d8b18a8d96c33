use pomona_settings::{choices, settings};

settings! {
    /// Settings of the fallback direction.
    pub struct FallbackConfig {
        /// What a refused apple with a sphere gets beside its refusal: a direction that is not derived from a branch,
        /// labelled as such. The apple stays refused.
        kind: FallbackKind = FallbackKind::AwayFromObstacle, "name", any();
    }
}

choices! {
    /// What is given in place of a direction that is refused.
    pub enum FallbackKind {
        /// Nothing.
        None = "none",
        /// Against the mean normal of the visible cap: from the visible side into the apple.
        SurfaceNormal = "surface_normal",
        /// From the side that faces away from the nearest obstacle, towards it; where nothing is near, as
        /// `surface_normal`.
        AwayFromObstacle = "away_from_obstacle",
    }
}
