use pomona::{AppleAnswer, FrameAnswer, Gripper, RobotFromCamera, Status};
use pomona_cloud::{ColorImage, Frame};
use pomona_geometry::{Capsule, Segment};
use pomona_view::{AppleMark, Overlay, ViewError};

/// More boxes than these leave no room for the reasons of refusals: those stand by their numbers in the table.
const CROWDED: usize = 60;

/// Brings what a robot plans back into the picture.
pub(crate) struct RobotView<'a> {
    pub(crate) robot_from_camera: &'a RobotFromCamera,
    pub(crate) gripper: &'a Gripper,
}

/// The frame's colour image with its answers drawn over it.
pub(crate) fn draw(
    frame: &Frame,
    answer: &FrameAnswer,
    robot: Option<&RobotView<'_>>,
) -> Result<ColorImage, ViewError> {
    let crowded = answer.apples.len() > CROWDED;
    let marks: Vec<AppleMark> = answer
        .apples
        .iter()
        .map(|apple| {
            let mut mark = mark(apple, robot);
            if crowded && mark.refused.is_some() {
                mark.caption = None;
                mark.refused = Some(String::new());
            }
            mark
        })
        .collect();
    Overlay::new(&frame.color, &frame.camera).draw(&marks)
}

fn mark<'a>(answer: &'a AppleAnswer, robot: Option<&RobotView<'_>>) -> AppleMark<'a> {
    let mut mark = AppleMark::new(answer.id, answer.bounds.clone());
    mark.surface_pixels = &answer.evidence.surface;
    mark.branch_pixels = &answer.evidence.branch;
    if let Some(apple) = &answer.apple {
        let center = apple.center.point();
        mark.sphere = Some(apple.sphere());
        mark.arrow = answer.pick.map(|pick| (center, pick.foot.point()));
        mark.caption = Some(format!("r {:.0} mm", apple.radius_m * 1000.0));
    }
    if !answer.is_picked() {
        // Depth's own word says more than that it refuses.
        let word = match answer.origin {
            Some(origin) if answer.status == Status::Implausible => origin.mark.name(),
            _ => answer.status.name(),
        };
        mark.refused = Some(word.replace('_', " "));
    }
    if let Some(robot) = robot {
        robot.add(answer, &mut mark);
    }
    mark
}

impl RobotView<'_> {
    /// The path's samples, the gripper at the apple, the rank in the order; the reason where there is none.
    fn add(&self, answer: &AppleAnswer, mark: &mut AppleMark<'_>) {
        let Some(plan) = &answer.plan else { return };
        let camera_from_robot = self.robot_from_camera.transform.inverse().isometry();
        if let Ok(planned) = &plan.approach {
            let samples = planned.samples.iter();
            mark.path = samples.map(|s| camera_from_robot * s.position).collect();
            let pose = camera_from_robot * planned.approach.grasp;
            let volumes = self.gripper.capsules();
            let volumes = volumes.iter().filter_map(|(start, end, radius)| {
                Capsule::new(Segment::new(pose * start, pose * end)?, *radius)
            });
            mark.gripper = volumes.collect();
        }
        let turn = match &plan.turn {
            Some(turn) => format!("turn {}", turn.rank + 1),
            None => plan.status().replace('_', " "),
        };
        mark.caption = Some(match mark.caption.take() {
            Some(caption) => format!("{caption}, {turn}"),
            None => turn,
        });
    }
}
