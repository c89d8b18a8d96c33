use pomona_geometry::Sphere;
use pomona_transforms::{CameraFrame, Direction, Position, PositionCovariance};

/// A fitted apple.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct FittedApple {
    /// Centre: the paper's O.
    pub center: Position<CameraFrame>,
    /// Radius, metres.
    pub radius_m: f64,
    /// Number of the points of the box that lie on the surface.
    pub inliers: usize,
    /// Root mean square of the distances from the surface, metres.
    pub rms_m: f64,
    /// Covariance of the centre, where the method states one.
    pub center_covariance: Option<PositionCovariance<CameraFrame>>,
    /// Standard deviation of the radius, metres, where the method states one.
    pub radius_sd_m: Option<f64>,
    /// Share of its outline's area on which its surface shows, where the method states it.
    pub visible_share: Option<f64>,
    /// How well the body agrees with points, outline and box, where the method states it; 1 is perfect.
    pub agreement: Option<f64>,
}

impl FittedApple {
    /// A sphere with the number of points that lie on it and their root mean square distance from it.
    pub fn new(center: Position<CameraFrame>, radius_m: f64, inliers: usize, rms_m: f64) -> Self {
        Self {
            center,
            radius_m,
            inliers,
            rms_m,
            center_covariance: None,
            radius_sd_m: None,
            visible_share: None,
            agreement: None,
        }
    }

    /// Its sphere, in the camera's frame.
    pub fn sphere(&self) -> Sphere {
        Sphere {
            center: self.center.point(),
            radius: self.radius_m,
        }
    }
}

/// The fitted line of a branch.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct FittedBranch {
    /// A point on the line.
    pub point: Position<CameraFrame>,
    /// Its direction; the opposite one is the same line.
    pub direction: Direction<CameraFrame>,
    /// Number of the points that lie on it.
    pub inliers: usize,
    /// Root mean square of their distances from it, metres.
    pub rms_m: f64,
}

impl FittedBranch {
    /// The line through `point` along `direction`, with the number of points that lie on it and their root mean
    /// square distance from it.
    pub fn new(
        point: Position<CameraFrame>,
        direction: Direction<CameraFrame>,
        inliers: usize,
        rms_m: f64,
    ) -> Self {
        Self {
            point,
            direction,
            inliers,
            rms_m,
        }
    }
}

/// A branch that was weighed against others. Lengths in metres, measured along the branch.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct BranchCandidate {
    /// Point of its axis nearest to the apple's centre.
    pub foot: Position<CameraFrame>,
    /// Tangent of its axis there.
    pub tangent: Direction<CameraFrame>,
    /// Radius of the branch.
    pub radius_m: f64,
    /// Distance of the foot from the centre.
    pub distance_m: f64,
    /// What candidates are ranked by; larger is better.
    pub score: f64,
    /// Length on which it shows with its own width.
    pub shown_m: f64,
    /// Of that, the part on the side of the foot that shows less.
    pub shown_lesser_side_m: f64,
    /// Length on which something else of its depth shows.
    pub odd_m: f64,
    /// Length on which the camera looks past or through it.
    pub empty_m: f64,
    /// Length that something nearer hides.
    pub hidden_m: f64,
    /// Probability that it is wood, where the colour image tells; the score is then the probability that it is the
    /// nearest wood.
    pub wood: Option<f64>,
    /// By how much it stands out as wood from what lies beside it, −1 to 1, where the colour image tells.
    pub contrast: Option<f64>,
}

impl BranchCandidate {
    /// A candidate with this foot, of which nothing has been measured along its axis.
    pub fn new(
        foot: Position<CameraFrame>,
        tangent: Direction<CameraFrame>,
        radius_m: f64,
        distance_m: f64,
        score: f64,
    ) -> Self {
        Self {
            foot,
            tangent,
            radius_m,
            distance_m,
            score,
            shown_m: 0.0,
            shown_lesser_side_m: 0.0,
            odd_m: 0.0,
            empty_m: 0.0,
            hidden_m: 0.0,
            wood: None,
            contrast: None,
        }
    }
}
