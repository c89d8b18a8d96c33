use crate::{Clearance, Stage};
use thiserror::Error;

/// Which limit of the arm a place lies beyond.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReachLimit {
    /// Too near to the shoulder.
    ShellInner,
    /// Too far from the shoulder.
    ShellOuter,
    /// Outside the box.
    Box,
}

impl ReachLimit {
    /// Its name in records.
    pub fn name(self) -> &'static str {
        match self {
            Self::ShellInner => "shell_inner",
            Self::ShellOuter => "shell_outer",
            Self::Box => "box",
        }
    }
}

/// Why an apple is not approached. Lengths in metres, angles in radians.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum Refusal {
    /// The direction comes back towards the base: the gripper would have to reach around the apple.
    #[error(
        "the approach makes {angle_rad:.2} rad with the ray from the base, more than {limit_rad:.2}"
    )]
    UnreachableFromBehind {
        /// Angle between the approach and the ray from the shoulder to the apple.
        angle_rad: f64,
        /// The largest that is allowed.
        limit_rad: f64,
    },
    /// A place of the path lies beyond the arm's limits.
    #[error("the path leaves the arm's reach ({}) at {point_m:?}", limit.name())]
    OutOfReach {
        /// The limit.
        limit: ReachLimit,
        /// The first place found beyond it, in the base's frame.
        point_m: [f64; 3],
    },
    /// The gripper would come closer to an obstacle than its margin allows.
    #[error("the gripper comes within {:.4} m of something at {:?}", .0.distance_m, .0.point_m)]
    Collision(Clearance),
    /// The apple does not fit between the fingers, or not before the palm.
    #[error(
        "the apple needs an opening of {needed_width_m:.3} m and a depth of {needed_depth_m:.3} m"
    )]
    GripperTooSmall {
        /// Opening that the apple needs, margins included.
        needed_width_m: f64,
        /// Opening of the gripper.
        width_m: f64,
        /// Depth from the apple's centre to the palm that it needs, margin included.
        needed_depth_m: f64,
        /// Depth of the gripper.
        depth_m: f64,
    },
    /// The scene has no such apple, or the target no direction.
    #[error("there is no apple {apple} with a direction among the scene's {apples}")]
    NoTarget {
        /// Number of the apple asked for.
        apple: usize,
        /// How many the scene has.
        apples: usize,
    },
    /// The start is not finite.
    #[error("the start pose is not finite")]
    NoStart,
}

impl Refusal {
    /// Whether another transit may avoid it.
    pub(crate) fn is_of_the_transit(&self) -> bool {
        match self {
            Self::Collision(clearance) => clearance.stage == Stage::Transit,
            Self::OutOfReach { .. } => true,
            _ => false,
        }
    }

    /// Its name in `picks.json`.
    pub fn name(&self) -> &'static str {
        match self {
            Self::UnreachableFromBehind { .. } => "unreachable_from_behind",
            Self::OutOfReach { .. } => "out_of_reach",
            Self::Collision(_) => "collision",
            Self::GripperTooSmall { .. } => "gripper_too_small",
            Self::NoTarget { .. } => "no_target",
            Self::NoStart => "no_start",
        }
    }
}
