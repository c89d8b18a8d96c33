use crate::swept_volume::SweptVolume;
use nalgebra::{Isometry3, Point3, Vector3};
use pomona_settings::settings;
use pomona_transforms::{Direction, ToolModel, Transform};

settings! {
    /// A gripper with two parallel fingers, a palm and a wrist; lengths in metres.
    ///
    /// In the tool frame (origin between the fingers, +x the approach, y the opening) the fingers' axes
    /// run along x at y = ±(`jaw_width_m` + `finger_thickness_m`) / 2, the palm joins them behind the
    /// fruit, the wrist runs back from the palm. All four are capsules.
    pub struct Gripper {
        /// Room between the open fingers. Wider: larger apples, and more of what stands about them is in the way.
        jaw_width_m: f64 = 0.100, "metres", above(0.0).at_most(1.0);
        /// Diameter of a finger.
        finger_thickness_m: f64 = 0.012, "metres", above(0.0).at_most(1.0);
        /// How far the fingertips go beyond the apple's centre. Farther: a surer hold, nearer to the branch.
        finger_reach_m: f64 = 0.015, "metres", within(0.0, 1.0);
        /// From the apple's centre back to the palm's surface.
        palm_depth_m: f64 = 0.060, "metres", above(0.0).at_most(1.0);
        /// Diameter of the palm's bar.
        palm_thickness_m: f64 = 0.030, "metres", above(0.0).at_most(1.0);
        /// Diameter of the wrist behind the palm.
        wrist_diameter_m: f64 = 0.070, "metres", above(0.0).at_most(1.0);
        /// Length of the wrist behind the palm's surface that is checked. Longer: more of the arm is known to be free.
        wrist_length_m: f64 = 0.150, "metres", within(0.0, 1.0);
        /// Room for error between the apple's surface and each finger and the palm. Less: larger apples, and fingers
        /// that knock against them.
        grip_margin_m: f64 = 0.005, "metres", within(0.0, 1.0);
        /// The axis of the tool's own frame that leads in the approach. Most programs have 0 0 1. The fingers open
        /// along its y, for an axis along y along its x.
        tool_axis: [f64; 3] = [1.0, 0.0, 0.0], "unit vector", unit();
        /// Place of the flange, which robots' programs move, in the tool's own frame, whose origin is where the apple's
        /// centre comes to rest. A flange 0.18 m behind, for an axis of 0 0 1: 0 0 -0.18.
        tcp_from_flange_translation_m: [f64; 3] = [0.0; 3], "metres", norm_at_most(2.0);
        /// Orientation of the flange in the tool's own frame, x y z w.
        tcp_from_flange_quaternion_xyzw: [f64; 4] = [0.0, 0.0, 0.0, 1.0], "unit quaternion", unit();
    }
}

impl Gripper {
    /// The tool as `pomona-transforms` has it; the default one where a setting is such that
    /// [`ApproachConfig::validate`](crate::ApproachConfig::validate) refuses it.
    pub fn tool_model(&self) -> ToolModel {
        let mount = Transform::from_quaternion(
            self.tcp_from_flange_translation_m,
            self.tcp_from_flange_quaternion_xyzw,
        );
        match (mount, Direction::new(Vector3::from(self.tool_axis))) {
            (Ok(tcp_from_flange), Some(axis)) => ToolModel::new(tcp_from_flange, axis),
            _ => ToolModel::default(),
        }
    }

    /// Pose of the flange, the wrist link that robots' programs move, for a pose of the gripper's frame (+x the approach,
    /// y the opening), both in the base's frame.
    pub fn wrist_pose(&self, tool_pose: &Isometry3<f64>) -> Isometry3<f64> {
        self.tool_model().flange_at(tool_pose)
    }

    /// The opening and the depth that an apple of this radius needs, in metres, margins included.
    pub fn needed_for(&self, radius_m: f64) -> (f64, f64) {
        let half = radius_m + self.grip_margin_m;
        (2.0 * half, half)
    }

    fn finger_axis(&self) -> f64 {
        0.5 * (self.jaw_width_m + self.finger_thickness_m)
    }

    fn palm_axis(&self) -> f64 {
        -self.palm_depth_m - 0.5 * self.palm_thickness_m
    }

    /// The ends of a finger's axis along x.
    fn finger_span(&self) -> (f64, f64) {
        let tip = self.finger_reach_m - 0.5 * self.finger_thickness_m;
        (self.palm_axis(), tip.max(self.palm_axis()))
    }

    /// The parts of the open gripper in the tool frame.
    pub(crate) fn open(&self) -> [SweptVolume; 4] {
        let y = self.finger_axis();
        let (back, tip) = self.finger_span();
        let finger = |y: f64| {
            let radius = 0.5 * self.finger_thickness_m;
            SweptVolume::capsule(Point3::new(back, y, 0.0), Point3::new(tip, y, 0.0), radius)
        };
        let [palm, wrist] = self.behind();
        [finger(y), finger(-y), palm, wrist]
    }

