use crate::{DetectionRecord, DetectionTiming, DirectionSource, FoundRecord, PlanRecord};
use pomona_cloud::PixelBox;
use serde::{Deserialize, Serialize};

/// Name and version of the form of [`Record`].
pub const SCHEMA: &str = "pomona.picks/1";

/// What `picks.json` holds: the answer for each box of one frame. Metres and radians.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// [`SCHEMA`].
    pub schema: String,
    /// Name of the method.
    pub method: String,
    /// Seed of the run.
    pub seed: u64,
    /// The frame.
    pub frame: FrameRecord,
    /// What found the boxes; absent where they came with the frame or in a file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub detection: Option<DetectionRecord>,
    /// One entry for each box, in the boxes' order.
    pub picks: Vec<Pick>,
}

/// Which frame.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct FrameRecord {
    /// Its id: the name of its folder.
    pub id: String,
    /// The coordinate frame that positions and directions are given in: the camera's.
    pub frame_id: String,
}

/// What became of an apple.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
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
            Self::NoBranch => "no_branch",
            Self::AmbiguousBranch => "ambiguous_branch",
            Self::LeafLike => "leaf_like",
            Self::Occluded => "occluded",
        }
    }
}

/// The answer for one box; what is not known is absent.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pick {
    /// Number of the box, from 0.
    pub id: usize,
    /// The box.
    #[serde(rename = "box")]
    pub pixel_box: BoxRecord,
    /// What became of it.
    pub status: Status,
    /// The apple's sphere.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub apple: Option<AppleRecord>,
    /// The line of the nearest branch.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub branch: Option<BranchRecord>,
    /// Foot of the perpendicular from the centre on the branch: the paper's C.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub foot: Option<[f64; 3]>,
    /// Unit vector from the centre to the foot: the direction of approach.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub direction: Option<[f64; 3]>,
    /// Standard deviation of the direction as an angle, radians.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub direction_sd: Option<f64>,
    /// Probability that the direction is at most 20 degrees off.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub confidence: Option<f64>,
    /// Branches that were weighed against each other, the best first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub candidates: Vec<CandidateRecord>,
    /// For a refusal: unit vector from the apple's centre towards where a camera would see it past what hides it now.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub view_from: Option<[f64; 3]>,
    /// For a refusal, where the settings ask for it: a way to come in that is no branch's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fallback: Option<FallbackRecord>,
    /// Position and direction in the robot's frame, where a transform was given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub robot: Option<RobotRecord>,
    /// How a robot gets there, where one was configured: `gripper`, `approach`, `clearance`, `order`.
    #[serde(flatten)]
    pub plan: PlanRecord,
    /// How long it took.
    pub timing_ms: TimingRecord,
}

/// A box of the colour image, in pixels.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BoxRecord {
    /// Name in the box file.
    pub name: String,
    /// Left edge.
    pub x_min: f64,
    /// Top edge.
    pub y_min: f64,
    /// Right edge.
    pub x_max: f64,
    /// Bottom edge.
    pub y_max: f64,
    /// Detection score, 0 to 1.
    pub score: f64,
    /// How it was found and what depth says about it: `found_by`, `mark`, `merged`; absent for a box of a file.
    #[serde(flatten)]
    pub found: Option<FoundRecord>,
}

impl From<&PixelBox> for BoxRecord {
    fn from(b: &PixelBox) -> Self {
        let PixelBox {
            name,
            x_min,
            y_min,
            x_max,
            y_max,
            score,
        } = b.clone();
        Self {
            name,
            x_min,
            y_min,
            x_max,
            y_max,
            score,
            found: None,
        }
    }
}

/// A fitted apple.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AppleRecord {
    /// Centre: the paper's O.
    pub center: [f64; 3],
    /// Radius.
    pub radius: f64,
    /// Points of the box that lie on the surface.
    pub inliers: usize,
    /// Root mean square of their distances from it.
    pub rms: f64,
    /// Covariance of the centre, square metres.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub center_covariance: Option<[[f64; 3]; 3]>,
    /// Standard deviation of the radius.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub radius_sd: Option<f64>,
    /// Share of its outline's area on which its surface shows.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub visible_share: Option<f64>,
    /// How well the body agrees with points, outline and box; 1 is perfect.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub agreement: Option<f64>,
}

/// A fitted branch.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BranchRecord {
    /// A point on the line.
    pub point: [f64; 3],
    /// Its unit direction; the opposite one is the same line.
    pub direction: [f64; 3],
    /// Points that lie on it.
    pub inliers: usize,
    /// Root mean square of their distances from it.
    pub rms: f64,
}

/// A branch that was weighed against others. Metres; lengths are measured along the branch.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CandidateRecord {
    /// Point of its axis nearest to the apple's centre.
    pub foot: [f64; 3],
    /// Unit tangent of its axis there.
    pub tangent: [f64; 3],
    /// Radius of the branch.
    pub radius: f64,
    /// Distance of the foot from the centre.
    pub distance: f64,
    /// What it is ranked by; larger is better.
    pub score: f64,
    /// Length that shows with the branch's own width.
    pub shown: f64,
    /// Of that, what lies on the side of the foot that shows less.
    pub shown_lesser_side: f64,
    /// Length at which something else of its depth shows.
    pub odd: f64,
    /// Length at which the camera looks past or through it.
    pub empty: f64,
    /// Length that something nearer hides.
    pub hidden: f64,
}

/// A direction of approach for an apple whose branch is not known: a guess from its surroundings, no answer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FallbackRecord {
    /// Direction of approach, a unit vector.
    pub direction: [f64; 3],
    /// Where it comes from.
    pub direction_source: DirectionSource,
    /// The same in the robot's frame, where a transform was given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub robot: Option<RobotRecord>,
}

/// An answer in the robot's frame, with the orientation of a tool that approaches along its +x axis.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RobotRecord {
    /// Name of the robot's frame.
    pub frame_id: String,
    /// The apple's centre.
    pub center: [f64; 3],
    /// Direction of approach, a unit vector.
    pub direction: [f64; 3],
    /// Orientation of the tool, x y z w with w ≥ 0.
    pub quaternion_xyzw: [f64; 4],
    /// The same as angles about x, y, z, applied in the order Z–Y–X (Eq. 11 of the paper); x is 0.
    pub euler_zyx: [f64; 3],
    /// Whether the direction lies along ±z, where the angle about z is not determined and set to 0.
    pub singular: bool,
}

/// Milliseconds of each stage.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct TimingRecord {
    /// Cutting the box out of the depth image.
    pub crop: f64,
    /// Fitting the sphere.
    pub sphere: f64,
    /// Collecting the shell and fitting the branch.
    pub branch: f64,
    /// All of it.
    pub total: f64,
}

impl Record {
    /// The record with all timings set to 0: what is left is the same for the same
    /// input, seed and build.
    #[must_use]
    pub fn without_timing(mut self) -> Self {
        for pick in &mut self.picks {
            pick.timing_ms = TimingRecord::default();
        }
        if let Some(detection) = &mut self.detection {
            detection.timing_ms = DetectionTiming {
                depth_search: detection.timing_ms.depth_search.map(|_| 0.0),
                ..DetectionTiming::default()
            };
        }
        self
    }
}
