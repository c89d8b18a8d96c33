use nalgebra::{Isometry3, Point3, Vector3};
use pomona_transforms::{Direction, RobotFrame};

/// An apple to be picked, and the directions in which it may be approached.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Target {
    /// Number of the apple in the scene.
    pub apple: usize,
    /// Directions OC in the order in which to try them, in the base's frame.
    pub directions: Vec<Direction<RobotFrame>>,
    /// The half-angle about each direction within which a tilted approach is as good, in radians;
    /// 0 for none. Used up to the configured largest tilt.
    pub direction_uncertainty_rad: f64,
    /// The branch's direction in the base's frame, either sign, for rolls that align to it.
    pub branch: Option<Vector3<f64>>,
    /// How sure the direction is, 0 to 1.
    pub confidence: f64,
}

impl Target {
    /// The apple with this number of the scene, to be approached along `direction`, with full
    /// confidence, no uncertainty and an unknown branch.
    pub fn new(apple: usize, direction: Direction<RobotFrame>) -> Self {
        Self {
            apple,
            directions: vec![direction],
            direction_uncertainty_rad: 0.0,
            branch: None,
            confidence: 1.0,
        }
    }
}

/// Where the tool is before the path begins: the pose of the tool frame in the base's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StartPose(pub Isometry3<f64>);

impl StartPose {
    /// At `point`, with the tool's axes those of the base.
    pub fn looking_along_x(point: Point3<f64>) -> Self {
        Self(Isometry3::translation(point.x, point.y, point.z))
    }

    pub(crate) fn is_finite(&self) -> bool {
        let rotation = self.0.rotation.coords;
        self.0.translation.vector.iter().all(|c| c.is_finite())
            && rotation.iter().all(|c| c.is_finite())
    }
}
