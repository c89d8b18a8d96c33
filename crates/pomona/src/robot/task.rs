use crate::outcome::{AppleAnswer, BranchCandidate, FittedApple, RobotFromCamera};
use nalgebra::Isometry3;
use pomona_approach::{ApproachConfig, Target};
use pomona_cloud::DepthPoints;
use pomona_geometry::{Capsule, Segment, Sphere};
use pomona_transforms::{CameraFrame, Direction};

/// What a planner is asked about a frame, each part with the ids of the answers it comes from.
#[derive(Default)]
pub(super) struct Task {
    pub(super) apples: Vec<Sphere>,
    pub(super) apple_ids: Vec<usize>,
    pub(super) branches: Vec<Capsule>,
    pub(super) branch_ids: Vec<usize>,
    pub(super) targets: Vec<Target>,
    pub(super) target_ids: Vec<usize>,
}

impl Task {
    /// Adds the branch of an answer, as far as its supporting pixels see it.
    pub(super) fn add_branch(
        &mut self,
        answer: &AppleAnswer,
        points: &DepthPoints,
        robot_from_camera: &RobotFromCamera,
        config: &ApproachConfig,
    ) {
        let fitted = answer.candidates.first().map(|best| best.radius_m);
        let radius = fitted.unwrap_or(config.clearance.branch_radius_m);
        if let Some(branch) = seen_branch(answer, points, radius) {
            let to_robot = robot_from_camera.transform.isometry();
            self.branches.push(moved(&branch, &to_robot));
            self.branch_ids.push(answer.id);
        }
    }

    /// Adds a fitted apple as an obstacle and, where it has a direction, as a target.
    pub(super) fn add_apple(
        &mut self,
        answer: &AppleAnswer,
        robot_from_camera: &RobotFromCamera,
        config: &ApproachConfig,
    ) {
        let Some(apple) = &answer.apple else { return };
        let transform = &robot_from_camera.transform;
        let number = self.apples.len();
        self.apples.push(Sphere {
            center: transform.position(&apple.center).point(),
            radius: apple.radius_m,
        });
        self.apple_ids.push(answer.id);
        let Some(pick) = &answer.pick else { return };
        let mut target = Target::new(number, transform.direction(&pick.direction));
        let others = rival_directions(answer, apple).map(|d| transform.direction(&d));
        target.directions.extend(others);
        target.direction_uncertainty_rad = pick
            .sd_rad
            .unwrap_or(config.search.direction_uncertainty_rad);
        target.confidence = answer.confidence.unwrap_or(1.0);
        let branch = answer.branch.as_ref();
        target.branch = branch.map(|b| transform.direction(&b.direction).vector());
        self.targets.push(target);
        self.target_ids.push(answer.id);
    }
}

/// The directions to the other candidates that are nearly as good as the best, and elsewhere.
fn rival_directions(
    answer: &AppleAnswer,
    apple: &FittedApple,
) -> impl Iterator<Item = Direction<CameraFrame>> {
    /// By how much less than the best a candidate may score.
    const SCORE_MARGIN: f64 = 0.3;
    /// Least angle between a rival's direction and that of the best, radians.
    const LEAST_ANGLE_RAD: f64 = 0.2;
    let towards = |candidate: &BranchCandidate| apple.center.direction_to(&candidate.foot);
    let best = answer.candidates.first();
    let best = best.and_then(|best| Some((best.score, towards(best)?)));
    let rivals = answer.candidates.iter().skip(1);
    rivals.filter_map(move |rival| {
        let (score, direction) = best?;
        let towards = towards(rival)?;
        let apart = towards.angle_to(&direction) > LEAST_ANGLE_RAD;
        (rival.score >= score - SCORE_MARGIN && apart).then_some(towards)
    })
}

/// The branch as far as its supporting pixels see it, in the camera's frame.
fn seen_branch(answer: &AppleAnswer, points: &DepthPoints, radius: f64) -> Option<Capsule> {
    let branch = answer.branch.as_ref()?;
    let (point, along) = (branch.point.point(), branch.direction.vector());
    // The points of a whole image stand in the order of their pixels.
    let pixels = &answer.evidence.branch;
    let (low, high) = pixels
        .iter()
        .filter_map(|pixel| points.pixel.binary_search(pixel).ok())
        .map(|i| (points.point(i) - point).dot(&along))
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), t| {
            (low.min(t), high.max(t))
        });
    if low > high {
        return None;
    }
    Capsule::new(
        Segment::new(point + along * low, point + along * high)?,
        radius,
    )
}

fn moved(capsule: &Capsule, pose: &Isometry3<f64>) -> Capsule {
    let Segment { start, end } = capsule.segment;
    Capsule {
        segment: Segment {
            start: pose * start,
            end: pose * end,
        },
        ..*capsule
    }
}
