//! One candidate approach.

use crate::collision_check::CollisionCheck;
use crate::obstacles::ObstacleFilter;
use crate::path::Waypoints;
use crate::pose::roll_of;
use crate::straight_motion::StraightMotion;
use crate::{Approach, ApproachConfig, Clearance, Path, ReachLimit, Refusal, StartPose};
use nalgebra::{Isometry3, Point3, UnitQuaternion};
use pomona_geometry::{Sphere, angle_between};
use pomona_transforms::{Direction, RobotFrame};

/// Points of a path at which the arm's reach is checked.
const REACH_SAMPLES: usize = 25;

/// One direction and one roll to try.
pub(crate) struct Attempt<'a> {
    pub(crate) config: &'a ApproachConfig,
    pub(crate) check: CollisionCheck<'a>,
    pub(crate) apple: Sphere,
    /// Number of the apple in the scene.
    pub(crate) number: usize,
    /// Which of the target's directions it comes from.
    pub(crate) candidate: usize,
    /// That direction, before any tilt.
    pub(crate) nominal: Direction<RobotFrame>,
    pub(crate) direction: Direction<RobotFrame>,
    pub(crate) rotation: UnitQuaternion<f64>,
    pub(crate) start: &'a StartPose,
    /// How many approaches have been tried, this one included.
    pub(crate) tried: usize,
}

/// The poses between which the gripper moves in a straight line.
struct Poses {
    grasp: Isometry3<f64>,
    pre_grasp: Isometry3<f64>,
    retreat: Isometry3<f64>,
    standoff_m: f64,
}

impl Attempt<'_> {
    fn pose_back(&self, distance_m: f64) -> Isometry3<f64> {
        let place = self.apple.center - self.direction.vector() * distance_m;
        Isometry3::from_parts(place.coords.into(), self.rotation)
    }

    /// The approach, where it is within reach and free of collisions; where `any_collision` will do, a refusal need
    /// not name the nearest obstacle.
    pub(crate) fn free_approach(
        &self,
        gone: &[bool],
        any_collision: bool,
    ) -> Result<Approach, Refusal> {
        self.comes_from_the_front()?;
        let poses = self.poses();
        for pose in [&poses.grasp, &poses.pre_grasp, &poses.retreat] {
            self.reached(&pose.translation.vector.into())?;
        }
        let filter = ObstacleFilter {
            target: self.number,
            target_counts: false,
            gone,
            wood_counts: true,
            any_collision,
        };
        let (path, clearance) = self.free_path(&poses, &filter)?;
        Ok(Approach {
            apple: self.number,
            direction: self.direction,
            candidate: self.candidate,
            tilt_rad: self.direction.angle_to(&self.nominal),
            roll_rad: roll_of(&self.direction, &self.rotation),
            grasp: poses.grasp,
            pre_grasp: poses.pre_grasp,
            retreat: poses.retreat,
            standoff_m: poses.standoff_m,
            path,
            clearance,
            tried: self.tried,
        })
    }

    fn poses(&self) -> Poses {
        let ApproachConfig {
            gripper,
            motion,
            clearance,
            ..
        } = self.config;
        // Before the straight approach the fingertips are clear of the apple.
        let standoff_m = motion.standoff_m.max(
            gripper.finger_reach_m
                + self.apple.radius
                + clearance.apple_margin_m
                + 2.0 * clearance.resolution_m,
        );
        Poses {
            grasp: self.pose_back(0.0),
            pre_grasp: self.pose_back(standoff_m),
            retreat: self.pose_back(motion.retreat_m),
            standoff_m,
        }
    }

    /// The first path, direct or by a detour, that is within reach and free of collisions.
    fn free_path(
        &self,
        poses: &Poses,
        filter: &ObstacleFilter<'_>,
    ) -> Result<(Path, Clearance), Refusal> {
        let straight = StraightMotion::new(
            &self.config.gripper,
            poses.grasp,
            poses.standoff_m,
            self.config.motion.retreat_m,
            self.apple,
        );
        let mut first = None;
        for via in self.detours(&poses.pre_grasp) {
            let waypoints = Waypoints {
                start: self.start.0,
                via,
                pre_grasp: poses.pre_grasp.translation.vector.into(),
                grasp: self.apple.center,
                retreat: poses.retreat.translation.vector.into(),
                rotation: self.rotation,
            };
            let path = Path::through(&waypoints, &self.config.motion).ok_or(Refusal::NoStart)?;
            let clearance = self.all_reached(&path).and_then(|()| {
                let clearance = self.check.clearance(filter, &straight, &path);
                clearance.map_err(Refusal::Collision)
            });
            match clearance {
                Ok(clearance) => return Ok((path, clearance)),
                Err(refusal) => {
                    let detour_may_help = refusal.is_of_the_transit();
                    first.get_or_insert(refusal);
                    if !detour_may_help {
                        break;
                    }
                }
            }
        }
        Err(first.unwrap_or(Refusal::NoStart))
    }

    /// The angle is that of the direction and the ray from the shoulder to the apple.
    fn comes_from_the_front(&self) -> Result<(), Refusal> {
        let reach = &self.config.reach;
        let ray = self.apple.center - Point3::from(reach.shoulder_m);
        let angle_rad = angle_between(&ray, &self.direction.vector()).unwrap_or(0.0);
        if angle_rad <= reach.behind_angle_max_rad {
            return Ok(());
        }
        Err(Refusal::UnreachableFromBehind {
            angle_rad,
            limit_rad: reach.behind_angle_max_rad,
        })
    }

    fn reached(&self, place: &Point3<f64>) -> Result<(), Refusal> {
        let reach = &self.config.reach;
        let distance = (place - Point3::from(reach.shoulder_m)).norm();
        let in_box = (0..3).all(|i| (reach.box_min_m[i]..=reach.box_max_m[i]).contains(&place[i]));
        let limit = if distance < reach.shell_inner_m {
            ReachLimit::ShellInner
        } else if !(distance <= reach.shell_outer_m) {
            ReachLimit::ShellOuter
        } else if in_box {
            return Ok(());
        } else {
            ReachLimit::Box
        };
        Err(Refusal::OutOfReach {
            limit,
            point_m: (*place).into(),
        })
    }

    fn all_reached(&self, path: &Path) -> Result<(), Refusal> {
        let step = path.pre_grasp_s() / (REACH_SAMPLES - 1) as f64;
        (0..REACH_SAMPLES).try_for_each(|i| self.reached(&path.place(i as f64 * step)))
    }

    /// The intermediate waypoints to try: none; then, without a tilt, one between the base and the pre-grasp.
    fn detours(&self, pre_grasp: &Isometry3<f64>) -> Vec<Vec<Point3<f64>>> {
        let mut detours = vec![Vec::new()];
        if self.direction != self.nominal {
            return detours;
        }
        let length = self.config.search.detour_m;
        let shoulder = Point3::from(self.config.reach.shoulder_m);
        let place = Point3::from(pre_grasp.translation.vector);
        if let Some(ray) = (place - shoulder).try_normalize(1e-9)
            && length > 0.0
        {
            detours.push(vec![place - ray * length]);
        }
        detours
    }
}
