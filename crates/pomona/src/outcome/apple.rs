use super::confidence::CONFIDENCE_FEATURES;
use super::direction::{FallbackDirection, PickDirection};
use super::fitted::{BranchCandidate, FittedApple, FittedBranch};
use super::plan::ApplePlan;
use super::presence::PRESENCE_FEATURES;
use super::robot::RobotTarget;
use super::status::Status;
use super::wood::WOOD_FEATURES;
use crate::detection::BoxOrigin;
use pomona_cloud::PixelBox;
use pomona_transforms::{CameraFrame, Direction, Position};
use std::time::Duration;

/// The answer for one box. What is not known is `None`.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct AppleAnswer {
    /// Number of the box, from 0.
    pub id: usize,
    /// The box, in pixels of the colour image.
    pub bounds: PixelBox,
    /// How a detector's box was found and what depth says about it; `None` for a box that came with the frame.
    pub origin: Option<BoxOrigin>,
    /// What became of the apple.
    pub status: Status,
    /// The fitted apple.
    pub apple: Option<FittedApple>,
    /// The line of the nearest branch.
    pub branch: Option<FittedBranch>,
    /// The direction of approach: present exactly where the status is [`Status::Picked`].
    pub pick: Option<PickDirection>,
    /// Probability that the box holds an apple, where the method states one.
    pub presence: Option<f64>,
    /// Probability that the direction is at most 20 degrees off, where the method states one.
    pub confidence: Option<f64>,
    /// The branches that were weighed against each other, the best first.
    pub candidates: Vec<BranchCandidate>,
    /// For a refusal: from the apple's centre towards where a camera would see it past what hides it now.
    pub view_from: Option<Direction<CameraFrame>>,
    /// For a refusal, where the settings ask for it: a direction that is not derived from a branch.
    pub fallback: Option<FallbackDirection>,
    /// Centre and direction in the robot's frame, where a transform was given.
    pub robot: Option<RobotTarget>,
    /// How a robot gets there, where one was configured.
    pub plan: Option<ApplePlan>,
    /// The pixels that support the answer.
    pub evidence: Evidence,
    /// How long it took.
    pub times: StageTimes,
}

impl AppleAnswer {
    /// An answer of which nothing but the status is known.
    pub fn new(id: usize, bounds: PixelBox, status: Status) -> Self {
        Self {
            id,
            bounds,
            origin: None,
            status,
            apple: None,
            branch: None,
            pick: None,
            presence: None,
            confidence: None,
            candidates: Vec::new(),
            view_from: None,
            fallback: None,
            robot: None,
            plan: None,
            evidence: Evidence::default(),
            times: StageTimes::default(),
        }
    }

    /// Whether it has a direction.
    pub fn is_picked(&self) -> bool {
        self.status == Status::Picked
    }
}

/// What supports one answer: pixels of the depth image as `v * width + u`, for pictures.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Evidence {
    /// Pixels on the apple's surface.
    pub surface: Vec<u32>,
    /// Pixels on its branch.
    pub branch: Vec<u32>,
    /// What the confidence of `robust` is computed from, in the order of
    /// [`CONFIDENCE_FEATURES`](crate::CONFIDENCE_FEATURES); absent where there is no candidate.
    pub confidence_features: Option<[f64; CONFIDENCE_FEATURES.len()]>,
    /// What the presence of an apple is computed from by `robust`, in the order of
    /// [`PRESENCE_FEATURES`](crate::PRESENCE_FEATURES); absent where no spheroid was fitted, and where boxes are not
    /// checked.
    pub presence_features: Option<[f64; PRESENCE_FEATURES.len()]>,
    /// What `robust` weighs each of the branches by that it found in depth; one branch may be there several times.
    pub weighed: Vec<Weighed>,
}

/// A branch found in depth, and what the probability that it is wood is computed from.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Weighed {
    /// Point of its axis nearest to the apple's centre.
    pub foot: Position<CameraFrame>,
    /// In the order of [`WOOD_FEATURES`](crate::WOOD_FEATURES).
    pub features: [f64; WOOD_FEATURES.len()],
}

impl Weighed {
    pub(crate) fn new(foot: Position<CameraFrame>, features: &[f64; WOOD_FEATURES.len()]) -> Self {
        Self {
            foot,
            features: *features,
        }
    }
}

/// The time that each stage of one apple took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct StageTimes {
    /// Cutting the box out of the depth image.
    pub crop: Duration,
    /// Fitting the sphere.
    pub sphere: Duration,
    /// Collecting the shell and fitting the branch.
    pub branch: Duration,
    /// All of it.
    pub total: Duration,
}
