use crate::advance::{self, Open};
use crate::path::Waypoints;
use crate::pose::{aligned, nearer_half_turn, roll_of, tool_rotation};
use crate::scene::{Hit, View};
use crate::sweep::Straight;
use crate::{
    ApproachConfig, Clearance, ConfigError, Path, ReachLimit, Refusal, Roll, Scene, Stage,
    StartPose, Target,
};
use nalgebra::{Isometry3, Point3, Unit, UnitQuaternion, Vector3};
use pomona_geometry::{Sphere, across, angle_between};
use pomona_transforms::{Direction, RobotFrame};
use std::f64::consts::{PI, TAU};

/// Places of a path at which the arm's reach is asked for.
const REACH_SAMPLES: usize = 25;

/// How a gripper picks one apple. Metres, radians, in the base's frame.
#[derive(Clone, Debug, PartialEq)]
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
    /// The way there and back.
    pub path: Path,
    /// What it comes nearest to.
    pub clearance: Clearance,
    /// How many ways were tried, this one included.
    pub tried: usize,
}

/// Plans approaches by one checked configuration.
#[derive(Clone, Debug)]
pub struct Planner {
    config: ApproachConfig,
    open: Open,
}

impl Planner {
    /// A planner with these settings.
    ///
    /// # Errors
    ///
    /// [`ConfigError::Value`] names the setting that makes no sense.
    pub fn new(config: ApproachConfig) -> Result<Self, ConfigError> {
        config.validate()?;
        Ok(Self {
            open: Open::of(&config.gripper),
            config,
        })
    }

    /// Its settings.
    pub fn config(&self) -> &ApproachConfig {
        &self.config
    }

    /// The first free way to the target.
    ///
    /// Directions are tried in their order; each one straight, then tilted by half and by all of its
    /// uncertainty; each of these with the allowed rolls, directly; without a tilt also by a detour.
    ///
    /// # Errors
    ///
    /// Where there is none, the [`Refusal`] of the first way tried.
    pub fn plan(
        &self,
        scene: &Scene,
        target: &Target,
        start: &StartPose,
    ) -> Result<Approach, Refusal> {
        self.plan_without(scene, target, start, &[])
    }

    /// The same with apples gone: those whose number has `true` in `gone`.
    ///
    /// # Errors
    ///
    /// As for [`Planner::plan`].
    pub fn plan_without(
        &self,
        scene: &Scene,
        target: &Target,
        start: &StartPose,
        gone: &[bool],
    ) -> Result<Approach, Refusal> {
        let none = Refusal::NoTarget {
            apple: target.apple,
            apples: scene.apples().len(),
        };
        let apple = *scene.apples().get(target.apple).ok_or(none)?;
        if !start.is_finite() {
            return Err(Refusal::NoStart);
        }
        self.fits(&apple)?;
        let mut first = None;
        let mut tried = 0;
        for (candidate, nominal) in target.directions.iter().enumerate() {
            let tilts = self.tilts(nominal, target.direction_uncertainty_rad);
            for (tilt, direction) in tilts.into_iter().enumerate() {
                for rotation in self.rotations(&direction, target.branch.as_ref(), start) {
                    tried += 1;
                    let way = Way {
                        planner: self,
                        scene,
                        apple,
                        number: target.apple,
                        direction,
                        tilted: tilt > 0,
                        rotation,
                        start,
                    };
                    // What the first way collides with is reported; of the others only whether they do.
                    match way.free(gone, first.is_some()) {
                        Ok(mut approach) => {
                            approach.candidate = candidate;
                            approach.tilt_rad = direction.angle_to(nominal);
                            approach.tried = tried;
                            return Ok(approach);
                        }
                        Err(refusal) => {
                            first.get_or_insert(refusal);
                        }
                    }
                }
            }
        }
        Err(first.unwrap_or(none))
    }

    /// Whether an approach stays free of one apple, branches and cloud left aside: the clearance
    /// where it does not.
    pub(crate) fn touches(
        &self,
        scene: &Scene,
        approach: &Approach,
        other: usize,
    ) -> Option<Clearance> {
        let gone: Vec<bool> = (0..scene.apples().len()).map(|i| i != other).collect();
        let view = View {
            target: approach.apple,
            target_counts: false,
            gone: &gone,
            wood_counts: false,
            any: false,
        };
        let apple = *scene.apples().get(approach.apple)?;
        let straight = self.straight(approach.grasp, approach.standoff_m, apple);
        self.check(scene, &view, &straight, &approach.path).err()
    }