    fn behind(&self) -> [SweptVolume; 2] {
        let (x, y) = (self.palm_axis(), self.finger_axis());
        let palm = SweptVolume::capsule(
            Point3::new(x, -y, 0.0),
            Point3::new(x, y, 0.0),
            0.5 * self.palm_thickness_m,
        );
        let radius = 0.5 * self.wrist_diameter_m;
        let front = -self.palm_depth_m - radius;
        let end = (radius - self.palm_depth_m - self.wrist_length_m).min(front);
        let wrist = SweptVolume::capsule(
            Point3::new(front, 0.0, 0.0),
            Point3::new(end, 0.0, 0.0),
            radius,
        );
        [palm, wrist]
    }

    /// What the gripper sweeps on its straight of `length_m` that ends about an apple of this
    /// radius, in the tool frame at the apple: fingers open and closed and all between, palm, wrist.
    pub(crate) fn swept(&self, length_m: f64, radius_m: f64) -> [SweptVolume; 4] {
        let thickness = self.finger_thickness_m;
        let open = self.finger_axis();
        let closed = (radius_m + 0.5 * thickness).min(open);
        let (back, tip) = self.finger_span();
        let run = Vector3::new(tip - back + length_m, 0.0, 0.0);
        let finger = |sign: f64| {
            let corner = Point3::new(back - length_m, sign * open, 0.0);
            let inward = Vector3::new(0.0, sign * (closed - open), 0.0);
            SweptVolume::rectangle(corner, run, inward, 0.5 * thickness)
        };
        let path = Vector3::new(-length_m, 0.0, 0.0);
        let [palm, wrist] = self.behind().map(|part| part.swept(path));
        [finger(1.0), finger(-1.0), palm, wrist]
    }

    /// How far the foremost point of each part of [`Gripper::open`] lies before the tool's origin.
    pub(crate) fn fronts(&self) -> [f64; 4] {
        let finger = self.finger_reach_m;
        [finger, finger, -self.palm_depth_m, -self.palm_depth_m]
    }

    /// The farthest that any part is from the tool's origin.
    pub(crate) fn radius_about_tool(&self) -> f64 {
        let far = |body: &SweptVolume| {
            let corners = body.corners();
            corners.iter().map(|p| p.coords.norm()).fold(0.0, f64::max) + body.radius
        };
        self.open().iter().map(far).fold(0.0, f64::max)
    }

    /// The open gripper as axis and radius of each of its capsules in the tool frame, for pictures
    /// and for other programs' collision models.
    pub fn capsules(&self) -> [(Point3<f64>, Point3<f64>, f64); 4] {
        self.open().map(|body| {
            let [start, end, ..] = body.corners();
            (start, end, body.radius)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Translation3;

    #[test]
    fn parts_stand_where_their_sizes_say() {
        let gripper = Gripper::default();
        let distance = |p: [f64; 3]| {
            let p = Point3::from(p);
            let all = gripper.open().map(|b| b.distance_to_point(&p));
            all.into_iter().fold(f64::INFINITY, f64::min)
        };
        assert!((distance([0.0, 0.0, 0.0]) - 0.05).abs() < 1e-15, "jaw");
        assert!((distance([-0.03, 0.0, 0.0]) - 0.03).abs() < 1e-15, "palm");
        assert!((distance([0.115, 0.056, 0.0]) - 0.1).abs() < 1e-15, "tip");
        assert!((distance([-0.31, 0.0, 0.0]) - 0.1).abs() < 1e-15, "wrist");
        assert!(distance([-0.075, 0.0, 0.0]) <= -0.015);
        assert!((gripper.radius_about_tool() - 0.21).abs() < 1e-12);
    }

    #[test]
    fn the_sweep_holds_the_gripper_at_every_step() {
        let gripper = Gripper::default();
        let swept = gripper.swept(0.15, 0.04);
        for step in 0..=15 {
            let shift = Translation3::new(-0.01 * f64::from(step), 0.0, 0.0).into();
            for (part, whole) in gripper.open().iter().zip(&swept) {
                let part = part.moved(&shift);
                for corner in part.corners() {
                    assert!(whole.distance_to_point(&corner) <= -part.radius + 1e-12);
                }
            }
        }
        let closed = Point3::new(0.0, 0.046, 0.0);
        assert!(swept[0].distance_to_point(&closed) <= -0.006 + 1e-12);
    }

    #[test]
    fn the_wrist_follows_the_tool() {
        let gripper = Gripper {
            tool_axis: [0.0, 0.0, 1.0],
            tcp_from_flange_translation_m: [0.0, 0.0, -0.2],
            ..Gripper::default()
        };
        gripper.validate().unwrap();
        let wrist = gripper.wrist_pose(&Isometry3::identity());
        // The link's +z is the tool's +x, and the link stands 0.2 m behind.
        assert!((wrist * Vector3::z() - Vector3::x()).norm() < 1e-12);
        assert!((wrist * Vector3::y() - Vector3::y()).norm() < 1e-12);
        assert!((wrist * Point3::origin() - Point3::new(-0.2, 0.0, 0.0)).norm() < 1e-12);
    }
}
