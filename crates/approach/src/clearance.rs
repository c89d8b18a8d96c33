/// An obstacle in the way of the gripper.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Obstacle {
    /// An apple, its sphere or the points of the cloud on it, by its number in the scene; also the
    /// target itself, before the gripper encloses it.
    Apple(usize),
    /// A branch, by its number in the scene.
    Branch(usize),
    /// Points of the cloud that no apple and no branch explains: leaves, trunks, wires.
    Cloud,
}

/// A part of the path.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Stage {
    /// From the start to the pre-grasp.
    Transit,
    /// Straight from the pre-grasp to the apple.
    Approach,
    /// Straight back, with the apple.
    Retreat,
}

impl Stage {
    /// Its name in records.
    pub fn name(self) -> &'static str {
        match self {
            Self::Transit => "transit",
            Self::Approach => "approach",
            Self::Retreat => "retreat",
        }
    }
}

/// Smallest distance of the gripper, or of the apple in it, from an obstacle; metres and seconds.
///
/// It is that of the obstacle with the least slack: distance less margin.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Clearance {
    /// Signed distance of the surfaces, negative where they overlap.
    ///
    /// Of a path that is free it is a lower bound: too small by no more than the configured resolution
    /// or 0.3 of what is left beyond the margin. Where nothing comes within the configured cutoff, it
    /// is 0.7 of the cutoff, less the depth to which the cloud may be entered.
    pub distance_m: f64,
    /// The distance required from this obstacle.
    pub margin_m: f64,
    /// The obstacle; `None` where nothing comes within the cutoff.
    pub obstacle: Option<Obstacle>,
    /// The obstacle's point (on its axis, at its centre, or in the cloud) that is nearest, in the
    /// base's frame; for no obstacle, where the tool is then.
    pub point_m: [f64; 3],
    /// Time since the start of the path.
    pub time_s: f64,
    /// The stage at that time.
    pub stage: Stage,
}

impl Clearance {
    /// What is left of the distance beyond the margin, in metres; negative for a collision.
    pub fn slack_m(&self) -> f64 {
        self.distance_m - self.margin_m
    }
}