    fn fits(&self, apple: &Sphere) -> Result<(), Refusal> {
        let gripper = &self.config.gripper;
        let (needed_width_m, needed_depth_m) = gripper.needed_for(apple.radius);
        if needed_width_m <= gripper.jaw_width_m && needed_depth_m <= gripper.palm_depth_m {
            return Ok(());
        }
        Err(Refusal::GripperTooSmall {
            needed_width_m,
            width_m: gripper.jaw_width_m,
            needed_depth_m,
            depth_m: gripper.palm_depth_m,
        })
    }

    /// The direction itself, then those about it.
    fn tilts(
        &self,
        nominal: &Direction<RobotFrame>,
        uncertainty_rad: f64,
    ) -> Vec<Direction<RobotFrame>> {
        let search = &self.config.search;
        let largest = uncertainty_rad.min(search.tilt_max_rad);
        let mut directions = vec![*nominal];
        if !(largest > 0.0) {
            return directions;
        }
        let [u, v] = across(&nominal.unit());
        for share in [0.5, 1.0] {
            let (sin, cos) = (largest * share).sin_cos();
            for step in 0..search.tilt_azimuths {
                let (s, c) = (TAU * step as f64 / search.tilt_azimuths as f64).sin_cos();
                let tilted = nominal.vector() * cos + (u * c + v * s) * sin;
                directions.push(Direction::from_unit(Unit::new_normalize(tilted)));
            }
        }
        directions
    }

    /// The orientations to try, the one that turns the tool least first.
    fn rotations(
        &self,
        direction: &Direction<RobotFrame>,
        branch: Option<&Vector3<f64>>,
        start: &StartPose,
    ) -> Vec<UnitQuaternion<f64>> {
        let search = &self.config.search;
        let reference = &start.0.rotation;
        if search.roll == Roll::Aligned
            && let Some(rotation) = branch.and_then(|branch| aligned(direction, branch))
        {
            return vec![nearer_half_turn(rotation, reference)];
        }
        let step = PI / search.rolls as f64;
        let mut rotations: Vec<_> = (0..search.rolls)
            .map(|i| nearer_half_turn(tool_rotation(direction, step * i as f64), reference))
            .collect();
        rotations.sort_by(|a, b| a.angle_to(reference).total_cmp(&b.angle_to(reference)));
        rotations
    }

    fn straight(&self, grasp: Isometry3<f64>, standoff_m: f64, apple: Sphere) -> Straight {
        let retreat = self.config.motion.retreat_m;
        Straight::new(&self.config.gripper, grasp, standoff_m, retreat, apple)
    }

    /// The clearance of straight and transit; the first that is a collision as an error.
    fn check(
        &self,
        scene: &Scene,
        view: &View<'_>,
        straight: &Straight,
        path: &Path,
    ) -> Result<Clearance, Clearance> {
        let config = &self.config.clearance;
        let timed = |(hit, stage): (Hit, Stage)| {
            let time = straight.time_of(&hit, stage, &self.config.gripper, path);
            clearance_of(&hit, time, stage, 0.0)
        };
        let about = View {
            target_counts: false,
            ..*view
        };
        let near = straight.clearance(scene, &about, config).map_err(timed)?;
        let before = View {
            target_counts: view.wood_counts,
            ..*view
        };
        let open = &self.open;
        let intervals = advance::intervals(path, open);
        // Most ways that collide do so on the transit, and looking for the least slack takes longer.
        let quick = View {
            any: true,
            ..before
        };
        advance::transit(path, &intervals, open, scene, &quick, config)
            .map_err(|(hit, time)| clearance_of(&hit, time, Stage::Transit, 0.0))?;
        let before = View {
            any: false,
            ..before
        };
        let passed = advance::transit(path, &intervals, open, scene, &before, config)
            .map_err(|(hit, time)| clearance_of(&hit, time, Stage::Transit, 0.0))?;
        let passed = passed.map(|(hit, time)| {
            let less = hit.slack() - advance::floor(hit.slack(), config.resolution_m);
            clearance_of(&hit, time, Stage::Transit, less)
        });
        let nearest = near
            .map(timed)
            .into_iter()
            .chain(passed)
            .min_by(|a, b| a.slack_m().total_cmp(&b.slack_m()));
        Ok(nearest.unwrap_or_else(|| Clearance {
            distance_m: advance::floor(config.cutoff_m, config.resolution_m)
                + config.cloud_margin_m.min(0.0),
            margin_m: config.cloud_margin_m.min(0.0),
            obstacle: None,
            point_m: path.sample(0.0).position.into(),
            time_s: 0.0,
            stage: Stage::Transit,
        }))
    }
}

