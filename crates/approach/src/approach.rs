use crate::{Clearance, Path};
use nalgebra::Isometry3;
use pomona_transforms::{Direction, RobotFrame};

/// How a gripper picks one apple. Metres, radians, in the base's frame.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Approach {
    /// Number of the apple in the scene.
    pub apple: usize,
    /// The direction of approach: that of the target, tilted.
    pub direction: Direction<RobotFrame>,
    /// Which of the target's directions it comes from.
    pub candidate: usize,
    /// Angle between the two.
    pub tilt_rad: f64,
    /// Turn about the direction, from the orientation with RX = 0.
    pub roll_rad: f64,
    /// Pose of the tool frame at the apple.
    pub grasp: Isometry3<f64>,
    /// The same before the straight approach.
    pub pre_grasp: Isometry3<f64>,
    /// The same after the retreat.
    pub retreat: Isometry3<f64>,
    /// From pre-grasp to grasp.
    pub standoff_m: f64,
    /// From the start to the pre-grasp, to the apple and back.
    pub path: Path,
    /// What it comes nearest to.
    pub clearance: Clearance,
    /// How many approaches were tried, this one included.
    pub tried: usize,
}
