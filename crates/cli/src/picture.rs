use nalgebra::{Isometry3, Point3, Quaternion, Translation3, UnitQuaternion};
use pomona::{Evidence, Gripper, Outcome, Pick, RobotFromCamera, Status};
use pomona_cloud::{ColorImage, Frame, PixelBox};
use pomona_geometry::{Capsule, Segment, Sphere};
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
    outcome: &Outcome,
    robot: Option<&RobotView<'_>>,
) -> Result<ColorImage, ViewError> {
    let picks = outcome.record.picks.iter();
    let crowded = picks.len() > CROWDED;
    let marks: Vec<AppleMark> = picks
        .zip(&outcome.evidence)
        .map(|(p, e)| {
            let mut mark = mark(p, e, robot);
            if crowded && mark.refused.is_some() {
                mark.caption = None;
                mark.refused = Some(String::new());
            }
            mark
        })
        .collect();
    Overlay::new(&frame.color, &frame.camera).draw(&marks)
}

fn mark<'a>(pick: &Pick, evidence: &'a Evidence, robot: Option<&RobotView<'_>>) -> AppleMark<'a> {
    let b = &pick.pixel_box;
    let bounds = PixelBox {
        name: b.name.clone(),
        x_min: b.x_min,
        y_min: b.y_min,
        x_max: b.x_max,
        y_max: b.y_max,
        score: b.score,
    };
    let mut mark = AppleMark::new(pick.id, bounds);
    mark.surface_pixels = &evidence.surface;
    mark.branch_pixels = &evidence.branch;
    if let Some(apple) = &pick.apple {
        let center = Point3::from(apple.center);
        mark.sphere = Sphere::new(center, apple.radius);
        mark.arrow = pick.foot.map(|foot| (center, Point3::from(foot)));
        mark.caption = Some(format!("r {:.0} mm", apple.radius * 1000.0));
    }
    if pick.status != Status::Picked {
        // Depth's own word says more than that it refuses.
        let word = match pick.pixel_box.found {
            Some(found) if pick.status == Status::Implausible => found.mark.name(),
            _ => pick.status.name(),
        };
        mark.refused = Some(word.replace('_', " "));
    }
    if let Some(robot) = robot {
        robot.add(pick, &mut mark);
    }
    mark
}

impl RobotView<'_> {
    /// The path's samples, the gripper at the apple, the rank in the order; the reason where there is none.
    fn add(&self, pick: &Pick, mark: &mut AppleMark<'_>) {
        let camera_from_robot = self.robot_from_camera.transform.inverse().isometry();
        let plan = &pick.plan;
        let way = plan.approach.as_ref().and_then(|a| a.way.as_ref());
        if let Some(way) = way {
            let places = way.path.samples.iter().map(|s| Point3::from(s.position));
            mark.path = places.map(|place| camera_from_robot * place).collect();
        }
        if let Some(gripper) = &plan.gripper {
            let [x, y, z, w] = gripper.tool.quaternion_xyzw;
            let rotation = UnitQuaternion::new_normalize(Quaternion::new(w, x, y, z));
            let place = Translation3::from(gripper.tool.position);
            let pose = camera_from_robot * Isometry3::from_parts(place, rotation);
            mark.gripper = self
                .gripper
                .capsules()
                .iter()
                .filter_map(|(start, end, radius)| {
                    Capsule::new(Segment::new(pose * start, pose * end)?, *radius)
                })
                .collect();
        }
        let turn = match (&plan.order, &plan.approach) {
            (Some(order), _) => format!("turn {}", order.rank + 1),
            (None, Some(approach)) => approach.status.replace('_', " "),
            _ => return,
        };
        mark.caption = Some(match mark.caption.take() {
            Some(caption) => format!("{caption}, {turn}"),
            None => turn,
        });
    }
}