fn clearance_of(hit: &Hit, time_s: f64, stage: Stage, less: f64) -> Clearance {
    Clearance {
        distance_m: hit.distance - less,
        margin_m: hit.margin,
        obstacle: Some(hit.obstacle),
        point_m: hit.point.into(),
        time_s,
        stage,
    }
}

/// One way to try.
struct Way<'a> {
    planner: &'a Planner,
    scene: &'a Scene,
    apple: Sphere,
    number: usize,
    direction: Direction<RobotFrame>,
    tilted: bool,
    rotation: UnitQuaternion<f64>,
    start: &'a StartPose,
}

impl Way<'_> {
    fn pose_back(&self, distance_m: f64) -> Isometry3<f64> {
        let place = self.apple.center - self.direction.vector() * distance_m;
        Isometry3::from_parts(place.coords.into(), self.rotation)
    }

    /// The approach on this way where it is reached and free.
    fn free(&self, gone: &[bool], any: bool) -> Result<Approach, Refusal> {
        let config = &self.planner.config;
        self.comes_from_the_front()?;
        let clearance = &config.clearance;
        let standoff_m = config.motion.standoff_m.max(
            config.gripper.finger_reach_m
                + self.apple.radius
                + clearance.apple_margin_m
                + 2.0 * clearance.resolution_m,
        );
        let grasp = self.pose_back(0.0);
        let pre_grasp = self.pose_back(standoff_m);
        let retreat = self.pose_back(config.motion.retreat_m);
        for pose in [&grasp, &pre_grasp, &retreat] {
            self.reached(&pose.translation.vector.into())?;
        }
        let straight = self.planner.straight(grasp, standoff_m, self.apple);
        let view = View {
            target: self.number,
            target_counts: false,
            gone,
            wood_counts: true,
            any,
        };
        let mut first = None;
        for via in self.detours(&pre_grasp) {
            let way = Waypoints {
                start: self.start.0,
                via,
                pre_grasp: pre_grasp.translation.vector.into(),
                grasp: self.apple.center,
                retreat: retreat.translation.vector.into(),
                rotation: self.rotation,
            };
            let path = Path::through(&way, &config.motion).ok_or(Refusal::NoStart)?;
            let tried = self.all_reached(&path).and_then(|()| {
                self.planner
                    .check(self.scene, &view, &straight, &path)
                    .map_err(Refusal::Collision)
            });
            match tried {
                Ok(clearance) => {
                    return Ok(Approach {
                        apple: self.number,
                        direction: self.direction,
                        candidate: 0,
                        tilt_rad: 0.0,
                        roll_rad: roll_of(&self.direction, &self.rotation),
                        grasp,
                        pre_grasp,
                        retreat,
                        standoff_m,
                        path,
                        clearance,
                        tried: 0,
                    });
                }
                Err(refusal) => {
                    let stop = !matches!(
                        refusal,
                        Refusal::Collision(Clearance {
                            stage: Stage::Transit,
                            ..
                        }) | Refusal::OutOfReach { .. }
                    );
                    first.get_or_insert(refusal);
                    if stop {
                        break;
                    }
                }
            }
        }
        Err(first.unwrap_or(Refusal::NoStart))
    }

    /// The angle is that of the direction and the ray from the shoulder to the apple.
    fn comes_from_the_front(&self) -> Result<(), Refusal> {
        let reach = &self.planner.config.reach;
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
        let reach = &self.planner.config.reach;
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

    /// The places between start and pre-grasp to try: none; then, without a tilt, one before the fruit, from
    /// where the base looks.
    fn detours(&self, pre_grasp: &Isometry3<f64>) -> Vec<Vec<Point3<f64>>> {
        let mut detours = vec![Vec::new()];
        if self.tilted {
            return detours;
        }
        let length = self.planner.config.search.detour_m;
        let shoulder = Point3::from(self.planner.config.reach.shoulder_m);
        let place = Point3::from(pre_grasp.translation.vector);
        if let Some(ray) = (place - shoulder).try_normalize(1e-9)
            && length > 0.0
        {
            detours.push(vec![place - ray * length]);
        }
        detours
    }
}
